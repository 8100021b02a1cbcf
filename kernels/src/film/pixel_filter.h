// SPDX-License-Identifier: GPL-3.0-or-later
// Pixel filters by importance sampling: a sample's position is drawn from the filter and the pixel takes plain means
// (Ernst, Stamminger & Greiner 2006, "Filter Importance Sampling"). The setting is Cycles' width: pixels across a box; a
// Blackman-Harris window reaches over twice, a Gaussian over three times as many.
#pragma once

#include "core/vec.h"
#include "opal.h"

#include <array>

namespace opal {

class PixelFilter {
 public:
  PixelFilter(int kind, float width)
      : width_(std::max(width, 1e-3f) * (kind == OPAL_FILTER_GAUSSIAN          ? 3.0f
                                         : kind == OPAL_FILTER_BLACKMAN_HARRIS ? 2.0f
                                                                               : 1.0f)) {
    // Tabulated inverse of the cumulative distribution over [-width/2, width/2]; the filters are even.
    constexpr int kSteps = 4096;
    std::array<double, kSteps + 1> cdf{};
    for (int i = 0; i < kSteps; ++i) cdf[size_t(i) + 1] = cdf[size_t(i)] + value(kind, (i + 0.5) / kSteps - 0.5);
    int j = 0;
    for (int i = 0; i <= kSize; ++i) {
      const double target = cdf[kSteps] * i / kSize;
      while (j < kSteps - 1 && cdf[size_t(j) + 1] < target) ++j;
      const double span = cdf[size_t(j) + 1] - cdf[size_t(j)];
      inverse_[size_t(i)] = float((j + (span > 0 ? (target - cdf[size_t(j)]) / span : 0)) / kSteps - 0.5);
    }
  }

  // Offset from the pixel's centre, in pixels.
  Vec2 sample(Vec2 u) const { return {sample(u.x), sample(u.y)}; }
  float width() const { return width_; }  // of the support

 private:
  static constexpr int kSize = 1024;

  // The filter over its support: x in [-1/2, 1/2].
  static double value(int kind, double x) {
    switch (kind) {
      case OPAL_FILTER_GAUSSIAN: return std::exp(-2 * (6 * x) * (6 * x));  // the support ends at six standard deviations
      case OPAL_FILTER_BLACKMAN_HARRIS: {
        const double a = 2 * 3.14159265358979323846 * (x + 0.5);  // Harris 1978, four terms
        return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
      }
      default: return 1;
    }
  }
  float sample(float u) const {
    const float x = u * kSize;
    const int i = std::min(int(x), kSize - 1);
    return width_ * lerp(inverse_[size_t(i)], inverse_[size_t(i) + 1], x - float(i));
  }

  float width_;
  std::array<float, kSize + 1> inverse_{};
};

}  // namespace opal
