// SPDX-License-Identifier: GPL-3.0-or-later
// Microfacet lobes of node trees: reflection (Microfacet), both (Glass) and transmission (Refraction), GGX.
//
// Transmission carries no (n2/n1)^2, as in Cycles: what crosses a Glass surface is radiance over n^2, so that a single
// sheet of glass does not dim what lies behind it. See bsdf.cpp for what that means for photons.
#pragma once

#include "bsdf/closure.h"
#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"

namespace opal {

// One lobe's f |cos wi| and the density of sampling wi by it.
struct LobeValue {
  Vec3 f;
  float pdf = 0;
};

// A lobe's Fresnel term at a facet, tints included.
struct FacetFresnel {
  Vec3 reflectance, transmittance;
  float cos_t = 0;  // cosine of the refracted ray

  float reflection_probability() const {
    const float r = average(reflectance), t = average(transmittance);
    return r > 0 ? r / (r + t) : 0.0f;
  }
  bool is_zero() const { return max_component(reflectance) <= 0 && max_component(transmittance) <= 0; }
};

inline FacetFresnel facet_fresnel(const Lobe &lobe, float cos_o) {
  FacetFresnel f;
  const Vec3 white{1, 1, 1};
  switch (lobe.fresnel) {
    case FresnelKind::None:
      f.reflectance = f.transmittance = white;
      if (lobe.kind == LobeKind::Refraction) {
        f.cos_t = refracted_cosine(cos_o, lobe.eta);
        if (f.cos_t <= 0) f.transmittance = {};
      }
      break;
    case FresnelKind::Dielectric: {
      const float r = fresnel_dielectric(cos_o, lobe.eta, f.cos_t);
      f.reflectance = lobe.reflection_tint * r;
      f.transmittance = lobe.transmission_tint * (1 - r);
      break;
    }
    case FresnelKind::Generalized: {
      float s;
      if (lobe.exponent < 0) {
        const float r0 = f0_from_index(lobe.eta), r = fresnel_dielectric(cos_o, lobe.eta, f.cos_t);
        s = saturate((r - r0) / (1 - r0));
      } else {
        f.cos_t = refracted_cosine(cos_o, lobe.eta);
        s = f.cos_t <= 0 ? 1.0f : std::pow(1 - (lobe.eta < 1 ? f.cos_t : cos_o), lobe.exponent);
      }
      const Vec3 r = lerp(lobe.f0, lobe.f90, s);
      f.reflectance = r * lobe.reflection_tint;
      f.transmittance = f.cos_t > 0 ? (white - r) * lobe.transmission_tint : Vec3{};
      break;
    }
    case FresnelKind::F82: f.reflectance = fresnel_f82(cos_o, lobe.f0, lobe.f90); break;
    case FresnelKind::Conductor: f.reflectance = fresnel_conductor(cos_o, lobe.f0, lobe.f90); break;
  }
  if (lobe.kind == LobeKind::Microfacet) f.transmittance = {};
  if (lobe.kind == LobeKind::Refraction) f.reflectance = {};
  return f;
}

inline bool is_mirror(const Lobe &lobe) { return std::max(lobe.alpha_x, lobe.alpha_y) < kSpecularAlpha; }
// An index this near 1 bends nothing that a half vector could be found from.
inline bool transmits_straight(const Lobe &lobe) { return std::abs(lobe.eta - 1) < 1e-4f; }
inline Frame facet_frame(const Lobe &lobe) {
  return lobe.alpha_x == lobe.alpha_y ? Frame::from_z(lobe.normal) : Frame::from_zx(lobe.normal, lobe.tangent);
}
inline Ggx facet_distribution(const Lobe &lobe) {
  return {std::max(lobe.alpha_x, kSpecularAlpha), std::max(lobe.alpha_y, kSpecularAlpha)};
}

// Not for mirrors. The weight is not included, the energy scale is.
inline LobeValue eval_microfacet(const Lobe &lobe, const Vec3 &wo, const Vec3 &wi) {
  const Frame frame = facet_frame(lobe);
  const Vec3 o = frame.to_local(wo), i = frame.to_local(wi);
  const bool transmission = i.z < 0;
  if (transmission ? lobe.kind == LobeKind::Microfacet || transmits_straight(lobe) : lobe.kind == LobeKind::Refraction)
    return {};
  const Ggx ggx = facet_distribution(lobe);
  const FacetTerms terms = transmission ? facet_refraction(ggx, o, i, lobe.eta) : facet_reflection(ggx, o, i);
  if (!(terms.pdf > 0)) return {};
  const FacetFresnel f = facet_fresnel(lobe, terms.cos_o);
  const float p = f.reflection_probability();
  return {(transmission ? f.transmittance : f.reflectance) * (terms.value * lobe.energy_scale),
          terms.pdf * (transmission ? 1 - p : p)};
}

// What sampling a microfacet lobe chose.
struct FacetSample {
  Vec3 wi;
  bool transmission = false, dirac = false;
  Vec3 weight;            // Dirac: f |cos| / probability
  float probability = 1;  // Dirac: of reflecting (or refracting)
};
// False when the lobe gives nothing to wo or the sample went to the wrong side. `choice` picks reflection or refraction.
inline bool sample_microfacet(const Lobe &lobe, const Vec3 &wo, float choice, Vec2 u, FacetSample &out) {
  const float cos_n = dot(lobe.normal, wo);
  if (!(cos_n > 0)) return false;
  out.dirac = is_mirror(lobe);
  Vec3 m = lobe.normal;
  if (!out.dirac) {
    const Frame frame = facet_frame(lobe);
    m = frame.to_world(facet_distribution(lobe).sample_visible(frame.to_local(wo), u));
  }
  const float cos_o = dot(m, wo);
  if (!(cos_o > 0)) return false;
  const FacetFresnel f = facet_fresnel(lobe, cos_o);
  if (f.is_zero()) return false;
  const float p = f.reflection_probability();
  out.transmission = choice >= p;
  out.dirac |= out.transmission && transmits_straight(lobe);
  out.wi = out.transmission ? refract(wo, m, lobe.eta, f.cos_t) : reflect(wo, m);
  out.probability = out.transmission ? 1 - p : p;
  out.weight = (out.transmission ? f.transmittance : f.reflectance) * (lobe.energy_scale / out.probability);
  return (dot(lobe.normal, out.wi) < 0) == out.transmission;
}

}  // namespace opal
