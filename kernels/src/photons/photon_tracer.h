// SPDX-License-Identifier: GPL-3.0-or-later
// Photons: emitted towards what can make caustics, followed through sharp events, left at rough ones - in the map, for
// camera paths that arrive there indirectly, and on the film, for the camera's direct view.
#pragma once

#include "integrator/pass.h"

namespace opal {

// A photon's direct effect on the film. `pixel` counts within the region; `pass` is the OPAL_PASS_* of its kind of light.
struct Splat {
  uint32_t pixel;
  int32_t pass;
  Vec3 rgb;
};

// What a chunk of photons leaves; chunks are merged in order.
struct PhotonChunk {
  std::vector<Photon> photons;
  std::vector<Splat> splats;
  std::vector<std::pair<uint32_t, float>> spectral;  // (pixel * bins + bin, radiance per nm)
  int64_t rays = 0;
};

// Traces photons first .. last-1 of the pass's settings.photons_per_pass.
void trace_photons(const PassContext &pass, uint32_t first, uint32_t last, PhotonChunk &out);

}  // namespace opal
