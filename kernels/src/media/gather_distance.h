// SPDX-License-Identifier: GPL-3.0-or-later
// Where along a ray through media direct light is gathered.
#pragma once

#include "scene/scene.h"

namespace opal {

struct LitPart;

// Equiangular distances about lamps and things that glow (Kulla & Fajardo 2012, "Importance Sampling Techniques for Path
// Tracing in Participating Media"). A lamp's distances lie where its beam passes, and lamps share them by what they would bring
// if nothing stood between.
class LampDistances {
 public:
  LampDistances(const Scene &scene, const Ray &ray, float t_max);
  bool empty() const { return n_ == 0; }
  float sample(float pick, float u) const;  // not when empty
  float density(float t) const;

 private:
  struct Lamp {
    float begin, end, foot, height, theta_a, theta_b;
    float share = 0;
  };
  void add(const Ray &ray, const Vec3 &centre, float size, float power, const LitPart &lit);

  static constexpr int kMost = 8, kMostExamined = 64;
  static constexpr float kEvenly = 0.1f;  // shared among the lamps alike: the brightest may stand behind a wall
  Lamp lamps_[kMost];
  int n_ = 0;
};

// Partly by the media's mean transmittance, truncated to the segment, partly for the lamps' sake, as one mixture whose density
// is known at every t. Media has mean_extinction(t), mean_depth(t) and its inverse reach_mean(depth), for weights alone.
template <class Media>
class GatherDistance {
 public:
  // `media` has to outlive it. `share`: of the media's part where there are lamps; if 0 there is none without lamps either.
  GatherDistance(const Scene &scene, const Ray &ray, float t_max, const Media &media, float share = 0.5f)
      : lamps_(scene, ray, t_max), media_(media), t_max_(t_max), collided_(-std::expm1(-media.mean_depth(t_max))) {
    if (collided_ > 0 && share > 0) share_ = lamps_.empty() ? 1.0f : share;
  }
  bool empty() const { return share_ == 0 && lamps_.empty(); }
  float density(float t) const {
    const float exponential =
        share_ > 0 ? share_ * media_.mean_extinction(t) * std::exp(-media_.mean_depth(t)) / collided_ : 0.0f;
    return exponential + (1 - share_) * lamps_.density(t);
  }
  // density_out 0: there is no such place.
  float sample(float pick, float u, float &density_out) const {
    if (empty()) return density_out = 0;
    const float t =
        pick < share_ ? media_.reach_mean(-std::log1p(-u * collided_)) : lamps_.sample((pick - share_) / (1 - share_), u);
    const float clamped = clamp(t, 0.0f, t_max_);
    density_out = density(clamped);
    return clamped;
  }

 private:
  const LampDistances lamps_;
  const Media &media_;
  const float t_max_, collided_;  // collided_: the mean transmittance's complement over the segment
  float share_ = 0;               // of the exponential part
};

}  // namespace opal
