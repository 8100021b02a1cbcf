// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/segment.h"

#include "lights/lamp.h"
#include "lights/light_tables.h"
#include "media/stratified.h"

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
    if (medium.layer != OPAL_MEDIUM_LAYER_BASE) here.replaced += extinction;
    here.emission += table(medium.emission);
    const Spectrum scattering = table(medium.scattering);
    if (scattering.is_zero()) continue;
    here.scattering += scattering;
    if (each) each[i].part = here.n;
    here.part[here.n] = scattering;
    here.layer[here.n] = medium.layer;
    here.phase[here.n++] = medium.phase >= 0 ? &scene.phases[size_t(medium.phase)] : &kIsotropic;
  }
  return here;
}

bool any_varies(const Scene &scene, const MediumSet &set) {
  for (int i = 0; i < set.count(); ++i)
    if (scene.media[size_t(set[i].medium)].varies()) return true;
  return false;
}

Spectrum MediumHere::phase_value(const Wavelengths &w, float cosine) const {
  if (n == 1) return phase[0]->value(w, cosine);
  Spectrum sum(0.0f);
  for (int i = 0; i < n; ++i) sum += part[i] * phase[i]->value(w, cosine);
  for (int k = 0; k < kWavelengths; ++k) sum[k] = scattering[k] > 0 ? sum[k] / scattering[k] : 0.0f;
  return sum;
}

Spectrum MediumHere::scattered(const Wavelengths &w, const Vec3 &light, const Vec3 &onward, const Polariser *filter) const {
  if (n == 1) return phase[0]->scattered(w, light, onward, filter);
  Spectrum sum(0.0f);
  for (int i = 0; i < n; ++i) sum += part[i] * phase[i]->scattered(w, light, onward, filter);
  for (int k = 0; k < kWavelengths; ++k) sum[k] = scattering[k] > 0 ? sum[k] / scattering[k] : 0.0f;
  return sum;
}

int MediumHere::layer_of(const Wavelengths &w, float cosine) const {
  if (n == 0) return any_layer;
  if (n == 1) return layer[0];
  float light[3] = {};
  for (int i = 0; i < n; ++i) light[layer[i]] += (part[i] * phase[i]->value(w, cosine)).sum();
  return int(std::max_element(light, light + 3) - light);
}

Vec3 MediumHere::sample_phase(const Wavelengths &w, const Vec3 &forward, float pick, Vec2 u, float &density) const {
  int chosen = 0;
  if (n > 1) {
    float below = 0;
    for (int i = 0; i < n; ++i) {
      const float share = part[i][0] / scattering[0];
      if (pick < below + share || i == n - 1) {
        pick = saturate((pick - below) / std::max(share, 1e-9f));
        chosen = i;
        break;
      }
      below += share;
    }
  }
  const Vec3 direction = phase[chosen]->sample(w.nm[0], forward, std::min(pick, 0x1.fffffep-1f), u, density);
  if (n > 1) density = phase_value(w, dot(forward, direction))[0];
  return direction;
}

Spectrum transmittance_over(const Spectrum &extinction, float t) {
  Spectrum s = exp(extinction * -t);
  for (int i = 0; i < kWavelengths; ++i) s[i] = extinction[i] > 0 ? s[i] : 1.0f;
  return s;
}

GatherDistance::GatherDistance(const Scene &scene, const Ray &ray, float t_max) : t_max_(t_max) {
  const LightTables &lights = *scene.lights;
  for (size_t i = 0; i < lights.lamps.size() && i < kMostExamined; ++i) {
    const LampModel &lamp = lights.lamps[i];
    if (!lamp.valid || lamp.type == OPAL_LIGHT_SUN) continue;
    const float size = std::max({lamp.radius, 0.5f * lamp.half_u, 0.5f * lamp.half_v});
    add_lamp(ray, lamp.position, size, std::abs(lamp.intensity) * lamp.brightness, lit_part(lamp, ray, t_max));
  }
  for (size_t i = 0; i < lights.glows.size() && i < kMostExamined; ++i)
    add_lamp(ray, lights.glows[i].centre, 0.5f * lights.glows[i].radius, lights.glows[i].power, {0, t_max});
  float sum = 0;
  for (int i = 0; i < n_lamps_; ++i) sum += lamps_[i].share;
  for (int i = 0; i < n_lamps_; ++i) lamps_[i].share = lerp(lamps_[i].share / sum, 1 / float(n_lamps_), kEvenly);
}

