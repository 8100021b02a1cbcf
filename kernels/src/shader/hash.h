// SPDX-License-Identifier: GPL-3.0-or-later
// The hashes behind Blender's procedural textures, so that a pattern falls where it falls in Cycles.
//
// Jenkins' lookup3 (burtleburtle.net/bob/c/lookup3.c, public domain) for Perlin and white noise; PCG in 2-4 dimensions
// (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering") for the cells of Voronoi.
#pragma once

#include <bit>
#include <cstdint>

namespace opal {

namespace jenkins {

constexpr uint32_t rotate(uint32_t x, int k) { return std::rotl(x, k); }

struct State {
  uint32_t a, b, c;

  constexpr void mix() {
    a -= c, a ^= rotate(c, 4), c += b;
    b -= a, b ^= rotate(a, 6), a += c;
    c -= b, c ^= rotate(b, 8), b += a;
    a -= c, a ^= rotate(c, 16), c += b;
    b -= a, b ^= rotate(a, 19), a += c;
    c -= b, c ^= rotate(b, 4), b += a;
  }
  constexpr uint32_t finish() {
    c ^= b, c -= rotate(b, 14);
    a ^= c, a -= rotate(c, 11);
    b ^= a, b -= rotate(a, 25);
    c ^= b, c -= rotate(b, 16);
    a ^= c, a -= rotate(c, 4);
    b ^= a, b -= rotate(a, 14);
    c ^= b, c -= rotate(b, 24);
    return c;
  }
};

}  // namespace jenkins

// Hash of N words, 1 <= N <= 4.
template <int N>
constexpr uint32_t hash_words(const uint32_t (&k)[N]) {
  static_assert(N >= 1 && N <= 4);
  const uint32_t seed = 0xdeadbeefu + (uint32_t(N) << 2) + 13u;
  jenkins::State s{seed, seed, seed};
  s.a += k[0];
  if constexpr (N > 1) s.b += k[1];
  if constexpr (N > 2) s.c += k[2];
  if constexpr (N > 3) {
    s.mix();
    s.a += k[3];
  }
  return s.finish();
}

// Hash of the bits of N floats, in [0, 1].
template <int N>
inline float hash_floats(const float (&k)[N]) {
  uint32_t words[N];
  for (int i = 0; i < N; ++i) words[i] = std::bit_cast<uint32_t>(k[i]);
  return float(hash_words(words)) * (1.0f / float(0xFFFFFFFFu));
}

// N integers scattered in place, each to [0, 2^31 - 1]; 2 <= N <= 4.
template <int N>
constexpr void pcg(int32_t (&v)[N]) {
  uint32_t u[N];
  for (int i = 0; i < N; ++i) u[i] = uint32_t(v[i]) * 1664525u + 1013904223u;
  const auto round = [&u] {
    if constexpr (N == 2) {
      u[0] += u[1] * 1664525u, u[1] += u[0] * 1664525u;
    } else if constexpr (N == 3) {
      u[0] += u[1] * u[2], u[1] += u[2] * u[0], u[2] += u[0] * u[1];
    } else {
      u[0] += u[1] * u[3], u[1] += u[2] * u[0], u[2] += u[0] * u[1], u[3] += u[1] * u[2];
    }
  };
  round();
  // Blender hashes signed integers: the shift carries the sign along.
  for (int i = 0; i < N; ++i) u[i] ^= uint32_t(int32_t(u[i]) >> 16);
  round();
  for (int i = 0; i < N; ++i) v[i] = int32_t(u[i] & 0x7FFFFFFFu);
}

}  // namespace opal
