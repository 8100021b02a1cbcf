// SPDX-License-Identifier: GPL-3.0-or-later
// What is constant while one pass runs: scene, settings, the pass's wavelengths, its photons.
#pragma once

#include "camera/camera.h"
#include "film/film.h"
#include "film/pixel_filter.h"
#include "integrator/layers.h"
#include "media/segment.h"
#include "photons/emission_guide.h"
#include "photons/photon_map.h"
#include "photons/volume_map.h"
#include "scene/interior.h"
#include "scene/scene.h"

#include <array>
#include <atomic>

namespace opal {

// A pass samples 64 wavelengths: 8 sets of kWavelengths, each usable with any of its members as the hero.
inline constexpr int kPassWavelengths = 64;
inline constexpr int kWavelengthSets = kPassWavelengths / kWavelengths;
static_assert(kWavelengthSets * kWavelengths == kPassWavelengths);

// Streams of the sampler: pixels count from 0, photons and passes sit above every pixel.
enum Stream : uint32_t {
  kStreamPhotons = 0xf0000000u,
  kStreamPass = 0xf1000000u,
  kStreamVolumePhotons = 0xf2000000u,
  kStreamPilot = 0xf3000000u,
  kStreamPlan = 0xf4000000u  // and the three after it
};

// Whether the film asks for any layer; paths keep account of them only then.
inline bool keeps_layers(const opal_render_settings &settings) {
  return (settings.passes >> OPAL_PASS_LAYER_BASE & ((1u << kLayers) - 1)) != 0;
}
// Whether it asks for what media let through.
inline bool keeps_clear(const opal_render_settings &settings) {
  return (settings.passes & (1u << OPAL_PASS_LAYER_BEHIND | 1u << OPAL_PASS_LAYER_DIMMED)) != 0;
}

struct PassContext {
  PassContext(const Scene &scene_, const opal_render_settings &settings_, const PixelFilter &filter_, int pass_)
      : scene(scene_), settings(settings_), filter(filter_), pass(pass_) {
    const float shift = Sampler(settings.seed, kStreamPass, uint32_t(pass)).get1d(0);
    for (int i = 0; i < kPassWavelengths; ++i)
      wavelengths[size_t(i)] = scene.colour.sample((float(i) + shift) / kPassWavelengths);
    const Transform camera = camera_transform(scene.camera, 0);
    camera_media = media_at(scene, camera.origin());
    camera_interior = interior_at(scene, camera.origin());
    const float angle = scene.camera.polarizer_angle;
    polariser = {scene.camera.polarizer != 0, camera.axis(0) * std::cos(angle) + camera.axis(1) * std::sin(angle)};
  }

  // Number i of the pass's wavelengths is hero; its set is i mod 8, its position in the set i / 8.
  static uint32_t wavelength_index(float u) { return std::min(uint32_t(u * kPassWavelengths), uint32_t(kPassWavelengths - 1)); }
  static uint32_t set_of(uint32_t index) { return index % kWavelengthSets; }
  static uint32_t position_of(uint32_t index, uint32_t k) { return (index / kWavelengthSets + k) % kWavelengths; }

  const Scene &scene;
  const opal_render_settings &settings;
  const PixelFilter &filter;
  const int pass;
  std::array<Wavelengths, kPassWavelengths> wavelengths;
  const EmissionGuide *guide = nullptr;  // where photons are worth sending, once that is known
  PhotonMap photons;                     // on surfaces
  VolumeMap volume;                      // in media
  MediumSet camera_media;                // what the camera is in
  InteriorStack camera_interior;         // which gems it is in
  Polariser polariser;                   // before its lens
};

}  // namespace opal
