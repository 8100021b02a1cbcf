// SPDX-License-Identifier: GPL-3.0-or-later
// Fresnel terms: what part of the light a smooth boundary reflects. Pure functions.
//
// Convention: cos_i >= 0 is the cosine on the side the light (or the view) comes from, eta = index behind / index in
// front of the boundary as seen from that side. Unpolarised light unless said otherwise.
// Sources: PHYSICS section 2.4 (Born & Wolf 1.5.2); metals: Kutz, Hasan & Edmondson 2021, "Novel aspects of the Adobe
// Standard Material"; averages: Kulla & Conty 2017, "Revisiting Physically Based Shading at Imageworks".
#pragma once

#include "core/vec.h"

namespace opal {

// Cosine of the refracted ray, 0 at total internal reflection.
inline float refracted_cosine(float cos_i, float eta) { return safe_sqrt((eta - 1) * (eta + 1) + sqr(cos_i)) / eta; }

// Exact reflectance of a dielectric; cos_t receives the refracted cosine (0 and reflectance 1 beyond the critical angle).
inline float fresnel_dielectric(float cos_i, float eta, float &cos_t) {
  cos_t = refracted_cosine(cos_i, eta);
  if (cos_t <= 0) return 1;
  const float r_s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  const float r_p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  return 0.5f * (sqr(r_s) + sqr(r_p));
}
inline float fresnel_dielectric(float cos_i, float eta) {
  float cos_t;
  return fresnel_dielectric(cos_i, eta, cos_t);
}

// At normal incidence; the same from both sides.
constexpr float f0_from_index(float eta) { return sqr((eta - 1) / (eta + 1)); }
// Index of 1 or more with that reflectance at normal incidence.
inline float index_from_f0(float f0) {
  const float r = std::sqrt(clamp(f0, 0.0f, 0.99f));
  return (1 + r) / (1 - r);
}

constexpr float pow5(float x) { return sqr(sqr(x)) * x; }

// Schlick 1994 with the cosine on the low-index side: inside a dense body that is the refracted one.
inline float fresnel_schlick(float cos_i, float eta, float &cos_t) {
  cos_t = refracted_cosine(cos_i, eta);
  if (cos_t <= 0) return 1;
  const float f0 = f0_from_index(eta);
  return f0 + (1 - f0) * pow5(1 - (eta < 1 ? cos_t : cos_i));
}

// Average over 2 cos d(cos) of fresnel_dielectric: Kulla & Conty's fit.
constexpr float average_fresnel_dielectric(float eta) {
  return eta < 1 ? 0.997118f + eta * (0.1014f - eta * (0.965241f + eta * 0.130607f)) : (eta - 1) / (4.08567f + 1.00071f * eta);
}

// Metals after F82: Schlick's curve less dip * cos (1 - cos)^6, which bends it near 82 degrees (cos = 1/7).
inline Vec3 fresnel_f82(float cos_i, const Vec3 &f0, const Vec3 &dip) {
  const float s = saturate(1 - cos_i), s5 = pow5(s);
  const Vec3 f = lerp(f0, Vec3{1, 1, 1}, s5) - dip * (cos_i * s5 * s);
  return {saturate(f.x), saturate(f.y), saturate(f.z)};
}
// The dip that makes the reflectance at 82 degrees `tint` times Schlick's.
inline Vec3 f82_dip_from_tint(const Vec3 &f0, const Vec3 &tint) {
  constexpr float s = 6.0f / 7.0f;
  return lerp(f0, Vec3{1, 1, 1}, pow5(s)) * (Vec3{1, 1, 1} - tint) * (7 / (pow5(s) * s));
}
// The dip that makes it `f82`.
inline Vec3 f82_dip_from_value(const Vec3 &f0, const Vec3 &f82) {
  constexpr float s = 6.0f / 7.0f;
  return (lerp(f0, Vec3{1, 1, 1}, pow5(s)) - f82) * (7 / (pow5(s) * s));
}
// Average over 2 cos d(cos): 2 times the integral of cos (1-cos)^5 is 1/21, of cos^2 (1-cos)^6 is 1/126.
inline Vec3 average_fresnel_f82(const Vec3 &f0, const Vec3 &dip) {
  return lerp(f0, Vec3{1, 1, 1}, 1.0f / 21.0f) - dip * (1.0f / 126.0f);
}

// Exact reflectance of a metal of complex index n + ik against vacuum (Born & Wolf 14.4.1).
inline float fresnel_conductor(float cos_i, float n, float k) {
  const float sin2 = 1 - sqr(cos_i);
  const float t = sqr(n) - sqr(k) - sin2;
  const float a2b2 = std::sqrt(sqr(t) + 4 * sqr(n) * sqr(k));
  const float a = safe_sqrt(0.5f * (a2b2 + t));
  const float s = a2b2 + sqr(cos_i), p = 2 * a * cos_i;
  const float r_s = s + p > 0 ? (s - p) / (s + p) : 1;
  const float q = sqr(cos_i) * a2b2 + sqr(sin2), r = 2 * a * cos_i * sin2;
  const float r_p = q + r > 0 ? r_s * (q - r) / (q + r) : r_s;
  return std::max(0.0f, 0.5f * (r_s + r_p));  // rounding goes below 0 where the index is 1
}
inline Vec3 fresnel_conductor(float cos_i, const Vec3 &n, const Vec3 &k) {
  return {fresnel_conductor(cos_i, n.x, k.x), fresnel_conductor(cos_i, n.y, k.y), fresnel_conductor(cos_i, n.z, k.z)};
}

}  // namespace opal
