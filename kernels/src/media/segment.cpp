// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/segment.h"

#include "scene/contact.h"

#include <algorithm>

namespace opal {

MediumHere medium_here(const Scene &scene, const MediumSet &set, const Wavelengths &w, OneMedium *each) {
  static const PhaseFunction kIsotropic = PhaseFunction::isotropic();
  MediumHere here;
  for (int i = 0; i < set.count(); ++i) {
    const Medium &medium = scene.media[size_t(set[i].medium)];
    const auto table = [&](int s) { return s >= 0 ? lookup(scene.spectra[size_t(s)], w) : Spectrum(0.0f); };
    const Spectrum extinction = table(medium.extinction);
    here.extinction += extinction;
    if (each) each[i] = {extinction, -1};
    here.any_layer = medium.layer;
    here.emission += table(medium.emission);
    const Spectrum scattering = table(medium.scattering);
    if (scattering.is_zero()) continue;
    here.scattering += scattering;
    if (each) each[i].part = here.parts.count();
    here.parts.add(medium.phase >= 0 ? &scene.phases[size_t(medium.phase)] : &kIsotropic, scattering, medium.layer);
  }
  return here;
}

bool any_varies(const Scene &scene, const MediumSet &set) {
  for (int i = 0; i < set.count(); ++i)
    if (scene.media[size_t(set[i].medium)].varies()) return true;
  return false;
}

Spectrum MediumHere::phase_value(const Wavelengths &w, float cosine) const {
  if (parts.count() == 1) return parts[0].phase->value(w, cosine);
  Spectrum sum(0.0f);
  for (const Scatterer &part : parts) sum += part.scattering * part.phase->value(w, cosine);
  for (int k = 0; k < kWavelengths; ++k) sum[k] = scattering[k] > 0 ? sum[k] / scattering[k] : 0.0f;
  return sum;
}

Spectrum MediumHere::scattered(const Wavelengths &w, const Vec3 &light, const Vec3 &onward, const Polariser *filter) const {
  if (parts.count() == 1) return parts[0].phase->scattered(w, light, onward, filter);
  Spectrum sum(0.0f);
  for (const Scatterer &part : parts) sum += part.scattering * part.phase->scattered(w, light, onward, filter);
  for (int k = 0; k < kWavelengths; ++k) sum[k] = scattering[k] > 0 ? sum[k] / scattering[k] : 0.0f;
  return sum;
}

int MediumHere::layer_of(const Wavelengths &w, float cosine) const {
  if (parts.empty()) return any_layer;
  if (parts.count() == 1) return parts[0].layer;
  float light[3] = {};
  for (const Scatterer &part : parts) light[part.layer] += (part.scattering * part.phase->value(w, cosine)).sum();
  return int(std::max_element(light, light + 3) - light);
}

Vec3 MediumHere::sample_phase(const Wavelengths &w, const Vec3 &forward, float pick, Vec2 u, float &density) const {
  int chosen = 0;
  const int n = parts.count();
  if (n > 1) {
    float below = 0;
    for (int i = 0; i < n; ++i) {
      const float share = parts[i].scattering[0] / scattering[0];
      if (pick < below + share || i == n - 1) {
        pick = saturate((pick - below) / std::max(share, 1e-9f));
        chosen = i;
        break;
      }
      below += share;
    }
  }
  const Vec3 direction = parts[chosen].phase->sample(w.nm[0], forward, std::min(pick, 0x1.fffffep-1f), u, density);
  if (n > 1) density = phase_value(w, dot(forward, direction))[0];
  return direction;
}

Spectrum transmittance_over(const Spectrum &extinction, float t) {
  Spectrum s = exp(extinction * -t);
  for (int i = 0; i < kWavelengths; ++i) s[i] = extinction[i] > 0 ? s[i] : 1.0f;
  return s;
}

MediumSet media_that_fill(const Scene &scene, const MediumSet &entered, const InteriorStack &interior) {
  const InteriorStack::Entry *solid = interior.current();
  MediumSet there;
  for (int i = 0; i < entered.count(); ++i) {
    const uint32_t instance = entered[i].instance;
    if (solid) {
      if (instance >= scene.instances.size()) continue;  // the world's
      const bool smaller = !interior.contains(instance) && scene.instances[instance].order > solid->order;
      if (instance != solid->instance && !smaller) continue;
    }
    for (int m = entered[i].medium; m >= 0; m = scene.media[size_t(m)].also) there.enter(instance, m);
  }
  return there;
}

MediumSet media_at(const Scene &scene, const Vec3 &p) {
  MediumSet entered;  // boundaries of what lies further along the ray
  MediumSet result;
  if (scene.world_medium >= 0) result.enter(MediumSet::kOfWorld, scene.world_medium);
  if (!scene.any_medium) return result;
  Ray ray{p, normalize(Vec3{0.3017f, 0.5211f, 0.7984f})};
  for (int i = 0; i < 256; ++i) {
    const Hit hit = next_hit(scene, ray, ~0u);
    if (!hit.valid()) break;
    const ShadingPoint sp = scene.shading_point(ray, hit);
    const int medium = scene.material_at(hit).medium;
    if (medium >= 0) {
      if (!sp.backfacing) {
        entered.enter(sp.instance_index, medium);
      } else {
        const int before = entered.count();
        entered.leave(sp.instance_index, medium);
        if (entered.count() == before) result.enter(sp.instance_index, medium);
      }
    }
    ray = leave_surface(scene, ray, sp, ray.direction);
  }
  return result;
}

}  // namespace opal
