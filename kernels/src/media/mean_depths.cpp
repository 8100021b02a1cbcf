// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/mean_depths.h"

#include <algorithm>

namespace opal {

MeanDepths::MeanDepths(const Scene &scene, const MediumSet &set, const Wavelengths &w, const Ray &ray, float t_end) {
  RayMedia media(scene, set, w, ray);
  RayMedia::Interval interval;
  float depth = 0;
  while (media.next(t_end, interval)) {
    if (!(interval.mean > 0)) continue;
    if (!std::isfinite(interval.end)) break;
    const float more = interval.mean * (interval.end - interval.begin);
    append({interval.begin, interval.end, depth, more});
    depth += more;
  }
}

void MeanDepths::append(const Step &step) {
  if (n_ == kMost) {  // two and two become one
    n_ /= 2;
    for (int i = 0; i < n_; ++i) {
      const Step &a = steps_[2 * i], &b = steps_[2 * i + 1];
      steps_[i] = {a.begin, b.end, a.before, a.depth + b.depth};
    }
  }
  steps_[n_++] = step;
}

const MeanDepths::Step *MeanDepths::step_at(float t) const {
  const Step *after = std::upper_bound(steps_, steps_ + n_, t, [](float x, const Step &s) { return x < s.begin; });
  return after == steps_ ? nullptr : after - 1;
}

float MeanDepths::mean_extinction(float t) const {
  const Step *s = step_at(t);
  return s && t <= s->end ? s->slope() : 0.0f;
}

float MeanDepths::mean_depth(float t) const {
  const Step *s = step_at(t);
  return s ? s->before + s->slope() * (std::min(t, s->end) - s->begin) : 0.0f;
}

float MeanDepths::reach_mean(float depth) const {
  const Step *after = std::upper_bound(steps_, steps_ + n_, depth, [](float x, const Step &s) { return x < s.before; });
  if (after == steps_) return 0;
  const Step &s = after[-1];
  return std::min(s.begin + (depth - s.before) / s.slope(), s.end);
}

}  // namespace opal
