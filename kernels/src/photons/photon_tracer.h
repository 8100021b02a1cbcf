// SPDX-License-Identifier: GPL-3.0-or-later
// Photons: emitted towards what can make caustics, followed through sharp events, left at rough ones - on surfaces in the
// map, for camera paths that arrive there indirectly, and on the film, for the camera's direct view; in media as points or
// beams, for every camera ray.
#pragma once

#include "integrator/pass.h"

namespace opal {

// A photon's direct effect on the film. `pixel` counts within the region; `pass` is the OPAL_PASS_* of its kind of light.
struct Splat {
  uint32_t pixel;
  int32_t pass;
  Vec3 rgb;
};

// Where the energy of photons went, at their first wavelength: emitted = stored + absorbed + escaped.
struct EnergyBalance {
  double emitted = 0, stored = 0, absorbed = 0, escaped = 0;

  EnergyBalance &operator+=(const EnergyBalance &b) {
    emitted += b.emitted, stored += b.stored, absorbed += b.absorbed, escaped += b.escaped;
    return *this;
  }
};

// What a chunk of photons leaves; chunks are merged in order.
struct PhotonChunk {
  std::vector<Photon> photons;
  std::vector<VolumePhoton> volume;
  std::vector<PhotonBeam> beams;
  EnergyBalance energy;
  std::vector<Splat> splats;
  std::vector<std::pair<uint32_t, float>> spectral;  // (pixel * bins + bin, radiance per nm)
  int64_t rays = 0, passed_over = 0;
  int64_t media_passed_over = 0;
};

// What photons are for, of `count` in all: traced together for surfaces and media, or apart.
struct PhotonTask {
  uint32_t count, stream;
  bool on_surfaces, in_media;
};

// Traces photons first .. last-1 of a task.
void trace_photons(const PassContext &pass, const PhotonTask &task, uint32_t first, uint32_t last, PhotonChunk &out);
// Traces them to see of what use they are, and leaves nothing: trials[i] of each photon i.
void try_photons(const PassContext &pass, const PhotonTask &task, uint32_t first, uint32_t last, EmissionTrial *trials);

}  // namespace opal
