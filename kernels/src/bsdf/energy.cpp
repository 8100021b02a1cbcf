// SPDX-License-Identifier: GPL-3.0-or-later
#include "bsdf/energy.h"

#include "bsdf/microfacet.h"

namespace opal {
namespace {

#include "bsdf/ggx_albedo.inc"

// A coordinate in [0,1] on n nodes.
struct Node {
  int i;
  float t;
  Node(float x, int n) {
    const float s = saturate(x) * float(n - 1);
    i = std::min(int(s), n - 2);
    t = s - float(i);
  }
};
float interpolate(const float *table, const Node &x) { return lerp(table[x.i], table[x.i + 1], x.t); }
float interpolate(const float *table, int nx, const Node &x, const Node &y) {
  return lerp(interpolate(table + y.i * nx, x), interpolate(table + (y.i + 1) * nx, x), y.t);
}
float interpolate(const float *table, int nx, int ny, const Node &x, const Node &y, const Node &z) {
  const int slice = nx * ny;
  return lerp(interpolate(table + z.i * slice, nx, x, y), interpolate(table + (z.i + 1) * slice, nx, x, y), z.t);
}

// The tables' third coordinate: index = index_from_f0(z^4).
float index_coordinate(float eta) { return std::sqrt(std::abs((eta - 1) / (eta + 1))); }

}  // namespace

Albedo ggx_mirror_albedo(float roughness, float cosine) {
  const Node x(roughness, 32);
  return {interpolate(kGgxE, 32, x, Node(cosine, 32)), interpolate(kGgxEavg, x)};
}

Albedo ggx_glass_albedo(float roughness, float cosine, float eta) {
  const Node x(roughness, 16), y(cosine, 16), z(index_coordinate(eta), 16);
  const bool inside = eta < 1;
  return {interpolate(inside ? kGgxGlassInsideE : kGgxGlassE, 16, 16, x, y, z),
          interpolate(inside ? kGgxGlassInsideEavg : kGgxGlassEavg, 16, x, z)};
}

float ggx_gem_albedo(float roughness, float cosine, float eta) {
  return interpolate(eta < 1 ? kGgxGemInsideE : kGgxGlassE, 16, 16, Node(roughness, 16), Node(cosine, 16),
                     Node(index_coordinate(eta), 16));
}

float ggx_dielectric_position(float roughness, float cosine, float eta) {
  return interpolate(kGgxDielectricS, 16, 16, Node(roughness, 16), Node(cosine, 16), Node(index_coordinate(eta), 16));
}
float ggx_schlick_position(float roughness, float cosine) {
  return interpolate(kGgxSchlickS, 16, Node(roughness, 16), Node(cosine, 16));
}

float lobe_roughness(const Lobe &lobe) { return std::sqrt(std::sqrt(lobe.alpha_x * lobe.alpha_y)); }

LobeAlbedo lobe_albedo(const Lobe &lobe, const Vec3 &wo) {
  const Vec3 white{1, 1, 1};
  const float cosine = dot(lobe.normal, wo);
  const bool glass = lobe.kind == LobeKind::Glass;
  if (lobe.kind == LobeKind::Microfacet || glass) {
    const float roughness = lobe_roughness(lobe);
    Vec3 reflectance;
    bool known = true;
    switch (lobe.fresnel) {
      case FresnelKind::Generalized:
        reflectance = lerp(lobe.f0, lobe.f90, ggx_dielectric_position(roughness, cosine, lobe.eta));
        break;
      case FresnelKind::F82: reflectance = lerp(lobe.f0, white, ggx_schlick_position(roughness, cosine)); break;
      case FresnelKind::Dielectric:
        known = lobe.eta > 1;
        reflectance = white * lerp(f0_from_index(lobe.eta), 1.0f, ggx_dielectric_position(roughness, cosine, lobe.eta));
        break;
      default: known = false;
    }
    if (known) return {reflectance * lobe.reflection_tint, glass ? (white - reflectance) * lobe.transmission_tint : Vec3{}};
  }
  if (lobe.kind == LobeKind::Microfacet || glass || lobe.kind == LobeKind::Refraction) {
    // As if smooth.
    const FacetFresnel f = facet_fresnel(lobe, std::max(cosine, 0.0f));
    return {f.reflectance, f.transmittance};
  }
  if (lobe.kind == LobeKind::Translucent || lobe.kind == LobeKind::Transparent) return {{}, white};
  return {white, {}};
}

void preserve_energy(Lobe &lobe, const Vec3 &wo, const Vec3 &average_fresnel) {
  const float cosine = dot(lobe.normal, wo), roughness = lobe_roughness(lobe);
  const Albedo e =
      lobe.kind == LobeKind::Glass ? ggx_glass_albedo(roughness, cosine, lobe.eta) : ggx_mirror_albedo(roughness, cosine);
  if (!(e.directional > 1e-3f)) return;
  const float missing = (1 - e.directional) / e.directional;
  lobe.energy_scale = 1 + missing;
  // Further bounces meet the Fresnel term again: their share is a geometric series with ratio F (1 - E_avg).
  Vec3 darkening;
  for (int c = 0; c < 3; ++c) {
    const float f = saturate(average_fresnel[c]);  // colours above 1 are let through, not multiplied up
    const float several = f * e.average / (1 - f * (1 - e.average));
    darkening[c] = (1 + several * missing) / lobe.energy_scale;
  }
  lobe.weight *= darkening;
  lobe.sample_weight *= average(darkening);
}

Vec3 weight_below(const Vec3 &albedo, const Vec3 &weight) {
  float share = 0;
  for (int c = 0; c < 3; ++c)
    if (weight[c] != 0) share = std::max(share, albedo[c] / weight[c]);
  return weight * saturate(1 - share);
}

}  // namespace opal
