// SPDX-License-Identifier: GPL-3.0-or-later
// The one source of random numbers: Owen-scrambled Sobol points addressed by (seed, stream, index, dimension).
//
// Burley 2020, "Practical Hash-based Owen Scrambling" (JCGT 9(4)): groups of four dimensions are padded with
// independently shuffled and scrambled copies of the first four Sobol dimensions. No state, so any thread can draw
// any number and the picture does not depend on which does.
#pragma once

#include "core/vec.h"

#include <cstdint>

namespace opal {

constexpr uint32_t hash32(uint32_t x) {  // Wellons' lowbias32
  x ^= x >> 16, x *= 0x7feb352du, x ^= x >> 15, x *= 0x846ca68bu, x ^= x >> 16;
  return x;
}
constexpr uint32_t hash32(uint32_t a, uint32_t b) { return hash32(a ^ (hash32(b) + 0x9e3779b9u + (a << 6) + (a >> 2))); }

constexpr uint32_t reverse_bits(uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  x = ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
  return x;
}
// Laine-Karras permutation on the reversed bits (constants of Burley's paper, section 4).
constexpr uint32_t owen_scramble_reversed(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau, x += seed, x *= (seed >> 16) | 1u, x ^= x * 0x05526c56u, x ^= x * 0x53a22864u;
  return x;
}

class Sampler {
 public:
  // stream: what the numbers are for (a pixel, the photons of a pass); index: which sample of it.
  constexpr Sampler(uint32_t seed, uint32_t stream, uint32_t index) : key_(hash32(seed, stream)), index_(index) {}

  // Two well-stratified numbers in [0,1). Even dimensions only; a pair never straddles a group of four.
  Vec2 get2d(uint32_t dimension) const {
    if (dimension >= kLastSobolDimension) return {independent(dimension), independent(dimension + 1)};
    const uint32_t group = dimension >> 2, component = dimension & 3u;
    const uint32_t group_key = hash32(key_, group);
    const uint32_t shuffled = owen_scramble_reversed(reverse_bits(index_), group_key);  // reversed order
    const uint32_t i = reverse_bits(shuffled);
    return {to_float(scrambled(i, component, group_key)), to_float(scrambled(i, component + 1, group_key))};
  }
  float get1d(uint32_t dimension) const {
    if (dimension >= kLastSobolDimension) return independent(dimension);
    const uint32_t group = dimension >> 2, component = dimension & 3u;
    const uint32_t group_key = hash32(key_, group);
    const uint32_t i = reverse_bits(owen_scramble_reversed(reverse_bits(index_), group_key));
    return to_float(scrambled(i, component, group_key));
  }
  constexpr uint32_t key() const { return key_; }
  constexpr uint32_t index() const { return index_; }

  // From here on plain hashed numbers: after many events stratification is lost anyway, and they are cheaper.
  static constexpr uint32_t kLastSobolDimension = 136;

 private:
  float independent(uint32_t dimension) const { return to_float(hash32(hash32(key_, dimension), index_)); }
  static uint32_t scrambled(uint32_t index, uint32_t component, uint32_t group_key);
  static float to_float(uint32_t x) { return float(x >> 8) * 0x1p-24f; }

  uint32_t key_, index_;
};

// Where each decision of a path finds its numbers.
enum Dimension : uint32_t {
  kDimFilter = 0,         // 2
  kDimLens = 2,           // 2
  kDimTime = 4,           // 1
  kDimWavelength = 5,     // 1
  kDimEmissionLight = 6,  // 2: which light, spare
  kDimEmissionPosition = 8,
  kDimEmissionDirection = 10,
  kDimEmissionWay = 12,  // 1: through the world's medium
  kDimBounce = 16,       // first of the per-bounce blocks
};
inline constexpr uint32_t kDimsPerBounce = 20;
enum BounceDimension : uint32_t {
  kDimBsdf = 0,             // 2
  kDimBsdfLobe = 2,         // 1
  kDimRoulette = 3,         // 1
  kDimLight = 4,            // 2
  kDimLightPick = 6,        // 1
  kDimTransparency = 7,     // 1
  kDimMedium = 8,           // 1
  kDimMediumPhase = 10,     // 2
  kDimMediumDistance = 12,  // 2
  kDimMediumLight = 14,     // 2
  kDimMediumPick = 16,      // 1
  kDimSpare = 17,
  kDimMarch = 18,  // 1
};
constexpr uint32_t bounce_dimension(uint32_t bounce, uint32_t which) { return kDimBounce + bounce * kDimsPerBounce + which; }

}  // namespace opal
