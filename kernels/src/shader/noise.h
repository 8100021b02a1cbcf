// SPDX-License-Identifier: GPL-3.0-or-later
// Perlin's gradient noise (Perlin 2002, "Improving noise") in 1 to 4 dimensions, and the fractals of the Noise node
// (Musgrave, in Ebert et al., "Texturing and Modeling").
//
// Same lattice hash, gradients and output scale as Blender, so that patterns coincide.
#pragma once

#include "shader/registers.h"

namespace opal {

template <int N>
struct Point {
  float v[N];
};
template <int N>
constexpr Point<N> operator*(Point<N> p, float s) {
  for (float &x : p.v) x *= s;
  return p;
}
template <int N>
constexpr Point<N> operator+(Point<N> p, const Point<N> &q) {
  for (int i = 0; i < N; ++i) p.v[i] += q.v[i];
  return p;
}

// In [-1, 1].
template <int N>
float signed_noise(const Point<N> &p);

struct Fractal {
  int type = OPAL_NOISE_FBM;
  float detail = 2, roughness = 0.5f, lacunarity = 2, offset = 0, gain = 1;
  bool normalize = true;
};
template <int N>
float fractal_noise(const Fractal &f, const Point<N> &p);

// The Noise node: factor, and colour where wanted. `p` and `w` are scaled already.
float noise_texture(const Fractal &f, int dimensions, const Vec3 &p, float w, float distortion, bool color_wanted, Vec3 &color);
// The White Noise node.
float white_noise(int dimensions, const Vec3 &p, float w, Vec3 &color);

}  // namespace opal
