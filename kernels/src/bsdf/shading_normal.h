// SPDX-License-Identifier: GPL-3.0-or-later
// What shading normals that differ from the surface's own need: normals that mirror into the open, soft terminators under
// bump maps, and the correction for light carried from lamps.
#pragma once

#include "bsdf/closure.h"

namespace opal {

// `n` turned towards ng just so far that the mirror direction of wo rises above the surface, by a sine of 0.01 or 0.9 of
// wo's own.
//
// In the plane of ng (z) and n (x) the turned normal (sin a, cos a) has to satisfy 2 (o.n') cos a - o_z = t, that is
// o_x sin 2a + o_z cos 2a = t; with q = o_x^2 + o_z^2 and c = cos^2 a this is 4q c^2 - 4(q + o_z t) c + (t + o_z)^2 = 0.
inline Vec3 reflecting_normal(const Vec3 &n, const Vec3 &ng, const Vec3 &wo) {
  const float o_z = dot(wo, ng);
  const float t = std::min(0.9f * o_z, 0.01f);
  if (dot(ng, reflect(wo, n)) >= t) return n;
  const Vec3 x = safe_normalize(n - ng * dot(n, ng), n);
  const float o_x = dot(wo, x);
  const float q = sqr(o_x) + sqr(o_z), half_b = q + o_z * t;
  if (!(q > 0)) return ng;
  const float root = safe_sqrt(sqr(half_b) - q * sqr(t + o_z));
  const float c = clamp((o_x < 0 ? half_b + root : half_b - root) / (2 * q), 0.0f, 1.0f);
  return normalize(x * std::sqrt(1 - c) + ng * std::sqrt(c));
}

// Conty Estevez, Lecocq & Stein 2019, "A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem": the
// factor for light from wi under a lobe whose normal a bump map turned away from ns. 0 where wi is on the other side of
// the unbumped surface than the lobe assumes.
inline float bump_shadowing(const Vec3 &normal, const Vec3 &ns, const Vec3 &wi, bool diffuse) {
  if (normal == ns) return 1;
  const float cos_i = dot(ns, wi), cos_n = dot(ns, normal);
  if (cos_i * cos_n * dot(normal, wi) < 0) return 0;
  if (!diffuse) return 1;
  const float i2 = sqr(cos_i), n2 = sqr(cos_n);
  if (n2 >= 1 || i2 >= 1) return 1;
  if (i2 < 1e-12f || n2 <= 0) return 0;
  const float alpha2 = saturate(0.125f * (1 / n2 - 1));
  return 2 / (1 + std::sqrt(1 + alpha2 * (1 / i2 - 1)));
}

// Veach 1997, section 5.3: light that goes from wo to wi (both pointing away) meets the adjoint of the BSDF whose
// f |cos wi| is written with the normal n. 0 where a cosine vanishes.
inline float flux_correction(const Vec3 &n, const Vec3 &ng, const Vec3 &wo, const Vec3 &wi) {
  if (n == ng) return 1;
  const float below = std::abs(dot(wo, ng) * dot(wi, n));
  return below > 1e-7f ? std::abs(dot(wo, n) * dot(wi, ng)) / below : 0.0f;
}

}  // namespace opal
