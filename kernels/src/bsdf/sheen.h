// SPDX-License-Identifier: GPL-3.0-or-later
// Sheen: light scattered by fibres that stand on a surface, as a linearly transformed cosine.
//
// Zeltner, Burley & Chiang 2022, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines". In the frame
// with z along the normal and the viewer in the xz plane (x > 0) the lobe is a clamped cosine under the inverse matrix
// [[a, 0, b], [0, a, 0], [0, 0, 1]], times an albedo; a, b and albedo depend on the viewer's cosine and the roughness.
#pragma once

#include "bsdf/closure.h"
#include "bsdf/diffuse.h"

namespace opal {

struct SheenParameters {
  float a = 1, b = 0, albedo = 0;
};
// roughness in [0,1] as in the socket; cosine of the viewer, below 0 (a bent normal) as 0.
SheenParameters sheen_parameters(float cosine, float roughness);

inline Frame sheen_frame(const Lobe &lobe, const Vec3 &wo) { return Frame::from_zx(lobe.normal, wo); }

// cos-weighted density of wi (in the sheen frame): value without albedo and pdf in one.
inline float sheen_density(const Lobe &lobe, const Vec3 &wi) {
  if (!(wi.z > 0)) return 0;
  const float a = lobe.params[0], b = lobe.params[1];
  const float length2 = sqr(a * wi.x + b * wi.z) + sqr(a * wi.y) + sqr(wi.z);
  return kInvPi * wi.z * sqr(a / length2);
}
inline Vec3 sample_sheen(const Lobe &lobe, Vec2 u) {
  const float a = lobe.params[0], b = lobe.params[1];
  const Vec3 c = sample_cosine(u);
  return normalize(Vec3{c.x - c.z * b, c.y, c.z * a});
}

}  // namespace opal
