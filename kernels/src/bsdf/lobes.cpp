// SPDX-License-Identifier: GPL-3.0-or-later
#include "bsdf/lobes.h"

#include "bsdf/diffuse.h"
#include "bsdf/energy.h"
#include "bsdf/fresnel.h"
#include "bsdf/lobe_setup.h"
#include "bsdf/sheen.h"

namespace opal {

// ---- Shared by the nodes ----

Vec3 shading_normal(const Vec3 &normal, const ShadingPoint &sp) { return safe_normalize(normal, sp.ns); }

Vec3 mirror_normal(const Vec3 &normal, const ShadingPoint &sp) {
  return normal == sp.ng ? normal : reflecting_normal(normal, sp.ng, sp.wo);
}

Vec3 rotated_tangent(const Vec3 &tangent, const Vec3 &axis, float turns) {
  if (turns == 0) return tangent;
  const float angle = turns * 2 * kPi, c = std::cos(angle), s = std::sin(angle);
  return tangent * c + cross(axis, tangent) * s + axis * (dot(axis, tangent) * (1 - c));
}

void finish_lobe(ClosureSet &set, Lobe &lobe, const Vec3 &wo) {
  const LobeAlbedo albedo = lobe_albedo(lobe, wo);
  set.albedo += lobe.weight * (albedo.reflected + albedo.transmitted);
}

void weigh_lobe(Lobe &lobe, const Vec3 &wo) {
  const LobeAlbedo albedo = lobe_albedo(lobe, wo);
  lobe.sample_weight *= average(albedo.reflected + albedo.transmitted);
}

void add_diffuse_lobe(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness,
                      const Vec3 &normal) {
  const bool rough = roughness >= 1e-5f;
  Lobe *lobe = set.add(rough ? LobeKind::OrenNayar : LobeKind::Diffuse, weight, normal);
  if (!lobe) return;
  if (rough) set_oren_nayar(*lobe, color, roughness, sp.wo);
  finish_lobe(set, *lobe, sp.wo);
}

Lobe *add_sheen_lobe(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, float roughness, const Vec3 &normal) {
  const SheenParameters p = sheen_parameters(dot(normal, sp.wo), roughness);
  Lobe *lobe = set.add(LobeKind::Sheen, weight * p.albedo, normal);
  if (!lobe) return nullptr;
  lobe->params[0] = p.a;
  lobe->params[1] = p.b;
  finish_lobe(set, *lobe, sp.wo);
  return lobe;
}

// ---- One node each ----

void add_diffuse(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness,
                 const Vec3 &normal) {
  add_diffuse_lobe(set, sp, weight * color, color, roughness, shading_normal(normal, sp));
}

void add_translucent(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, const Vec3 &normal) {
  Lobe *lobe = set.add(LobeKind::Translucent, weight * color, mirror_normal(shading_normal(normal, sp), sp));
  if (lobe) finish_lobe(set, *lobe, sp.wo);
}

void add_glossy(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness,
                float anisotropy, float rotation, const Vec3 &normal, const Vec3 &tangent, bool multiscatter) {
  const Vec3 c = max(color, Vec3{});
  Lobe *lobe = set.add(LobeKind::Microfacet, weight * c, mirror_normal(shading_normal(normal, sp), sp));
  if (!lobe) return;
  lobe->alpha_x = lobe->alpha_y = sqr(saturate(roughness));
  const float a = clamp(anisotropy, -0.99f, 0.99f);
  if (std::abs(a) > 1e-4f && length_squared(tangent) > 0) {
    lobe->tangent = rotated_tangent(tangent, lobe->normal, rotation);
    const float stretch = a < 0 ? 1 / (1 + a) : 1 - a;
    lobe->alpha_x = saturate(lobe->alpha_x * stretch);
    lobe->alpha_y = saturate(lobe->alpha_y / stretch);
  }
  if (multiscatter) preserve_energy(*lobe, sp.wo, c);
  finish_lobe(set, *lobe, sp.wo);
}

namespace {

// The Metallic BSDF up to its Fresnel term.
Lobe *add_metallic(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, float roughness, float anisotropy,
                   float rotation, const Vec3 &normal, const Vec3 &tangent) {
  const Vec3 n = shading_normal(normal, sp);
  Lobe *lobe = set.add(LobeKind::Microfacet, weight, mirror_normal(n, sp));
  if (lobe) set_anisotropy(*lobe, saturate(roughness), saturate(anisotropy), rotation, n, tangent);
  return lobe;
}

}  // namespace

void set_anisotropy(Lobe &lobe, float roughness, float anisotropy, float rotation, const Vec3 &normal, const Vec3 &tangent) {
  lobe.alpha_x = lobe.alpha_y = sqr(roughness);
  if (!(anisotropy > 0 && length_squared(tangent) > 0)) return;
  const float aspect = std::sqrt(1 - 0.9f * anisotropy);
  lobe.alpha_x = saturate(lobe.alpha_x / aspect);
  lobe.alpha_y = saturate(lobe.alpha_y * aspect);
  lobe.tangent = rotated_tangent(tangent, normal, rotation);
}

void set_f82(Lobe &lobe, const Vec3 &f0, const Vec3 &tint, const Vec3 &wo, bool multiscatter) {
  lobe.fresnel = FresnelKind::F82;
  lobe.f0 = f0;
  lobe.f90 = tint == Vec3{1, 1, 1} ? Vec3{} : f82_dip_from_tint(f0, tint);
  weigh_lobe(lobe, wo);
  if (multiscatter) preserve_energy(lobe, wo, average_fresnel_f82(lobe.f0, lobe.f90));
}

void add_metallic_f82(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &base_color,
                      const Vec3 &edge_tint, float roughness, float anisotropy, float rotation, const Vec3 &normal,
                      const Vec3 &tangent, bool multiscatter) {
  Lobe *lobe = add_metallic(set, sp, weight, roughness, anisotropy, rotation, normal, tangent);
  if (!lobe) return;
  set_f82(*lobe, saturate(base_color), saturate(edge_tint), sp.wo, multiscatter);
  finish_lobe(set, *lobe, sp.wo);
}

void add_metallic_conductor(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &n, const Vec3 &k,
                            float roughness, float anisotropy, float rotation, const Vec3 &normal, const Vec3 &tangent,
                            bool multiscatter) {
  Lobe *lobe = add_metallic(set, sp, weight, roughness, anisotropy, rotation, normal, tangent);
  if (!lobe) return;
  lobe->fresnel = FresnelKind::Conductor;
  lobe->f0 = max(n, Vec3{});
  lobe->f90 = max(k, Vec3{});
  weigh_lobe(*lobe, sp.wo);
  if (multiscatter) {
    // Its average from the F82 curve through the values at 0 and 82 degrees.
    const Vec3 f0 = fresnel_conductor(1, lobe->f0, lobe->f90), f82 = fresnel_conductor(1.0f / 7, lobe->f0, lobe->f90);
    preserve_energy(*lobe, sp.wo, saturate(average_fresnel_f82(f0, f82_dip_from_value(f0, f82))));
  }
  finish_lobe(set, *lobe, sp.wo);
}

void set_glass(Lobe &lobe, float ior, bool backfacing, const Vec3 &f0_tint, const Vec3 &reflection_tint,
               const Vec3 &transmission_tint, const Vec3 &wo, bool multiscatter) {
  lobe.eta = backfacing ? 1 / ior : ior;
  lobe.fresnel = FresnelKind::Generalized;
  lobe.f0 = saturate(f0_tint * f0_from_index(ior));
  lobe.reflection_tint = reflection_tint;
  lobe.transmission_tint = transmission_tint;
  weigh_lobe(lobe, wo);
  if (multiscatter) preserve_energy(lobe, wo, transmission_tint);
}

void add_glass(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness, float ior,
               const Vec3 &normal, bool multiscatter) {
  const Vec3 c = max(color, Vec3{});
  if (max_component(c) <= 0) return;
  Lobe *lobe = set.add(LobeKind::Glass, weight, mirror_normal(shading_normal(normal, sp), sp));
  if (!lobe) return;
  lobe->alpha_x = lobe->alpha_y = sqr(saturate(roughness));
  set_glass(*lobe, std::max(ior, 1e-5f), sp.backfacing, {1, 1, 1}, c, c, sp.wo, multiscatter);
  finish_lobe(set, *lobe, sp.wo);
}

void add_refraction(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness, float ior,
                    const Vec3 &normal) {
  Lobe *lobe = set.add(LobeKind::Refraction, weight * color, mirror_normal(shading_normal(normal, sp), sp));
  if (!lobe) return;
  lobe->alpha_x = lobe->alpha_y = sqr(saturate(roughness));
  lobe->eta = sp.backfacing ? 1 / std::max(ior, 1e-5f) : std::max(ior, 1e-5f);
  finish_lobe(set, *lobe, sp.wo);
}

void add_transparent(ClosureSet &set, const Vec3 &weight, const Vec3 &color) {
  const Vec3 w = weight * color;
  for (int i = 0; i < set.count; ++i) {
    Lobe &lobe = set.lobes[i];
    if (lobe.kind != LobeKind::Transparent) continue;
    lobe.weight += w;
    lobe.sample_weight += std::abs(average(w));
    return;
  }
  set.add(LobeKind::Transparent, w, {0, 0, 1});
}

void add_sheen(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness,
               const Vec3 &normal) {
  add_sheen_lobe(set, sp, weight * color, saturate(roughness), shading_normal(normal, sp));
}

void add_emission(ClosureSet &set, const Vec3 &weight, const Vec3 &color, float strength) {
  const Vec3 radiance = weight * color * strength;
  if (is_finite(radiance)) set.emission += radiance;
}

void add_holdout(ClosureSet &set, const Vec3 &weight) { set.holdout += average(weight); }

}  // namespace opal
