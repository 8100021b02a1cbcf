// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader/noise.h"

#include "shader/hash.h"

namespace opal {
namespace {

float signed_if(float x, uint32_t negative) { return negative ? -x : x; }

// The slope at a lattice point, times the offset from it.
template <int N>
float gradient(uint32_t hash, const float *d) {
  if constexpr (N == 1) {
    return signed_if(1 + float(hash & 7), hash & 8) * d[0];
  } else if constexpr (N == 2) {
    const uint32_t h = hash & 7;
    const float u = h < 4 ? d[0] : d[1], v = 2 * (h < 4 ? d[1] : d[0]);
    return signed_if(u, h & 1) + signed_if(v, h & 2);
  } else if constexpr (N == 3) {
    const uint32_t h = hash & 15;
    const float u = h < 8 ? d[0] : d[1];
    const float v = h < 4 ? d[1] : (h == 12 || h == 14) ? d[0] : d[2];
    return signed_if(u, h & 1) + signed_if(v, h & 2);
  } else {
    const uint32_t h = hash & 31;
    const float u = h < 24 ? d[0] : d[1], v = h < 16 ? d[1] : d[2], s = h < 8 ? d[2] : d[3];
    return signed_if(u, h & 1) + signed_if(v, h & 2) + signed_if(s, h & 4);
  }
}

template <int N>
float perlin(const Point<N> &p) {
  int32_t cell[N];
  float fraction[N], fade[N];
  for (int i = 0; i < N; ++i) {
    const float whole = std::floor(p.v[i]);
    cell[i] = int32_t(whole);
    const float t = fraction[i] = p.v[i] - whole;
    fade[i] = t * t * t * (t * (t * 6 - 15) + 10);
  }
  float corner[1 << N];
  for (uint32_t c = 0; c < (1u << N); ++c) {
    uint32_t words[N];
    float d[N];
    for (int i = 0; i < N; ++i) {
      const uint32_t bit = (c >> i) & 1;
      words[i] = uint32_t(cell[i]) + bit;
      d[i] = fraction[i] - float(bit);
    }
    corner[c] = gradient<N>(hash_words(words), d);
  }
  for (int i = 0, n = 1 << (N - 1); i < N; ++i, n /= 2)
    for (int c = 0; c < n; ++c) corner[c] = (1 - fade[i]) * corner[2 * c] + fade[i] * corner[2 * c + 1];
  return corner[0];
}

// Bring the noise to [-1, 1]; found by trial by the authors of Open Shading Language, for 1 to 4 dimensions.
constexpr float kNoiseScale[5] = {0, 0.25f, 0.6616f, 0.9820f, 0.8344f};

// A vector of random shifts in [100, 200]: stands for a seed, which the noise has not.
template <int N>
Point<N> random_shift(float seed) {
  Point<N> s;
  if constexpr (N == 1) {
    s.v[0] = 100 + 100 * hash_floats({seed});
  } else {
    for (int i = 0; i < N; ++i) s.v[i] = 100 + 100 * hash_floats({seed, float(i)});
  }
  return s;
}

template <int N>
float fbm(const Fractal &f, const Point<N> &p) {
  float scale = 1, amplitude = 1, total = 0, sum = 0;
  for (int i = 0; i <= int(f.detail); ++i) {
    sum += amplitude * signed_noise(p * scale);
    total += amplitude;
    amplitude *= f.roughness;
    scale *= f.lacunarity;
  }
  const float rest = f.detail - std::floor(f.detail);
  const auto result = [&f](float s, float t) { return f.normalize ? 0.5f * s / t + 0.5f : s; };
  if (rest == 0) return result(sum, total);
  const float next = sum + amplitude * signed_noise(p * scale);
  return lerp(result(sum, total), result(next, total + amplitude), rest);
}

template <int N>
float multifractal(const Fractal &f, Point<N> p) {
  float value = 1, amplitude = 1;
  for (int i = 0; i <= int(f.detail); ++i) {
    value *= amplitude * signed_noise(p) + 1;
    amplitude *= f.roughness;
    p = p * f.lacunarity;
  }
  const float rest = f.detail - std::floor(f.detail);
  return rest != 0 ? value * (rest * amplitude * signed_noise(p) + 1) : value;
}

template <int N>
float hetero_terrain(const Fractal &f, Point<N> p) {
  float value = f.offset + signed_noise(p), amplitude = f.roughness;
  p = p * f.lacunarity;
  for (int i = 1; i <= int(f.detail); ++i) {
    value += (signed_noise(p) + f.offset) * amplitude * value;
    amplitude *= f.roughness;
    p = p * f.lacunarity;
  }
  const float rest = f.detail - std::floor(f.detail);
  return rest != 0 ? value + rest * (signed_noise(p) + f.offset) * amplitude * value : value;
}

template <int N>
float hybrid_multifractal(const Fractal &f, Point<N> p) {
  float amplitude = 1, value = 0, weight = 1;
  for (int i = 0; weight > 0.001f && i <= int(f.detail); ++i) {
    weight = std::min(weight, 1.0f);
    const float signal = (signed_noise(p) + f.offset) * amplitude;
    amplitude *= f.roughness;
    value += weight * signal;
    weight *= f.gain * signal;
    p = p * f.lacunarity;
  }
  const float rest = f.detail - std::floor(f.detail);
  if (rest != 0 && weight > 0.001f) {
    weight = std::min(weight, 1.0f);
    value += rest * weight * (signed_noise(p) + f.offset) * amplitude;
  }
  return value;
}

template <int N>
float ridged_multifractal(const Fractal &f, Point<N> p) {
  float amplitude = f.roughness;
  float signal = sqr(f.offset - std::abs(signed_noise(p)));
  float value = signal;
  for (int i = 1; i <= int(f.detail); ++i) {
    p = p * f.lacunarity;
    const float weight = saturate(signal * f.gain);
    signal = sqr(f.offset - std::abs(signed_noise(p))) * weight;
    value += signal * amplitude;
    amplitude *= f.roughness;
  }
  return value;
}

template <int N>
float texture(const Fractal &f, Point<N> p, float distortion, bool color_wanted, Vec3 &color) {
  if (distortion != 0) {
    Point<N> shift;
    for (int i = 0; i < N; ++i) shift.v[i] = signed_noise(p + random_shift<N>(float(i))) * distortion;
    p = p + shift;
  }
  const float value = fractal_noise(f, p);
  if (color_wanted)
    color = {value, fractal_noise(f, p + random_shift<N>(float(N))), fractal_noise(f, p + random_shift<N>(float(N + 1)))};
  return value;
}

}  // namespace

template <int N>
float signed_noise(const Point<N> &p) {
  // The pattern repeats every 100,000 units, where single precision would leave only steps of it.
  Point<N> q;
  for (int i = 0; i < N; ++i) q.v[i] = std::fmod(p.v[i], 100000.0f) + (std::abs(p.v[i]) >= 1000000.0f ? 0.5f : 0.0f);
  for (int i = 0; i < N; ++i)
    if (!std::isfinite(q.v[i])) return 0;
  return kNoiseScale[N] * perlin(q);
}

template <int N>
float fractal_noise(const Fractal &f, const Point<N> &p) {
  switch (f.type) {
    case OPAL_NOISE_MULTIFRACTAL: return multifractal(f, p);
    case OPAL_NOISE_RIDGED_MULTIFRACTAL: return ridged_multifractal(f, p);
    case OPAL_NOISE_HYBRID_MULTIFRACTAL: return hybrid_multifractal(f, p);
    case OPAL_NOISE_HETERO_TERRAIN: return hetero_terrain(f, p);
    default: return fbm(f, p);
  }
}
template float fractal_noise<3>(const Fractal &, const Point<3> &);

float noise_texture(const Fractal &f, int dimensions, const Vec3 &p, float w, float distortion, bool color_wanted,
                    Vec3 &color) {
  switch (dimensions) {
    case 1: return texture<1>(f, {{w}}, distortion, color_wanted, color);
    case 2: return texture<2>(f, {{p.x, p.y}}, distortion, color_wanted, color);
    case 3: return texture<3>(f, {{p.x, p.y, p.z}}, distortion, color_wanted, color);
    default: return texture<4>(f, {{p.x, p.y, p.z, w}}, distortion, color_wanted, color);
  }
}

float white_noise(int dimensions, const Vec3 &p, float w, Vec3 &color) {
  switch (dimensions) {
    case 1: color = {hash_floats({w}), hash_floats({w, 1.0f}), hash_floats({w, 2.0f})}; break;
    case 2: color = {hash_floats({p.x, p.y}), hash_floats({p.x, p.y, 1.0f}), hash_floats({p.x, p.y, 2.0f})}; break;
    case 3:
      color = {hash_floats({p.x, p.y, p.z}), hash_floats({p.x, p.y, p.z, 1.0f}), hash_floats({p.x, p.y, p.z, 2.0f})};
      break;
    default: color = {hash_floats({p.x, p.y, p.z, w}), hash_floats({p.z, p.x, w, p.y}), hash_floats({w, p.z, p.y, p.x})};
  }
  return color.x;
}

}  // namespace opal
