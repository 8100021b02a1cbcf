// SPDX-License-Identifier: GPL-3.0-or-later
// As many random numbers as a walk takes, for one decision of a path: hashed, addressed by sampler and dimension.
#pragma once

#include "core/sampler.h"

namespace opal {

class RandomStream {
 public:
  RandomStream(const Sampler &sampler, uint32_t dimension)
      : key_(hash32(hash32(sampler.key(), dimension ^ 0x5bd1e995u), sampler.index())) {}
  explicit RandomStream(uint32_t key) : key_(key) {}
  // In [0, 1).
  float next() { return float(hash32(key_, count_++) >> 8) * 0x1p-24f; }

 private:
  uint32_t key_, count_ = 0;
};

}  // namespace opal
