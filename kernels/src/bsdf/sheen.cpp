// SPDX-License-Identifier: GPL-3.0-or-later
#include "bsdf/sheen.h"

namespace opal {
namespace {

#include "bsdf/sheen_fit.inc"

constexpr float kFirstRoughness = 1.0f / 31;

template <int n>
void chebyshev(float x, float (&t)[n]) {
  t[0] = 1;
  t[1] = x;
  for (int i = 2; i < n; ++i) t[i] = 2 * x * t[i - 1] - t[i - 2];
}

struct Point {
  float cosine[kSheenCosTerms], rough[kSheenRoughTerms];

  float sum(const float *c) const {
    float s = 0;
    for (int i = 0; i < kSheenCosTerms; ++i)
      for (int j = 0; j < kSheenRoughTerms; ++j) s += c[i * kSheenRoughTerms + j] * cosine[i] * rough[j];
    return s;
  }
};

}  // namespace

SheenParameters sheen_parameters(float cosine, float roughness) {
  const float low = std::sqrt(kFirstRoughness);
  Point p;
  chebyshev(2 * std::sqrt(saturate(cosine)) - 1, p.cosine);
  chebyshev(2 * (std::sqrt(clamp(roughness, kFirstRoughness, 1.0f)) - low) / (1 - low) - 1, p.rough);
  SheenParameters out;
  out.a = std::max(p.sum(kSheenA), 1e-3f);
  out.b = p.sum(kSheenB);
  // Below the first row the albedo goes to 0 with the roughness.
  out.albedo = saturate(std::exp(p.sum(kSheenLogAlbedo)) * std::min(1.0f, roughness / kFirstRoughness));
  return out;
}

}  // namespace opal
