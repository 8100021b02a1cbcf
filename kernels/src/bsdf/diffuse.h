// SPDX-License-Identifier: GPL-3.0-or-later
// Diffuse lobes: Lambert's, and Oren and Nayar's for rough surfaces.
//
// Oren-Nayar in Fujii's form (2012, "A tiny improvement of Oren-Nayar reflectance model"), with the light that is
// scattered several times put back after OpenPBR 1.1, as in Cycles from 4.3 on.
#pragma once

#include "bsdf/closure.h"
#include "bsdf/turn.h"

namespace opal {

// A direction with density cos / pi around z (concentric map of the disc, Shirley & Chiu 1997).
inline Vec3 sample_cosine(Vec2 u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0, 1};
  const bool wide = std::abs(a) > std::abs(b);
  const float r = wide ? a : b;
  float sine, cosine;
  sine_cosine_near_zero(0.5f * (wide ? b / a : a / b), sine, cosine);
  const float x = r * (wide ? cosine : sine), y = r * (wide ? sine : cosine);
  return {x, y, safe_sqrt(1 - r * r)};
}

// Directional albedo of the B term: pi B G(cos).
inline float oren_nayar_g(float cosine) {
  if (cosine < 1e-6f) return kPi / 2 - 2.0f / 3.0f - cosine;
  const float sine = safe_sqrt(1 - sqr(cosine)), theta = std::acos(std::min(cosine, 1.0f));
  return sine * (theta - 2.0f / 3.0f - sine * cosine) + 2.0f / 3.0f * (sine / cosine) * (1 - sqr(sine) * sine);
}

// Fills params and f0 for roughness in [0,1] and the colour that further bounces meet.
inline void set_oren_nayar(Lobe &lobe, const Vec3 &color, float roughness, const Vec3 &wo) {
  const float sigma = saturate(roughness);
  const float a = 1 / (kPi + sigma * (kPi / 2 - 2.0f / 3.0f)), b = sigma * a;
  lobe.params[0] = a;
  lobe.params[1] = b;
  const float average = a * kPi + (2 * kPi - 5.6f) / 3 * b;
  const float seen = a * kPi + b * oren_nayar_g(std::max(dot(lobe.normal, wo), 0.0f));
  for (int c = 0; c < 3; ++c) {
    const float albedo = saturate(color[c]);
    lobe.f0[c] = kInvPi * sqr(albedo) * (average / (1 - average)) / (1 - albedo * (1 - average)) * (1 - seen);
  }
}

// f |cos wi| without the weight; cos_i = normal . wi > 0.
inline Vec3 eval_oren_nayar(const Lobe &lobe, const Vec3 &wo, const Vec3 &wi, float cos_i) {
  const float a = lobe.params[0], b = lobe.params[1];
  const float cos_o = std::max(dot(lobe.normal, wo), 0.0f);
  float t = dot(wi, wo) - cos_i * cos_o;
  if (t > 0) t /= std::max(cos_i, cos_o);
  const float lost = 1 - (a * kPi + b * oren_nayar_g(cos_i));
  const float once = a + b * t;
  return (Vec3{once, once, once} + lobe.f0 * lost) * cos_i;
}

}  // namespace opal
