// SPDX-License-Identifier: GPL-3.0-or-later
// The GGX distribution of facets: density, masking, and sampling of the normals that a direction sees.
//
// Local frame: z is the surface normal, x the direction of alpha_x. All directions point away from the surface.
// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; Heitz 2014, "Understanding the
// Masking-Shadowing Function" (Smith's, height-correlated); Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with
// Spherical Caps".
#pragma once

#include "bsdf/turn.h"
#include "core/vec.h"

namespace opal {

struct Ggx {
  float alpha_x, alpha_y;

  // Facets per solid angle around m, projected: the integral of density(m) m.z over the hemisphere is 1.
  float density(const Vec3 &m) const {
    const float s = sqr(m.x / alpha_x) + sqr(m.y / alpha_y) + sqr(m.z);
    return kInvPi / (alpha_x * alpha_y * sqr(s));
  }
  // Smith's lambda of w; the part of facets seen from w is 1 / (1 + lambda).
  float lambda(const Vec3 &w) const {
    const float tan2 = (sqr(alpha_x * w.x) + sqr(alpha_y * w.y)) / sqr(w.z);
    return 0.5f * (std::sqrt(1 + tan2) - 1);
  }
  // A facet normal with density density(m) max(0, w.m) / (w.z (1 + lambda(w))), w above the surface.
  Vec3 sample_visible(const Vec3 &w, Vec2 u) const {
    const Vec3 v = normalize(Vec3{alpha_x * w.x, alpha_y * w.y, w.z});
    float sine, cosine;
    sine_cosine_of_turn(u.x, sine, cosine);
    const float z = (1 - u.y) * (1 + v.z) - v.z;
    const float r = safe_sqrt(1 - sqr(z));
    const Vec3 h = Vec3{r * cosine, r * sine, z} + v;
    return normalize(Vec3{alpha_x * h.x, alpha_y * h.y, std::max(h.z, 1e-12f)});
  }
};

// What a facet passes on from wi to wo without its Fresnel term: f |cos wi| and the density of sampling wi by a visible
// normal. `cos_o` is the cosine between wo and the facet.
struct FacetTerms {
  float value = 0, pdf = 0, cos_o = 0;
};

// Mirrored at facets; wo and wi above the surface.
inline FacetTerms facet_reflection(const Ggx &ggx, const Vec3 &wo, const Vec3 &wi) {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const Vec3 h = wo + wi;
  const float l = length(h);
  if (!(l > 0)) return {};
  const Vec3 m = h / l;
  const float common = ggx.density(m) / (4 * wo.z);
  const float lambda_o = ggx.lambda(wo);
  return {common / (1 + lambda_o + ggx.lambda(wi)), common / (1 + lambda_o), dot(m, wo)};
}

// Refracted at facets, wo above and wi below the surface, eta = index below / index above. `value` carries no (n2/n1)^2:
// over all wi it adds up to what is transmitted.
inline FacetTerms facet_refraction(const Ggx &ggx, const Vec3 &wo, const Vec3 &wi, float eta) {
  if (!(wo.z > 0 && wi.z < 0)) return {};
  Vec3 h = -(wo + wi * eta);
  if (eta < 1) h = -h;
  const float l2 = length_squared(h);
  if (!(l2 > 0)) return {};
  const Vec3 m = h / std::sqrt(l2);
  const float cos_o = dot(m, wo), cos_i = dot(m, wi);
  if (!(m.z > 0 && cos_o > 0 && cos_i < 0)) return {};
  const float common = ggx.density(m) * cos_o * -cos_i * sqr(eta) / (l2 * wo.z);
  const float lambda_o = ggx.lambda(wo);
  return {common / (1 + lambda_o + ggx.lambda(wi)), common / (1 + lambda_o), cos_o};
}

// w refracted at m; cos_t from the Fresnel term. w.m > 0.
inline Vec3 refract(const Vec3 &w, const Vec3 &m, float eta, float cos_t) { return m * (dot(w, m) / eta - cos_t) - w / eta; }

}  // namespace opal
