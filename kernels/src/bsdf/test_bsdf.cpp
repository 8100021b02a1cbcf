// SPDX-License-Identifier: GPL-3.0-or-later
// include/opal_test_bsdf.h: one node's closures for tests/kernels/test_bsdf.py.
#include "opal_test_bsdf.h"

#include "bsdf/lobes.h"

#include <cstring>

namespace opal {
namespace {

static_assert(OPAL_TEST_WAVELENGTHS == kWavelengths);

Vec3 vec3(const float *v) { return {v[0], v[1], v[2]}; }
void store(const Vec3 &v, float *out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }
void store(const Spectrum &s, float *out) { std::memcpy(out, s.v, sizeof s.v); }

struct Case {
  ShadingPoint sp;
  ClosureSet set;
  Wavelengths w{};
  Transport transport;

  explicit Case(const opal_test_bsdf &d) : transport(d.flux ? Transport::Flux : Transport::Radiance) {
    for (int i = 0; i < kWavelengths; ++i) w.basis[i % 3].v[i] = 1;
    sp.wo = vec3(d.wo);
    sp.ng = vec3(d.geometric_normal);
    sp.ns = vec3(d.shading_normal);
    sp.backfacing = d.backfacing != 0;
    add(d);
  }

  void add(const opal_test_bsdf &d) {
    const Vec3 white{1, 1, 1}, color = vec3(d.color), color_2 = vec3(d.color_2), normal = vec3(d.normal),
                               tangent = vec3(d.tangent);
    const bool multi = d.multiscatter != 0;
    switch (d.node) {
      case OPAL_TEST_DIFFUSE: return add_diffuse(set, sp, white, color, d.roughness, normal);
      case OPAL_TEST_TRANSLUCENT: return add_translucent(set, sp, white, color, normal);
      case OPAL_TEST_GLOSSY:
        return add_glossy(set, sp, white, color, d.roughness, d.anisotropy, d.rotation, normal, tangent, multi);
      case OPAL_TEST_GLASS: return add_glass(set, sp, white, color, d.roughness, d.ior, normal, multi);
      case OPAL_TEST_REFRACTION: return add_refraction(set, sp, white, color, d.roughness, d.ior, normal);
      case OPAL_TEST_TRANSPARENT: return add_transparent(set, white, color);
      case OPAL_TEST_SHEEN: return add_sheen(set, sp, white, color, d.roughness, normal);
      case OPAL_TEST_METAL_F82:
        return add_metallic_f82(set, sp, white, color, color_2, d.roughness, d.anisotropy, d.rotation, normal, tangent, multi);
      case OPAL_TEST_CONDUCTOR:
        return add_metallic_conductor(set, sp, white, color, color_2, d.roughness, d.anisotropy, d.rotation, normal, tangent,
                                      multi);
      case OPAL_TEST_PRINCIPLED: return principled(d);
      case OPAL_TEST_GEM: return gem(d);
    }
  }

  void principled(const opal_test_bsdf &d) {
    const float *p = d.principled;
    PrincipledInputs in;
    in.base_color = vec3(d.color), in.roughness = d.roughness, in.ior = d.ior;
    in.anisotropic = d.anisotropy, in.anisotropic_rotation = d.rotation;
    in.normal = vec3(d.normal), in.tangent = vec3(d.tangent), in.multiscatter = d.multiscatter != 0;
    in.metallic = p[0], in.alpha = p[1], in.diffuse_roughness = p[2], in.subsurface_weight = p[3], in.specular_ior_level = p[4];
    in.transmission_weight = p[5], in.coat_weight = p[6], in.coat_roughness = p[7], in.coat_ior = p[8];
    in.sheen_weight = p[9], in.sheen_roughness = p[10], in.emission_strength = p[11];
    in.specular_tint = vec3(p + 12), in.coat_tint = vec3(p + 15), in.sheen_tint = vec3(p + 18);
    add_principled(set, sp, {1, 1, 1}, in);
  }

  void gem(const opal_test_bsdf &d) {
    GemBoundary &g = set.gem;
    std::memcpy(g.eta.v, d.eta, sizeof g.eta.v);
    g.n_front = Spectrum(1.0f);
    g.n_behind = g.eta;
    g.alpha = sqr(d.roughness);
    g.schlick = d.schlick != 0;
    g.dispersive = false;
    for (int i = 1; i < kWavelengths; ++i) g.dispersive |= g.eta[i] != g.eta[0];
    if (Lobe *lobe = set.add(LobeKind::Gem, {1, 1, 1}, sp.ns)) lobe->alpha_x = lobe->alpha_y = g.alpha;
  }
};

}  // namespace
}  // namespace opal

extern "C" {

void opal_test_bsdf_eval(const opal_test_bsdf *bsdf, int32_t n, const float *wi, int32_t rough_only, float *value, float *pdf) {
  const opal::Case c(*bsdf);
  for (int i = 0; i < n; ++i) {
    const opal::Vec3 direction = opal::vec3(wi + 3 * i);
    opal::Spectrum p(0.0f);
    opal::Spectrum v = opal::bsdf_eval(c.set, c.sp, direction, c.w, c.transport, p);
    if (rough_only) v = opal::bsdf_eval_rough(c.set, c.sp, direction, c.w, c.transport);
    opal::store(v, value + OPAL_TEST_WAVELENGTHS * i);
    opal::store(p, pdf + OPAL_TEST_WAVELENGTHS * i);
  }
}

void opal_test_bsdf_sample(const opal_test_bsdf *bsdf, int32_t n, const float *u, float *wi, float *weight, float *pdf,
                           uint32_t *scattering, float *eta) {
  const opal::Case c(*bsdf);
  for (int i = 0; i < n; ++i) {
    opal::BsdfSample s;
    s.wi = {};
    s.weight = s.pdf = opal::Spectrum(0.0f);
    const bool ok = opal::bsdf_sample(c.set, c.sp, c.w, c.transport, u[3 * i], {u[3 * i + 1], u[3 * i + 2]}, s);
    if (!ok) s.weight = s.pdf = opal::Spectrum(0.0f);
    opal::store(s.wi, wi + 3 * i);
    opal::store(s.weight, weight + OPAL_TEST_WAVELENGTHS * i);
    opal::store(s.pdf, pdf + OPAL_TEST_WAVELENGTHS * i);
    scattering[i] = ok ? s.scattering : 0u;
    eta[i] = s.eta;
  }
}

int32_t opal_test_bsdf_summary(const opal_test_bsdf *bsdf, float *summary) {
  const opal::Case c(*bsdf);
  opal::store(c.set.emission, summary);
  opal::store(opal::bsdf_transparency(c.set), summary + 3);
  opal::store(c.set.albedo, summary + 6);
  summary[9] = 0;
  for (int i = 0; i < c.set.count; ++i) summary[9] += c.set.lobes[i].sample_weight;
  return c.set.count;
}
}
