// SPDX-License-Identifier: GPL-3.0-or-later
// The Principled BSDF of Blender 4.5 and 5.2: sheen over coat over emission over a mix of metal, glass and a dielectric
// layer over diffuse.
//
// Every layer dims those below by its albedo towards the viewer (weight_below). Subsurface scattering is shaded as diffuse
// reflection of its weight and thin film is left out, of which the add-on's report tells.
#include "bsdf/energy.h"
#include "bsdf/fresnel.h"
#include "bsdf/lobe_setup.h"

namespace opal {
namespace {

constexpr float kCutoff = 1e-5f;
constexpr Vec3 kWhite{1, 1, 1};

struct Layers {
  ClosureSet &set;
  const ShadingPoint &sp;
  const PrincipledInputs &in;
  Vec3 weight;  // of what is still to come
  Vec3 normal, mirror, coat_normal;
  float shown = 1;  // what glossy layers so far let through

  void alpha() {
    const float alpha = saturate(in.alpha);
    if (alpha >= 1) return;
    add_transparent(set, weight, kWhite * (1 - alpha));
    weight *= alpha;
  }

  void sheen() {
    const float amount = std::max(in.sheen_weight, 0.0f);
    if (amount <= kCutoff) return;
    const Vec3 n = safe_normalize(lerp(normal, coat_normal, saturate(in.coat_weight)), normal);
    const Lobe *lobe = add_sheen_lobe(set, sp, max(in.sheen_tint, Vec3{}) * amount * weight, saturate(in.sheen_roughness), n);
    if (lobe) weight = weight_below(lobe->weight, weight);
  }

  void coat() {
    const float amount = std::max(in.coat_weight, 0.0f);
    if (amount <= kCutoff) return;
    const float ior = std::max(in.coat_ior, 1.0f);
    const Vec3 n = mirror_normal(coat_normal, sp);
    if (Lobe *lobe = set.add(LobeKind::Microfacet, weight * amount, n)) {
      lobe->alpha_x = lobe->alpha_y = sqr(saturate(in.coat_roughness));
      lobe->fresnel = FresnelKind::Dielectric;
      lobe->eta = ior;
      weigh_lobe(*lobe, sp.wo);
      preserve_energy(*lobe, sp.wo, kWhite * average_fresnel_dielectric(ior));
      dim_below(*lobe);
    }
    const Vec3 tint = max(in.coat_tint, Vec3{});
    if (tint == kWhite) return;
    // Beer's law along the refracted way through a coat of thickness 1.
    const float cos_t = std::max(refracted_cosine(dot(sp.wo, n), ior), 1e-4f);
    for (int c = 0; c < 3; ++c) weight[c] *= lerp(1.0f, std::pow(tint[c], 1 / cos_t), amount);
  }

  void emission() { add_emission(set, weight, in.emission_color, in.emission_strength); }

  void metal() {
    const float amount = saturate(in.metallic);
    if (amount <= kCutoff) return;
    if (Lobe *lobe = set.add(LobeKind::Microfacet, weight * amount, mirror)) {
      set_facets(*lobe);
      set_f82(*lobe, min(max(in.base_color, Vec3{}), kWhite), min(max(in.specular_tint, Vec3{}), kWhite), sp.wo,
              in.multiscatter);
      finish_lobe(set, *lobe, sp.wo);
    }
    weight *= 1 - amount;
  }

  void transmission() {
    const float amount = saturate(in.transmission_weight);
    if (amount <= kCutoff) return;
    if (Lobe *lobe = set.add(LobeKind::Glass, weight * amount, mirror)) {
      lobe->alpha_x = lobe->alpha_y = sqr(saturate(in.roughness));
      const Vec3 c = saturate(in.base_color);
      set_glass(*lobe, ior(), sp.backfacing, max(in.specular_tint, Vec3{}), kWhite,
                {std::sqrt(c.x), std::sqrt(c.y), std::sqrt(c.z)}, sp.wo, in.multiscatter);
      finish_lobe(set, *lobe, sp.wo);
    }
    weight *= 1 - amount;
  }

  void dielectric() {
    const float level = std::max(in.specular_ior_level, 0.0f);
    float eta = ior(), f0 = f0_from_index(eta);
    if (level != 0.5f) {
      f0 *= 2 * level;
      eta = ior() < 1 ? 1 / index_from_f0(f0) : index_from_f0(f0);
    }
    if (eta == 1) return;
    Lobe *lobe = set.add(LobeKind::Microfacet, weight, mirror);
    if (!lobe) return;
    set_facets(*lobe);
    lobe->eta = eta;
    lobe->fresnel = FresnelKind::Generalized;
    lobe->f0 = saturate(max(in.specular_tint, Vec3{}) * f0);
    weigh_lobe(*lobe, sp.wo);
    if (in.multiscatter) {
      const float r0 = f0_from_index(eta), s = saturate((average_fresnel_dielectric(eta) - r0) / (1 - r0));
      preserve_energy(*lobe, sp.wo, lerp(lobe->f0, kWhite, s));
    }
    dim_below(*lobe);
  }

  void diffuse() {
    const Vec3 color = max(in.base_color, Vec3{});
    const float subsurface = saturate(in.subsurface_weight), roughness = saturate(in.diffuse_roughness);
    const int before = set.count;
    add_diffuse_lobe(set, sp, saturate(color) * weight * subsurface, color, 0, normal);
    add_diffuse_lobe(set, sp, color * weight * (1 - subsurface), color, roughness, normal);
    for (int i = before; i < set.count; ++i) set.lobes[i].bare = 1 / std::max(shown, 1e-3f);
  }

  // What lies below a glossy lobe gets what the lobe does not reflect; all channels are dimmed alike.
  void dim_below(Lobe &lobe) {
    const Vec3 below = weight_below(finished(lobe), weight);
    if (average(weight) > 0) shown *= average(below) / average(weight);
    weight = below;
  }
  float ior() const { return std::max(in.ior, 1e-5f); }
  void set_facets(Lobe &lobe) const {
    set_anisotropy(lobe, saturate(in.roughness), saturate(in.anisotropic), in.anisotropic_rotation, normal, in.tangent);
  }
  // Enters the lobe into the guide and returns what it reflects to the viewer.
  Vec3 finished(Lobe &lobe) const {
    finish_lobe(set, lobe, sp.wo);
    return lobe.weight * lobe_albedo(lobe, sp.wo).reflected;
  }
};

}  // namespace

void add_principled(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const PrincipledInputs &in) {
  const Vec3 normal = shading_normal(in.normal, sp);
  Layers layers{set, sp, in, weight, normal, mirror_normal(normal, sp), shading_normal(in.coat_normal, sp), 1};
  layers.alpha();
  layers.sheen();
  layers.coat();
  layers.emission();
  layers.metal();
  layers.transmission();
  layers.dielectric();
  layers.diffuse();
}

}  // namespace opal
