// SPDX-License-Identifier: GPL-3.0-or-later
// Places along a space-filling curve (Morton 1966) as numbers, each of the pass's wavelength sets apart.
#pragma once

#include "core/vec.h"

namespace opal {

class CurveOfSets {
 public:
  static constexpr int kAxisBits = 13;  // places along an axis that the curve tells apart: 8192
  static constexpr int kBits = 3 * kAxisBits + 3;

  explicit CurveOfSets(const Bounds &all) {
    if (all.empty()) return;
    const Vec3 size = all.high - all.low;
    const auto scale = [](float extent) { return extent > 0 ? float((1 << kAxisBits) - 1) / extent : 0.0f; };
    low_ = all.low, scales_ = {scale(size.x), scale(size.y), scale(size.z)};
  }

  // Of a place inside the bounds, for a set 0..7.
  uint64_t key(uint32_t set, const Vec3 &place) const {
    const Vec3 p = (place - low_) * scales_;
    return uint64_t(set) << (3 * kAxisBits) | spread(uint32_t(p.x)) | spread(uint32_t(p.y)) << 1 | spread(uint32_t(p.z)) << 2;
  }

 private:
  // The bits of x three places apart.
  static uint64_t spread(uint32_t x) {
    uint64_t v = x;
    v = (v | v << 32) & 0x1f00000000ffffull;
    v = (v | v << 16) & 0x1f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    v = (v | v << 2) & 0x1249249249249249ull;
    return v;
  }

  Vec3 low_, scales_;
};

}  // namespace opal
