// SPDX-License-Identifier: GPL-3.0-or-later
#include "bsdf/gem.h"

#include "bsdf/energy.h"
#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/shading_normal.h"

namespace opal {
namespace {

float reflectance(const GemBoundary &gem, float cos_o, float eta, float &cos_t) {
  return gem.schlick ? fresnel_schlick(cos_o, eta, cos_t) : fresnel_dielectric(cos_o, eta, cos_t);
}

float transmission_scale(float eta, Transport transport) { return transport == Transport::Radiance ? 1 / sqr(eta) : 1.0f; }

// 1 / albedo of the ground boundary, so that a lossless gem loses nothing.
float energy_scale(const GemBoundary &gem, float cos_n, float eta) {
  return 1 / std::max(ggx_gem_albedo(std::sqrt(gem.alpha), cos_n, eta), 1e-3f);
}

bool on_side(const ShadingPoint &sp, const Vec3 &wi, bool transmission) {
  const float c = dot(sp.ng, wi);
  return transmission ? c < 0 : c > 0;
}

// The polished boundary with normal n. False where the direction ends on the wrong side of the surface.
bool sample_polished(const GemBoundary &gem, const ShadingPoint &sp, const Vec3 &n, Transport transport, float choice,
                     BsdfSample &out) {
  const float cos_o = dot(n, sp.wo);
  if (!(cos_o > 0)) return false;
  float cos_t;
  const float hero = reflectance(gem, cos_o, gem.eta[0], cos_t);
  const bool transmission = choice >= hero;
  out.wi = transmission ? normalize(refract(sp.wo, n, gem.eta[0], cos_t)) : reflect(sp.wo, n);
  if (!on_side(sp, out.wi, transmission)) return false;
  const float correction = transport == Transport::Flux ? flux_correction(n, sp.ng, sp.wo, out.wi) : 1.0f;
  out.scattering = kScatterSpecular | (transmission ? kScatterTransmit : kScatterReflect);
  out.eta = transmission ? gem.eta[0] : 1.0f;
  out.roughness = 0;
  if (transmission && gem.dispersive) {
    out.scattering |= kScatterDispersive;
    out.weight = out.pdf = Spectrum(0.0f);
    out.weight[0] = correction * transmission_scale(gem.eta[0], transport);
    out.pdf[0] = 1 - hero;
    return true;
  }
  const float p = transmission ? 1 - hero : hero;
  for (int i = 0; i < kWavelengths; ++i) {
    float unused;
    const float f = gem.dispersive ? reflectance(gem, cos_o, gem.eta[i], unused) : hero;
    out.pdf[i] = transmission ? 1 - f : f;
    out.weight[i] = out.pdf[i] / p * correction * (transmission ? transmission_scale(gem.eta[i], transport) : 1.0f);
  }
  return true;
}

}  // namespace

bool sample_gem(const ClosureSet &set, const ShadingPoint &sp, Transport transport, float choice, Vec2 u, BsdfSample &out) {
  const GemBoundary &gem = set.gem;
  const Vec3 &n = set.lobes[0].normal;
  if (gem.alpha < kSpecularAlpha)
    // Where an interpolated normal would send light through the face, the face's own serves: nothing is lost.
    return sample_polished(gem, sp, n, transport, choice, out) || sample_polished(gem, sp, sp.ng, transport, choice, out);

  const Frame frame = Frame::from_z(n);
  const Vec3 o = frame.to_local(sp.wo);
  if (!(o.z > 0)) return false;
  const Vec3 m = Ggx{gem.alpha, gem.alpha}.sample_visible(o, u);
  const float cos_o = dot(m, o);
  if (!(cos_o > 0)) return false;
  float cos_t;
  const float hero = reflectance(gem, cos_o, gem.eta[0], cos_t);
  const bool transmission = choice >= hero;
  const Vec3 i = transmission ? refract(o, m, gem.eta[0], cos_t) : reflect(o, m);
  if ((i.z < 0) != transmission) return false;
  out.wi = normalize(frame.to_world(i));
  const Spectrum value = eval_gem(set, sp, out.wi, transport, out.pdf);
  if (!(out.pdf[0] > 0)) return false;
  out.weight = value / out.pdf[0];
  out.scattering = kScatterGlossy | (transmission ? kScatterTransmit : kScatterReflect);
  if (transmission && gem.dispersive) out.scattering |= kScatterDispersive;
  out.eta = transmission ? gem.eta[0] : 1.0f;
  out.roughness = std::sqrt(gem.alpha);
  return out.weight.is_finite();
}

bool follow_polished(const GemBoundary &gem, int wavelength, const ShadingPoint &sp, bool transmission, Transport transport,
                     Vec3 &wi, float &share, float &correction) {
  const Vec3 &n = sp.ns;
  const float cos_o = dot(n, sp.wo), eta = gem.eta[wavelength];
  if (!(cos_o > 0)) return false;
  float cos_t;
  const float reflected = reflectance(gem, cos_o, eta, cos_t);
  const Vec3 back = reflect(sp.wo, n);
  if (!on_side(sp, back, false)) return false;
  wi = back;
  if (reflected < 1) {
    const Vec3 through = normalize(refract(sp.wo, n, eta, cos_t));
    if (!on_side(sp, through, true)) return false;
    if (transmission) wi = through;
  }
  share = transmission ? 1 - reflected : reflected;
  correction = transport == Transport::Flux ? flux_correction(n, sp.ng, sp.wo, wi) : 1.0f;
  return share > 0;
}

Spectrum eval_gem(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, Transport transport, Spectrum &pdf) {
  const GemBoundary &gem = set.gem;
  Spectrum value(0.0f);
  pdf = Spectrum(0.0f);
  if (gem.alpha < kSpecularAlpha) return value;
  const Frame frame = Frame::from_z(set.lobes[0].normal);
  const Vec3 o = frame.to_local(sp.wo), i = frame.to_local(wi);
  const bool transmission = i.z < 0;
  if (!(o.z > 0) || !on_side(sp, wi, transmission)) return value;
  const Ggx ggx{gem.alpha, gem.alpha};
  const float correction = transport == Transport::Flux ? flux_correction(frame.z, sp.ng, sp.wo, wi) : 1.0f;
  FacetTerms terms;
  float scale = 1;
  for (int k = 0; k < kWavelengths; ++k) {
    const float eta = gem.eta[k];
    if (k == 0 || gem.dispersive) {
      terms = transmission ? facet_refraction(ggx, o, i, eta) : facet_reflection(ggx, o, i);
      scale = correction * energy_scale(gem, o.z, eta);
    }
    float cos_t;
    const float f = reflectance(gem, terms.cos_o, eta, cos_t), share = transmission ? 1 - f : f;
    value[k] = terms.value * share * scale * (transmission ? transmission_scale(eta, transport) : 1.0f);
    pdf[k] = terms.pdf * share;
  }
  return value;
}

}  // namespace opal
