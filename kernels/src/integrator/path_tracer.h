// SPDX-License-Identifier: GPL-3.0-or-later
// Camera paths: next-event estimation with multiple importance, photons gathered at rough events that the camera does
// not see at first hand.
#pragma once

#include "integrator/pass.h"

namespace opal {

// What one camera path brings, in linear Rec.709 and by kind of light; their sum is the picture.
struct PathLight {
  Vec3 emission;  // seen at first hand
  Vec3 direct;    // one event
  Vec3 indirect;  // more than one
  Vec3 caustics;  // a rough event lit through sharp ones
  Vec3 medium;    // whose first event, or whose source, is in a medium
  float alpha = 1;
  LayerLight layers;    // the same light by layer, if the film keeps them
  bool veiled = false;  // the camera looks through media that the layers' base leaves out
  // Guides, of the first event that is not straight through.
  Vec3 normal, position, albedo;
  float depth = 0;
  bool hit = false;
  // Radiance at the path's wavelengths, for the spectral film.
  Spectrum spectral;
  uint32_t wavelength_index = 0;
};

struct RayCounts {
  int64_t camera = 0, path = 0, shadow = 0, passed_over = 0;
  int64_t media_passed_over = 0;
};

// sample: which of the pixel's in the whole render.
PathLight trace_camera_path(const PassContext &pass, uint32_t x, uint32_t y, uint32_t sample, RayCounts &counts);
// The same path with the same random numbers, as it would have gone without the media before its first event: its light is for
// Behind and Dimmed alone.
LayerLight trace_clear_path(const PassContext &pass, uint32_t x, uint32_t y, uint32_t sample, RayCounts &counts);

}  // namespace opal
