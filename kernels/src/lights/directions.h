// SPDX-License-Identifier: GPL-3.0-or-later
// Uniform directions in cones, spheres and hemispheres, and points on discs, each with its solid angle or area.
//
// Angles of small sources are kept as 1 - cos, which keeps its digits where cos is 1 (the Sun: 1.1e-5).
#pragma once

#include "core/vec.h"

namespace opal {

inline constexpr float kFourPi = 4 * kPi;

// 1 - cos(theta) from sin^2(theta), theta at most 90 degrees.
inline float one_minus_cos_from_sin2(float sin2) {
  sin2 = saturate(sin2);
  return sin2 / (1 + safe_sqrt(1 - sin2));
}
// 1 - cos of an angle.
inline float one_minus_cos(float angle) { return 2 * sqr(std::sin(0.5f * angle)); }

// Uniform in the cone of `omc` = 1 - cos(half angle) round the axis; solid angle 2 pi omc.

inline Vec3 sample_cone(const Frame &frame, float omc, Vec2 u) {
  const float s = u.x * omc;  // 1 - cos(theta)
  const float sine = safe_sqrt(s * (2 - s)), phi = 2 * kPi * u.y;
  return frame.x * (sine * std::cos(phi)) + frame.y * (sine * std::sin(phi)) + frame.z * (1 - s);
}
inline float cone_solid_angle(float omc) { return 2 * kPi * omc; }
// Whether unit d lies within the cone round unit axis; exact for small cones.
inline bool in_cone(const Vec3 &d, const Vec3 &axis, float omc) {
  // |d - axis|^2 = 2 (1 - cos).
  return length_squared(d - axis) <= 2 * omc * (1 + 1e-6f) + 1e-14f;
}

inline Vec3 sample_sphere(Vec2 u) {
  const float z = 1 - 2 * u.x, r = safe_sqrt(1 - z * z), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// Concentric map (Shirley & Chiu 1997): uniform on the unit disc, stratification kept.
inline Vec2 sample_disc(Vec2 u) {
  const float x = 2 * u.x - 1, y = 2 * u.y - 1;
  if (x == 0 && y == 0) return {0, 0};
  const bool wide = std::abs(x) > std::abs(y);
  const float r = wide ? x : y;
  const float angle = wide ? kPi / 4 * (y / x) : kPi / 2 - kPi / 4 * (x / y);
  return {r * std::cos(angle), r * std::sin(angle)};
}

// Cosine-weighted about frame.z; pdf cos/pi.
inline Vec3 sample_cosine(const Frame &frame, Vec2 u) {
  const Vec2 d = sample_disc(u);
  return frame.to_world({d.x, d.y, safe_sqrt(1 - d.x * d.x - d.y * d.y)});
}

// Takes the choice made with probability p (u < p) or 1 - p out of u, leaving a fresh number in [0, 1).
inline float reuse_below(float u, float p) { return std::min(u / p, 0x1.fffffep-1f); }
inline float reuse_above(float u, float p) { return std::min((u - p) / (1 - p), 0x1.fffffep-1f); }

}  // namespace opal
