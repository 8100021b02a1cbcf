// SPDX-License-Identifier: GPL-3.0-or-later
// Direction numbers of the first four Sobol dimensions (Joe & Kuo 2008, new-joe-kuo-6), generated at compile time.
#include "core/sampler.h"

#include <array>

namespace opal {
namespace {

struct Polynomial {
  uint32_t degree, coefficients;
  std::array<uint32_t, 3> initial;
};
// Dimensions 2, 3, 4 of the table; dimension 1 is van der Corput.
constexpr std::array<Polynomial, 3> kPolynomials = {{{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}}};

constexpr std::array<uint32_t, 32> direction_numbers(const Polynomial &p) {
  std::array<uint32_t, 32> v{};
  for (uint32_t i = 0; i < 32; ++i) {
    if (i < p.degree) {
      v[i] = p.initial[i] << (31 - i);
    } else {
      v[i] = v[i - p.degree] ^ (v[i - p.degree] >> p.degree);
      for (uint32_t k = 1; k < p.degree; ++k)
        if ((p.coefficients >> (p.degree - 1 - k)) & 1u) v[i] ^= v[i - k];
    }
  }
  return v;
}

// The matrix applied a byte at a time: table[byte position][byte value].
using ByteTable = std::array<std::array<uint32_t, 256>, 4>;
constexpr ByteTable byte_table(const std::array<uint32_t, 32> &v) {
  ByteTable t{};
  for (uint32_t byte = 0; byte < 4; ++byte)
    for (uint32_t value = 0; value < 256; ++value)
      for (uint32_t bit = 0; bit < 8; ++bit)
        if ((value >> bit) & 1u) t[byte][value] ^= v[byte * 8 + bit];
  return t;
}
constexpr std::array<ByteTable, 3> kSobol = {byte_table(direction_numbers(kPolynomials[0])),
                                             byte_table(direction_numbers(kPolynomials[1])),
                                             byte_table(direction_numbers(kPolynomials[2]))};

uint32_t sobol(uint32_t index, uint32_t component) {
  if (component == 0) return reverse_bits(index);
  const ByteTable &t = kSobol[component - 1];
  return t[0][index & 255u] ^ t[1][(index >> 8) & 255u] ^ t[2][(index >> 16) & 255u] ^ t[3][index >> 24];
}

}  // namespace

uint32_t Sampler::scrambled(uint32_t index, uint32_t component, uint32_t group_key) {
  const uint32_t seed = hash32(group_key, component + 1);
  return reverse_bits(owen_scramble_reversed(reverse_bits(sobol(index, component)), seed));
}

}  // namespace opal
