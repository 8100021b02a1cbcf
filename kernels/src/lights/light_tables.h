// SPDX-License-Identifier: GPL-3.0-or-later
// Everything about the lights that is computed once a scene: prepared lamps, the world's map, the light tree, and where
// photons start.
#pragma once

#include "lights/emission_table.h"
#include "lights/lamp.h"
#include "lights/light_tree.h"
#include "lights/world_light.h"

namespace opal {

struct EmissiveTriangle;

struct LightTables {
  std::vector<LampModel> lamps;            // as Scene::lamps
  std::vector<SpectralTable> lamp_tables;  // of lamps with a spectrum of their own, scaled to their colour's luminance
  WorldLight world;

  // Sources for sampling. Far ones (suns, the world) are weighed one by one; near ones through the tree, or one by one
  // as well while there are few.
  std::vector<SourceId> far;
  std::vector<SourceId> near;                            // leaves of the tree
  std::vector<LightBounds> near_bounds;                  // kept while they are few
  std::vector<uint32_t> near_of_lamp, near_of_triangle;  // index into near, kNoSource
  LightTree tree;
  std::vector<uint32_t> sized;  // lamps that rays can meet

  // Things that glow, each as a ball with what it sends at distance 1: where media near them are looked at.
  struct Glow {
    Vec3 centre;
    float radius = 0, power = 0;
  };
  std::vector<Glow> glows;

  // Suns by direction, with their shares of all suns' irradiance, and the suns' of theirs and the world's.
  struct Sun {
    Vec3 toward;
    float share = 0;
  };
  std::vector<Sun> suns;
  float sun_share = 0;

  EmissionTable to_casters, to_scene;
};

inline constexpr uint32_t kNoSource = ~0u;
inline constexpr size_t kFewLights = 8;

// The spectrum of a lamp of unit strength.
inline Spectrum lamp_spectrum(const LightTables &tables, const LampModel &lamp, const Wavelengths &w) {
  if (lamp.table < 0) return uplift_light(lamp.colour, w);
  Spectrum s;
  for (int i = 0; i < kWavelengths; ++i) s[i] = lookup(tables.lamp_tables[size_t(lamp.table)], w.nm[i]);
  return s;
}

// Whether something may be seen by rays of these kinds (OPAL_RAY_* bits): all of them must be allowed.
inline bool visible_to(uint32_t visibility, uint32_t ray_kind) {
  constexpr uint32_t kinds = OPAL_RAY_CAMERA | OPAL_RAY_DIFFUSE | OPAL_RAY_GLOSSY | OPAL_RAY_TRANSMISSION | OPAL_RAY_SCATTER;
  return (ray_kind & kinds & ~visibility) == 0;
}
inline bool lights_group(uint64_t receivers, int32_t light_group) {
  return light_group < 0 || (receivers >> (light_group & 63) & 1);
}

// The emission of an emissive triangle at barycentrics (b1, b2) towards -direction, where `direction` leads to it.
Vec3 triangle_emission(const Scene &scene, const EmissiveTriangle &triangle, const Vec3 &origin, const Vec3 &direction,
                       float distance, float b1, float b2, float time);

}  // namespace opal
