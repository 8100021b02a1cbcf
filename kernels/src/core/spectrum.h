// SPDX-License-Identifier: GPL-3.0-or-later
// A spectrum at a path's wavelengths, and what a path knows about those wavelengths.
//
// A path carries kWavelengths wavelengths. Number 0 is the hero: the one whose geometry is followed when dispersion
// separates them (Wilkie et al. 2014, "Hero Wavelength Spectral Sampling"). The others sit at equal steps of the
// cumulative distribution, so that every one of them is distributed alike.
#pragma once

#include "core/vec.h"

#include <array>
#include <bit>
#include <cstdint>

namespace opal {

inline constexpr int kWavelengths = 8;
inline constexpr int kTableFirst = 360, kTableSize = 471;  // 1 nm tables

struct alignas(32) Spectrum {
  float v[kWavelengths];

  Spectrum() = default;
  explicit constexpr Spectrum(float s) : v{} {
    for (float &x : v) x = s;
  }
  constexpr float operator[](int i) const { return v[i]; }
  constexpr float &operator[](int i) { return v[i]; }

#define OPAL_SPECTRUM_OP(op)                               \
  constexpr Spectrum &operator op(const Spectrum &b) {     \
    for (int i = 0; i < kWavelengths; ++i) v[i] op b.v[i]; \
    return *this;                                          \
  }                                                        \
  constexpr Spectrum &operator op(float b) {               \
    for (int i = 0; i < kWavelengths; ++i) v[i] op b;      \
    return *this;                                          \
  }
  OPAL_SPECTRUM_OP(+=)
  OPAL_SPECTRUM_OP(-=)
  OPAL_SPECTRUM_OP(*=)
  OPAL_SPECTRUM_OP(/=)
#undef OPAL_SPECTRUM_OP

  constexpr float sum() const {
    float s = 0;
    for (float x : v) s += x;
    return s;
  }
  constexpr float average() const { return sum() * (1.0f / kWavelengths); }
  constexpr float max() const {
    float m = v[0];
    for (float x : v) m = x > m ? x : m;
    return m;
  }
  constexpr bool is_zero() const {
    for (float x : v)
      if (x != 0) return false;
    return true;
  }
  bool is_finite() const {
    bool ok = true;
    for (float x : v) ok &= std::isfinite(x);
    return ok;
  }
};

constexpr Spectrum operator+(Spectrum a, const Spectrum &b) { return a += b; }
constexpr Spectrum operator-(Spectrum a, const Spectrum &b) { return a -= b; }
constexpr Spectrum operator*(Spectrum a, const Spectrum &b) { return a *= b; }
constexpr Spectrum operator*(Spectrum a, float s) { return a *= s; }
constexpr Spectrum operator*(float s, Spectrum a) { return a *= s; }
constexpr Spectrum operator/(Spectrum a, const Spectrum &b) { return a /= b; }
constexpr Spectrum operator/(Spectrum a, float s) { return a /= s; }

// e to the power of each, for all wavelengths in one go: exp(x) = 2^n exp(f ln 2), x / ln 2 rounded to n, the rest by its
// Taylor series. Within 3 units of the last place; 0 below -87, infinities not handled above 88.
inline Spectrum exp(const Spectrum &x) {
  constexpr float kPerOctave = 1.44269504f, kOctaveHigh = 0.693359375f, kOctaveLow = -2.12194440e-4f;
  constexpr float kRound = 12582912.0f;  // 1.5 * 2^23: adding it leaves whole numbers
  Spectrum result;
  for (int i = 0; i < kWavelengths; ++i) {
    const float clamped = std::min(std::max(x.v[i], -87.0f), 88.0f);
    const float n = (clamped * kPerOctave + kRound) - kRound;
    const float f = (clamped - n * kOctaveHigh) - n * kOctaveLow;
    const float series = 1 + f * (1 + f * (1 / 2.0f + f * (1 / 6.0f + f * (1 / 24.0f + f * (1 / 120.0f + f * (1 / 720.0f))))));
    const float power = std::bit_cast<float>((int32_t(n) + 127) << 23);
    result.v[i] = x.v[i] < -87.0f ? 0.0f : series * power;
  }
  return result;
}

// 1 nm table lookup with linear interpolation; outside the range the end value holds.
using SpectralTable = std::array<float, kTableSize>;
inline float lookup(const SpectralTable &table, float nm) {
  const float x = clamp(nm - kTableFirst, 0.0f, float(kTableSize - 1));
  const int i = std::min(int(x), kTableSize - 2);
  return lerp(table[i], table[i + 1], x - float(i));
}

// The wavelengths of one path with everything that depends on them alone, looked up once.
struct Wavelengths {
  Spectrum nm;         // wavelengths
  Spectrum pdf;        // their probability density, 1/nm
  Spectrum basis[3];   // uplift basis for red, green, blue
  Spectrum d65;        // D65, scaled so that a reflectance of 1 under it has luminance 1
  Spectrum to_rgb[3];  // radiance -> linear Rec.709, with 1/(pdf * kWavelengths) folded in
};

// Reflectance-like: a linear Rec.709 colour as a spectrum. Linear in rgb, equal to 1 for white, in [0,1] for colours in [0,1].
inline Spectrum uplift(const Vec3 &rgb, const Wavelengths &w) {
  Spectrum s;
  for (int i = 0; i < kWavelengths; ++i) s.v[i] = rgb.x * w.basis[0].v[i] + rgb.y * w.basis[1].v[i] + rgb.z * w.basis[2].v[i];
  return s;
}
// Light-like: the same times D65.
inline Spectrum uplift_light(const Vec3 &rgb, const Wavelengths &w) { return uplift(rgb, w) * w.d65; }

inline Vec3 to_rgb(const Spectrum &radiance, const Wavelengths &w) {
  Vec3 rgb;
  for (int i = 0; i < kWavelengths; ++i) rgb += Vec3{w.to_rgb[0].v[i], w.to_rgb[1].v[i], w.to_rgb[2].v[i]} * radiance.v[i];
  return rgb;
}

// The same for one wavelength: `radiance` at `nm`, already divided by the probability of the wavelength.
struct ColourTables;

}  // namespace opal