void GatherDistance::add_lamp(const Ray &ray, const Vec3 &centre, float size, float power, const LitPart &lit) {
  if (!(lit.begin < lit.end)) return;
  Lamp l;
  l.begin = lit.begin, l.end = lit.end;
  const Vec3 to_lamp = centre - ray.origin;
  l.foot = dot(to_lamp, ray.direction);
  // A lamp on the ray itself would make the density infinite; its own size is a fair least distance.
  l.height = std::max(length(to_lamp - ray.direction * l.foot), 1e-3f * length(to_lamp) + size);
  l.theta_a = std::atan2(lit.begin - l.foot, l.height);
  l.theta_b = std::isfinite(lit.end) ? std::atan2(lit.end - l.foot, l.height) : 0.5f * kPi;
  if (!(l.theta_b > l.theta_a)) return;
  // The integral of intensity over squared distance.
  l.share = power * (l.theta_b - l.theta_a) / l.height;
  if (!(l.share > 0) || !std::isfinite(l.share)) return;
  if (n_lamps_ < kMostLamps) {
    lamps_[n_lamps_++] = l;
    return;
  }
  Lamp *least_lamp =
      std::min_element(lamps_, lamps_ + n_lamps_, [](const Lamp &a, const Lamp &b) { return a.share < b.share; });
  if (least_lamp->share < l.share) *least_lamp = l;
}

GatherDistance::GatherDistance(const Scene &scene, const Ray &ray, float t_max, const StratifiedMedia &media)
    : GatherDistance(scene, ray, t_max) {
  media_ = &media;
  collided_ = -std::expm1(-media.mean_depth(t_max));
  if (collided_ > 0) share_ = n_lamps_ > 0 ? 0.5f : 1.0f;
}

float GatherDistance::exponential_density(float t) const {
  return media_->mean_extinction(t) * std::exp(-media_->mean_depth(t)) / collided_;
}

float GatherDistance::equiangular_density(const Lamp &l, float t) const {
  if (t < l.begin || t > l.end) return 0;
  return l.height / ((l.theta_b - l.theta_a) * (sqr(l.height) + sqr(t - l.foot)));
}

float GatherDistance::density(float t) const {
  float lamps = 0;
  for (int i = 0; i < n_lamps_; ++i) lamps += lamps_[i].share * equiangular_density(lamps_[i], t);
  return (share_ > 0 ? share_ * exponential_density(t) : 0.0f) + (1 - share_) * lamps;
}

float GatherDistance::sample(float pick, float u, float &density_out) const {
  float t;
  if (pick < share_) {
    t = media_->reach_mean(-std::log1p(-u * collided_));
  } else {
    if (n_lamps_ == 0) return density_out = 0;
    float rest = (pick - share_) / (1 - share_);
    int i = 0;
    while (i + 1 < n_lamps_ && rest >= lamps_[i].share) rest -= lamps_[i++].share;
    const Lamp &l = lamps_[i];
    t = clamp(l.foot + l.height * std::tan(lerp(l.theta_a, l.theta_b, u)), l.begin, l.end);
  }
  t = clamp(t, 0.0f, t_max_);
  density_out = density(t);
  return t;
}

MediumSet media_that_fill(const Scene &scene, const MediumSet &entered, const InteriorStack &interior) {
  const InteriorStack::Entry *solid = interior.current();
  if (!solid) return entered;
  MediumSet there;
  for (int i = 0; i < entered.count(); ++i) {
    const uint32_t instance = entered[i].instance;
    if (instance >= scene.instances.size()) continue;  // the world's
    const bool smaller = !interior.contains(instance) && scene.instances[instance].order > solid->order;
    if (instance == solid->instance || smaller) there.enter(instance, entered[i].medium);
  }
  return there;
}

MediumSet media_at(const Scene &scene, const Vec3 &p) {
  MediumSet entered;  // boundaries of what lies further along the ray
  MediumSet result;
  if (scene.world_medium >= 0) result.enter(~0u, scene.world_medium);
  if (!scene.any_medium) return result;
  Ray ray{p, normalize(Vec3{0.3017f, 0.5211f, 0.7984f})};
  for (int i = 0; i < 256; ++i) {
    const Hit hit = scene.intersect(ray, ~0u);
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
    ray.origin = offset_origin(sp, ray.direction);
  }
  return result;
}

}  // namespace opal
