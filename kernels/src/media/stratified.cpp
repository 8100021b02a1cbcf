// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/stratified.h"

namespace opal {
namespace {

// exp(-40) is 4e-18: above forty scale heights there is nothing left to meet.
constexpr float kHighest = 40;

}  // namespace

HeightProfile::HeightProfile(const DensityField &field, const Vec3 &origin, const Vec3 &direction) {
  if (field.kind != DensityKind::Height) return;
  scale_ = field.scale_height;
  start_ = (origin.z - field.base_height) / scale_;
  rise_ = direction.z / scale_;
}

float HeightProfile::density(float t) const {
  if (even()) return 1;
  const float x = start_ + (rise_ != 0 ? rise_ * t : 0.0f);
  return x <= 0 ? 1.0f : x >= kHighest ? 0.0f : std::exp(-x);
}

float HeightProfile::depth_above(float x, float t) const {
  if (x >= kHighest && rise_ >= 0) return 0;
  if (rise_ == 0) return std::exp(-x) * t;
  const float grown = rise_ * t;
  if (std::abs(grown) < 1) return -std::expm1(-grown) * std::exp(-x) / rise_;
  return (std::exp(-x) - std::exp(-(x + grown))) / rise_;
}

float HeightProfile::reach_above(float x, float depth) const {
  if (x >= kHighest && rise_ >= 0) return kInfinity;
  if (x > kHighest) return (x + std::log(depth * -rise_)) / -rise_;
  const float whole = depth * std::exp(x);  // at this height's density
  if (rise_ == 0) return whole;
  const float lost = whole * rise_;
  return lost < 1 ? -std::log1p(-lost) / rise_ : kInfinity;
}

float HeightProfile::depth(float t) const {
  if (even()) return t;
  if (start_ <= 0) {
    if (rise_ <= 0 || t <= crossing()) return t;
    return crossing() + depth_above(0, t - crossing());
  }
  if (rise_ >= 0 || t <= crossing()) return depth_above(start_, t);
  return depth_above(start_, crossing()) + (t - crossing());
}

float HeightProfile::reach(float depth) const {
  if (even()) return depth;
  if (start_ <= 0) {
    if (rise_ <= 0 || depth <= crossing()) return depth;
    return crossing() + reach_above(0, depth - crossing());
  }
  if (rise_ >= 0) return reach_above(start_, depth);
  const float above = depth_above(start_, crossing());
  return depth <= above ? reach_above(start_, depth) : crossing() + (depth - above);
}

bool StratifiedMedia::holds(const Scene &scene, const MediumSet &set) {
  for (int i = 0; i < set.count(); ++i) {
    const Medium &medium = scene.media[size_t(set[i].medium)];
    if (!medium.varies()) continue;
    const bool grids = medium.scattering_grid >= 0 || medium.absorption_grid >= 0 || medium.emission_grid >= 0;
    if (medium.density.kind != DensityKind::Height || medium.emission >= 0 || grids) return false;
  }
  return true;
}

StratifiedMedia::StratifiedMedia(const Scene &scene, const MediumSet &set, const Wavelengths &w, const Ray &ray) {
  OneMedium each[MediumSet::kCapacity];
  full_ = medium_here(scene, set, w, each);
  for (int i = 0; i < set.count(); ++i) {
    const Medium &medium = scene.media[size_t(set[i].medium)];
    Part &part = parts_.add();
    part.medium = each[i];
    part.mean = each[i].extinction.average();
    if (medium.density.kind != DensityKind::Height) continue;
    homogeneous_ = false;
    Vec3 origin = ray.origin, direction = ray.direction;
    if (set[i].instance < scene.instances.size()) {
      const Transform &to_object = scene.instances[set[i].instance].to_object;
      origin = to_object.point(origin), direction = to_object.vector(direction);
    }
    part.profile = HeightProfile(medium.density, origin, direction);
    if (set[i].instance != MediumSet::kOfWorld) continue;
    const float to_floor = (scene.world_floor - origin.z) / direction.z;
    if (direction.z > 0) part.first = std::max(0.0f, to_floor);
    else if (direction.z < 0) part.last = to_floor;
    else if (origin.z < scene.world_floor) part.last = -1;
  }
}

const MediumHere &StratifiedMedia::at(float t, MediumHere &scratch) const {
  if (homogeneous_) return full_;
  scratch = full_;
  scratch.extinction = scratch.scattering = Spectrum(0.0f);
  for (const Part &part : parts_) {
    const float density = part.profile.density(t);
    const Spectrum extinction = part.medium.extinction * density;
    scratch.extinction += extinction;
    if (part.medium.part < 0) continue;
    Spectrum &scattering = scratch.parts[part.medium.part].scattering;
    scattering *= t >= part.first && t <= part.last ? density : 0.0f;
    scratch.scattering += scattering;
  }
  return scratch;
}

Spectrum StratifiedMedia::depth(float t) const {
  Spectrum sum(0.0f);
  for (const Part &part : parts_) {
    const float length = part.profile.depth(t);
    for (int k = 0; k < kWavelengths; ++k)
      if (part.medium.extinction[k] > 0) sum[k] += part.medium.extinction[k] * length;
  }
  return sum;
}

Spectrum StratifiedMedia::transmittance(float t) const { return exp(depth(t) * -1.0f); }

float StratifiedMedia::mean_extinction(float t) const {
  float sum = 0;
  for (const Part &part : parts_) sum += part.mean * part.profile.density(t);
  return sum;
}

float StratifiedMedia::mean_depth(float t) const {
  float sum = 0;
  for (const Part &part : parts_)
    if (part.mean > 0) sum += part.mean * part.profile.depth(t);
  return sum;
}

// One medium in closed form; several by Newton's method between bounds that close in.
float StratifiedMedia::reach(float depth, bool hero) const {
  const auto coefficient = [hero](const Part &part) { return hero ? part.medium.extinction[0] : part.mean; };
  if (homogeneous_ || parts_.count() == 1) {
    float sum = 0;
    for (const Part &part : parts_) sum += coefficient(part);
    if (!(sum > 0)) return kInfinity;
    return homogeneous_ ? depth / sum : parts_[0].profile.reach(depth / sum);
  }
  const auto reached = [&](float t, float &slope) {
    float sum = 0;
    slope = 0;
    for (const Part &part : parts_) {
      const float c = coefficient(part);
      if (c > 0) sum += c * part.profile.depth(t), slope += c * part.profile.density(t);
    }
    return sum;
  };
  constexpr float kFarthest = 1e12f;
  float slope, low = 0, high = 1;
  while (reached(high, slope) < depth) {
    low = high, high *= 4;
    if (high > kFarthest) return kInfinity;
  }
  float t = 0.5f * (low + high);
  for (int i = 0; i < 60; ++i) {
    const float over = reached(t, slope) - depth;
    if (std::abs(over) < 1e-6f * depth || high - low < 1e-6f * high) break;
    (over > 0 ? high : low) = t;
    const float next = slope > 0 ? t - over / slope : high;
    t = next > low && next < high ? next : 0.5f * (low + high);
  }
  return t;
}

}  // namespace opal
