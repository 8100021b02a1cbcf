// SPDX-License-Identifier: GPL-3.0-or-later
// The media along one ray segment: coefficients that add, the mixed phase function, the places where light is gathered along
// a ray, and what homogeneous media have in closed form. Media that vary are followed by media/tracking.h.
#pragma once

#include "core/sampler.h"
#include "scene/interior.h"
#include "scene/scene.h"

namespace opal {

// What a ray is in at the path's wavelengths.
struct MediumHere {
  Spectrum extinction{0.0f}, scattering{0.0f}, emission{0.0f};
  struct Scatterer {  // one of the media
    const PhaseFunction *phase;
    Spectrum scattering;
    uint8_t layer;  // OPAL_MEDIUM_LAYER_*
  };
  Slots<Scatterer, MediumSet::kCapacity> parts;

  // The phase functions' mixture, at every wavelength: what sample_phase samples.
  Spectrum phase_value(const Wavelengths &w, float cosine) const;
  // What is scattered of unpolarised light that goes along `light`, on along `onward`; `filter` may be null.
  Spectrum scattered(const Wavelengths &w, const Vec3 &light, const Vec3 &onward, const Polariser *filter) const;
  int any_layer = OPAL_MEDIUM_LAYER_MEDIA;  // of one of the media, where none scatters
  // The compositing layer of the media that scatter most by an angle of this cosine.
  int layer_of(const Wavelengths &w, float cosine) const;
  // A direction to scatter into; density is phase_value at the hero.
  Vec3 sample_phase(const Wavelengths &w, const Vec3 &forward, float pick, Vec2 u, float &density) const;
  bool scatters() const { return scattering.max() > 0; }
};

// What one of several media adds.
struct OneMedium {
  Spectrum extinction;
  int part;  // of MediumHere's; -1: it does not scatter
};

// Of homogeneous media: the same everywhere. `each`, if given, takes what each adds, in the set's order.
MediumHere medium_here(const Scene &scene, const MediumSet &set, const Wavelengths &w, OneMedium *each = nullptr);
// Whether any of the media is not the same everywhere, so that closed forms do not hold.
bool any_varies(const Scene &scene, const MediumSet &set);

// exp(-extinction t); extinction 0 over an infinite distance is 1.
Spectrum transmittance_over(const Spectrum &extinction, float t);

// Follows the media through boundaries met by a ray.
inline void cross_medium(const Material &material, const ShadingPoint &sp, MediumSet &set) {
  if (material.medium < 0) return;
  if (sp.backfacing) set.leave(sp.instance_index, material.medium);
  else set.enter(sp.instance_index, material.medium);
}

// Whether a ray meets nothing more on its way out of the scene: it is then in no body, though it may not have been seen to
// leave one, through a hole or an edge's rounding.
inline bool escapes(const Scene &scene, const Ray &ray, const Hit &hit) {
  return !hit.valid() && (!std::isfinite(ray.t_max) || !scene.bounds.contains(ray.origin + ray.direction * ray.t_max));
}

// Of the media whose boundaries a path has entered, those that are there, with what each brings along. A solid or liquid leaves
// no room for the fog round it: in a gem there is the gem's own medium and what smaller bodies bring into it, by the rule that
// says which of overlapping interiors counts. It depends on the place alone and not on the way there.
MediumSet media_that_fill(const Scene &scene, const MediumSet &entered, const InteriorStack &interior);

// The media entered at a point, found by looking along a ray for boundaries that are left without having been entered.
MediumSet media_at(const Scene &scene, const Vec3 &p);

}  // namespace opal
