// SPDX-License-Identifier: GPL-3.0-or-later
// The questions of closure.h: sums over lobes, picking one, and light's two ways of travelling.
//
// Adjoints. A photon meets the BSDF of the reversed path. With lobes written as f(viewer <- light) that is
//   - for shading normals, the factor of flux_correction();
//   - for Glass and Refraction of node trees, which like Cycles' pass radiance without (n2/n1)^2: 1/eta^2. What they carry is
//     radiance over n^2 and flux over n^2; a photon inside such glass is "worth" 1/n^2 and regains it on leaving, so paths
//     and photons agree everywhere. Gem boundaries carry radiance and flux themselves (gem.h);
//   - bump_shadowing() looks at the side the light comes from, which is wo for photons.
// The view-dependent weights of layered materials (energy compensation, the share left under a coat) are those of wo.
#include "bsdf/diffuse.h"
#include "bsdf/energy.h"
#include "bsdf/gem.h"
#include "bsdf/microfacet.h"
#include "bsdf/shading_normal.h"
#include "bsdf/sheen.h"

namespace opal {
namespace {

bool is_gem(const ClosureSet &set) { return set.count == 1 && set.lobes[0].kind == LobeKind::Gem; }

bool is_dirac(const Lobe &lobe) {
  switch (lobe.kind) {
    case LobeKind::Transparent: return true;
    case LobeKind::Microfacet:
    case LobeKind::Glass: return is_mirror(lobe);
    case LobeKind::Refraction: return is_mirror(lobe) || transmits_straight(lobe);
    case LobeKind::Gem: return lobe.alpha_x < kSpecularAlpha;
    default: return false;
  }
}

bool is_diffuse(const Lobe &lobe) {
  return lobe.kind == LobeKind::Diffuse || lobe.kind == LobeKind::OrenNayar || lobe.kind == LobeKind::Translucent ||
         lobe.kind == LobeKind::Sheen;
}

// Wide enough to be left photons.
bool is_rough(const Lobe &lobe) { return is_diffuse(lobe) || lobe.alpha_x * lobe.alpha_y > sqr(kSharpAlpha); }

// What the reversed path adds to a lobe's f |cos wi|.
float adjoint(const Lobe &lobe, const ShadingPoint &sp, const Vec3 &wi, bool transmission) {
  const float scale =
      transmission && (lobe.kind == LobeKind::Glass || lobe.kind == LobeKind::Refraction) ? 1 / sqr(lobe.eta) : 1.0f;
  return scale * flux_correction(lobe.normal, sp.ng, sp.wo, wi);
}

// One smooth lobe, weight included.
LobeValue eval_lobe(const Lobe &lobe, const ShadingPoint &sp, const Vec3 &wi, Transport transport) {
  const float cos_i = dot(lobe.normal, wi);
  // A lobe that reflects in its own frame must not send light through the surface, and the reverse.
  if (cos_i * dot(sp.ng, wi) <= 0) return {};
  LobeValue value;
  switch (lobe.kind) {
    case LobeKind::Diffuse:
      if (cos_i > 0) value.pdf = cos_i * kInvPi, value.f = Vec3{value.pdf, value.pdf, value.pdf};
      break;
    case LobeKind::Translucent:
      if (cos_i < 0) value.pdf = -cos_i * kInvPi, value.f = Vec3{value.pdf, value.pdf, value.pdf};
      break;
    case LobeKind::OrenNayar:
      if (cos_i > 0) value.pdf = cos_i * kInvPi, value.f = eval_oren_nayar(lobe, sp.wo, wi, cos_i);
      break;
    case LobeKind::Sheen:
      value.pdf = sheen_density(lobe, sheen_frame(lobe, sp.wo).to_local(wi));
      value.f = Vec3{value.pdf, value.pdf, value.pdf};
      break;
    case LobeKind::Microfacet:
    case LobeKind::Glass:
    case LobeKind::Refraction: value = eval_microfacet(lobe, sp.wo, wi); break;
    default: return {};
  }
  if (!(value.pdf > 0)) return {};
  value.f *= lobe.weight;
  value.f *= bump_shadowing(lobe.normal, sp.ns, transport == Transport::Flux ? sp.wo : wi, is_diffuse(lobe));
  if (transport == Transport::Flux) value.f *= adjoint(lobe, sp, wi, cos_i < 0);
  return value;
}

float total_sample_weight(const ClosureSet &set) {
  float total = 0;
  for (int i = 0; i < set.count; ++i) total += set.lobes[i].sample_weight;
  return total;
}

// The lobe at lobe_u of the cumulative sample weights; lobe_u becomes a fresh number in [0,1).
const Lobe *pick_lobe(const ClosureSet &set, float total, float &lobe_u) {
  float x = lobe_u * total;
  const Lobe *last = nullptr;
  for (int i = 0; i < set.count; ++i) {
    const Lobe &lobe = set.lobes[i];
    if (!(lobe.sample_weight > 0)) continue;
    last = &lobe;
    if (x < lobe.sample_weight) {
      lobe_u = std::min(x / lobe.sample_weight, 0x1.fffffep-1f);
      return last;
    }
    x -= lobe.sample_weight;
  }
  lobe_u = 0x1.fffffep-1f;  // rounding ran past the end
  return last;
}

// Direction of a smooth lobe, or the whole of a Dirac one (then `weight` and `probability` are set).
struct LobeSample {
  Vec3 wi, weight;
  float probability = 1, eta = 1, roughness = 1;
  uint32_t scattering = kScatterReflect | kScatterDiffuse;
  bool dirac = false;
};

bool sample_lobe(const Lobe &lobe, const ShadingPoint &sp, float choice, Vec2 u, LobeSample &out) {
  switch (lobe.kind) {
    case LobeKind::Diffuse:
    case LobeKind::OrenNayar: out.wi = Frame::from_z(lobe.normal).to_world(sample_cosine(u)); return true;
    case LobeKind::Translucent:
      out.wi = Frame::from_z(-lobe.normal).to_world(sample_cosine(u));
      out.scattering = kScatterTransmit | kScatterDiffuse;
      return true;
    case LobeKind::Sheen: out.wi = sheen_frame(lobe, sp.wo).to_world(sample_sheen(lobe, u)); return true;
    case LobeKind::Transparent:
      out.wi = -sp.wo;
      out.weight = Vec3{1, 1, 1};
      out.dirac = true;
      out.roughness = 0;
      out.scattering = kScatterTransparent | kScatterTransmit | kScatterSpecular;
      return true;
    case LobeKind::Microfacet:
    case LobeKind::Glass:
    case LobeKind::Refraction: {
      FacetSample facet;
      if (!sample_microfacet(lobe, sp.wo, choice, u, facet)) return false;
      out.wi = normalize(facet.wi);
      out.weight = facet.weight;
      out.probability = facet.probability;
      out.dirac = facet.dirac;
      out.eta = facet.transmission ? lobe.eta : 1.0f;
      out.roughness = facet.dirac ? 0.0f : lobe_roughness(lobe);
      out.scattering =
          (facet.transmission ? kScatterTransmit : kScatterReflect) | (facet.dirac ? kScatterSpecular : kScatterGlossy);
      if ((dot(sp.ng, out.wi) < 0) != facet.transmission) return false;
      return true;
    }
    case LobeKind::Gem: break;
  }
  return false;
}

Spectrum eval_rgb(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, const Wavelengths &w, Transport transport,
                  float &pdf) {
  Vec3 f;
  float weighted = 0, total = 0;
  for (int i = 0; i < set.count; ++i) {
    const Lobe &lobe = set.lobes[i];
    total += lobe.sample_weight;
    if (is_dirac(lobe)) continue;
    const LobeValue value = eval_lobe(lobe, sp, wi, transport);
    f += value.f;
    weighted += value.pdf * lobe.sample_weight;
  }
  pdf = total > 0 ? weighted / total : 0.0f;
  return uplift(f, w);
}

// Lambert's lobe alone, the commonest surface: the cosine cancels and nothing needs to be evaluated again.
bool is_lambert(const ClosureSet &set) { return set.count == 1 && set.lobes[0].kind == LobeKind::Diffuse; }

bool sample_lambert(const Lobe &lobe, const ShadingPoint &sp, const Wavelengths &w, Transport transport, Vec2 u,
                    BsdfSample &out) {
  const Vec3 local = sample_cosine(u);
  out.wi = Frame::from_z(lobe.normal).to_world(local);
  if (!(local.z > 0 && dot(sp.ng, out.wi) > 0)) return false;
  float scale = bump_shadowing(lobe.normal, sp.ns, transport == Transport::Flux ? sp.wo : out.wi, true);
  if (transport == Transport::Flux) scale *= adjoint(lobe, sp, out.wi, false);
  if (!(scale > 0)) return false;
  out.weight = uplift(lobe.weight * scale, w);
  out.pdf = Spectrum(local.z * kInvPi);
  out.scattering = kScatterReflect | kScatterDiffuse;
  out.eta = out.roughness = 1;
  return true;
}

}  // namespace

Lobe *ClosureSet::add(LobeKind kind, const Vec3 &weight, const Vec3 &normal) {
  const float size = std::abs(average(weight));
  if (!(size >= 1e-5f) || !std::isfinite(size) || count >= kMaxLobes) return nullptr;
  Lobe &lobe = lobes[count++];
  lobe = Lobe{};
  lobe.kind = kind;
  lobe.weight = weight;
  lobe.sample_weight = size;
  lobe.normal = normal;
  return &lobe;
}

bool bsdf_sample(const ClosureSet &set, const ShadingPoint &sp, const Wavelengths &w, Transport transport, float lobe_u, Vec2 u,
                 BsdfSample &out) {
  if (is_gem(set)) return sample_gem(set, sp, transport, lobe_u, u, out);
  if (is_lambert(set)) return sample_lambert(set.lobes[0], sp, w, transport, u, out);
  const float total = total_sample_weight(set);
  if (!(total > 0)) return false;
  const Lobe *lobe = pick_lobe(set, total, lobe_u);
  LobeSample sample;
  if (!lobe || !sample_lobe(*lobe, sp, lobe_u, u, sample)) return false;
  out.wi = sample.wi;
  out.scattering = sample.scattering;
  out.eta = sample.eta;
  out.roughness = sample.roughness;
  if (sample.dirac) {
    const float p = lobe->sample_weight / total;
    Vec3 weight = lobe->weight * sample.weight * (1 / p);
    if (transport == Transport::Flux && lobe->kind != LobeKind::Transparent)
      weight *= adjoint(*lobe, sp, out.wi, (sample.scattering & kScatterTransmit) != 0);
    out.weight = uplift(weight, w);
    out.pdf = Spectrum(p * sample.probability);
  } else {
    float pdf;
    out.weight = eval_rgb(set, sp, out.wi, w, transport, pdf);
    if (!(pdf > 0)) return false;
    out.weight /= pdf;
    out.pdf = Spectrum(pdf);
  }
  return out.weight.is_finite() && !out.weight.is_zero();
}

Spectrum bsdf_eval(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, const Wavelengths &w, Transport transport,
                   Spectrum &pdf) {
  if (is_gem(set)) return eval_gem(set, sp, wi, transport, pdf);
  float p;
  const Spectrum value = eval_rgb(set, sp, wi, w, transport, p);
  pdf = Spectrum(p);
  return value;
}

bool bsdf_has_smooth_lobe(const ClosureSet &set) {
  for (int i = 0; i < set.count; ++i)
    if (!is_dirac(set.lobes[i])) return true;
  return false;
}

Spectrum bsdf_eval_rough(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, const Wavelengths &w,
                         Transport transport) {
  if (is_gem(set)) {
    Spectrum unused;
    return set.gem.alpha > kSharpAlpha ? eval_gem(set, sp, wi, transport, unused) : Spectrum(0.0f);
  }
  Vec3 f;
  for (int i = 0; i < set.count; ++i) {
    const Lobe &lobe = set.lobes[i];
    if (is_rough(lobe) && !is_dirac(lobe)) f += eval_lobe(lobe, sp, wi, transport).f;
  }
  return uplift(f, w);
}

Spectrum bsdf_eval_diffuse(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, const Wavelengths &w,
                           Transport transport) {
  Vec3 f;
  for (int i = 0; i < set.count; ++i)
    if (is_diffuse(set.lobes[i])) f += eval_lobe(set.lobes[i], sp, wi, transport).f;
  return uplift(f, w);
}

Spectrum bsdf_eval_diffuse_alone(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, const Wavelengths &w) {
  Vec3 f;
  for (int i = 0; i < set.count; ++i)
    if (is_diffuse(set.lobes[i])) f += eval_lobe(set.lobes[i], sp, wi, Transport::Radiance).f * set.lobes[i].bare;
  return uplift(f, w);
}

bool bsdf_is_only_diffuse(const ClosureSet &set) {
  for (int i = 0; i < set.count; ++i)
    if (!is_diffuse(set.lobes[i]) && set.lobes[i].kind != LobeKind::Transparent) return false;
  return true;
}

Vec3 bsdf_transparency(const ClosureSet &set) {
  Vec3 through;
  for (int i = 0; i < set.count; ++i)
    if (set.lobes[i].kind == LobeKind::Transparent) through += set.lobes[i].weight;
  return through;
}

}  // namespace opal
