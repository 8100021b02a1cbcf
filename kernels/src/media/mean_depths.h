// SPDX-License-Identifier: GPL-3.0-or-later
// How dense media that vary are along a ray, roughly: the mean extinction of each interval of their majorants. It chooses and
// weighs places on the ray and never enters a result.
#pragma once

#include "media/tracking.h"

namespace opal {

class MeanDepths {
 public:
  MeanDepths(const Scene &scene, const MediumSet &set, const Wavelengths &w, const Ray &ray, float t_end);

  float mean_extinction(float t) const;
  // From the origin to t.
  float mean_depth(float t) const;
  // Where a depth is reached; the end where it is not.
  float reach_mean(float depth) const;

 private:
  struct Step {
    float begin, end, before, depth;  // before: the depth at its begin
    float slope() const { return depth / (end - begin); }
  };
  void append(const Step &step);
  // The last step that begins at or before t; null: none.
  const Step *step_at(float t) const;

  static constexpr int kMost = 64;
  Step steps_[kMost];
  int n_ = 0;
};

}  // namespace opal
