// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/gather_distance.h"

#include "lights/lamp.h"
#include "lights/light_tables.h"

#include <algorithm>

namespace opal {

LampDistances::LampDistances(const Scene &scene, const Ray &ray, float t_max) {
  const LightTables &lights = *scene.lights;
  for (size_t i = 0; i < lights.lamps.size() && i < kMostExamined; ++i) {
    const LampModel &lamp = lights.lamps[i];
    if (!lamp.valid || lamp.type == OPAL_LIGHT_SUN) continue;
    const float size = std::max({lamp.radius, 0.5f * lamp.half_u, 0.5f * lamp.half_v});
    add(ray, lamp.position, size, std::abs(lamp.intensity) * lamp.brightness, lit_part(lamp, ray, t_max));
  }
  for (size_t i = 0; i < lights.glows.size() && i < kMostExamined; ++i)
    add(ray, lights.glows[i].centre, 0.5f * lights.glows[i].radius, lights.glows[i].power, {0, t_max});
  float sum = 0;
  for (int i = 0; i < n_; ++i) sum += lamps_[i].share;
  for (int i = 0; i < n_; ++i) lamps_[i].share = lerp(lamps_[i].share / sum, 1 / float(n_), kEvenly);
}

void LampDistances::add(const Ray &ray, const Vec3 &centre, float size, float power, const LitPart &lit) {
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
  if (n_ < kMost) {
    lamps_[n_++] = l;
    return;
  }
  Lamp *least_lamp = std::min_element(lamps_, lamps_ + n_, [](const Lamp &a, const Lamp &b) { return a.share < b.share; });
  if (least_lamp->share < l.share) *least_lamp = l;
}

float LampDistances::density(float t) const {
  float sum = 0;
  for (int i = 0; i < n_; ++i) {
    const Lamp &l = lamps_[i];
    if (t >= l.begin && t <= l.end) sum += l.share * l.height / ((l.theta_b - l.theta_a) * (sqr(l.height) + sqr(t - l.foot)));
  }
  return sum;
}

float LampDistances::sample(float pick, float u) const {
  int i = 0;
  while (i + 1 < n_ && pick >= lamps_[i].share) pick -= lamps_[i++].share;
  const Lamp &l = lamps_[i];
  return clamp(l.foot + l.height * std::tan(lerp(l.theta_a, l.theta_b, u)), l.begin, l.end);
}

}  // namespace opal
