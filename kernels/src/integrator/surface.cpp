// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/surface.h"

#include "core/sampler.h"
#include "media/stratified.h"
#include "scene/contact.h"

namespace opal {
namespace {

// Interpolated normals turn light as no surface does that closes round a gem: in a coarse mesh some of what comes in is led
// into rounds of total reflections that have no end, and roulette ends it there, unseen. From so many events on the face's own
// normal serves at about every second one, in an order that does not repeat; that leads out of every such round.
constexpr uint32_t kInterpolated = 16;

bool by_own_normal(uint32_t depth) { return depth >= kInterpolated && (hash32(depth) & 1); }

}  // namespace

void make_surface(const Scene &scene, const Ray &ray, const Hit &hit, uint32_t ray_kind, uint32_t depth,
                  const InteriorStack &interior, const Wavelengths &w, Surface &out) {
  out.sp = scene.shading_point(ray, hit);
  out.sp.ray_kind = ray_kind;
  out.sp.depth = depth;
  out.material = scene.material_index(hit.instance, hit.triangle);
  const Material &material = scene.materials[out.material];
  out.is_gem = material.is_gem;
  out.caster = (material.flags & OPAL_MATERIAL_CASTER) != 0;
  out.nothing = false;
  ClosureSet &set = out.closures;
  set.count = 0;
  set.emission = {};
  set.holdout = 0;
  set.albedo = {};

  // An object that cuts the film has no surface for what the camera sees directly.
  if (depth == 0 && (ray_kind & OPAL_RAY_CAMERA) && scene.groups[out.sp.instance->group].holdout) {
    out.is_gem = out.has_smooth_lobe = out.transmissive = false;
    set.holdout = 1;
    return;
  }
  if (material.is_gem) {
    out.boundary = boundary_at(scene, interior, out.sp, out.material, w);
    out.nothing = !out.boundary.real;
    if (out.nothing) return;
    if (by_own_normal(depth)) out.sp.ns = out.sp.ng, out.sp.smooth = false;
    GemBoundary &gem = set.gem;
    gem.n_front = out.boundary.n_front;
    gem.n_behind = out.boundary.n_behind;
    gem.eta = gem.n_behind / gem.n_front;
    gem.alpha = sqr(material.gem.roughness);
    gem.schlick = material.gem.fresnel == OPAL_FRESNEL_SCHLICK;
    gem.dispersive = false;
    for (int i = 1; i < kWavelengths; ++i) gem.dispersive |= gem.eta[i] != gem.eta[0];
    if (Lobe *lobe = set.add(LobeKind::Gem, {1, 1, 1}, out.sp.ns)) {
      lobe->alpha_x = lobe->alpha_y = gem.alpha;
      lobe->eta = gem.eta[0];
    }
    set.albedo = {1, 1, 1};
  } else {
    run_surface(scene, material.surface, out.sp, set);
  }
  out.has_smooth_lobe = bsdf_has_smooth_lobe(set);
  out.transmissive = false;
  for (int i = 0; i < set.count; ++i) {
    const LobeKind kind = set.lobes[i].kind;
    out.transmissive |=
        kind == LobeKind::Translucent || kind == LobeKind::Glass || kind == LobeKind::Refraction || kind == LobeKind::Gem;
  }
}

SplitValue evaluate(const Surface &surface, const Vec3 &wi, const Wavelengths &w, Transport transport) {
  SplitValue value;
  value.rough = bsdf_eval(surface.closures, surface.sp, wi, w, transport, value.pdf);
  value.sharp = Spectrum(0.0f);
  if (!surface.caster) return value;
  const Spectrum rough = bsdf_eval_rough(surface.closures, surface.sp, wi, w, transport);
  for (int i = 0; i < kWavelengths; ++i) value.sharp[i] = std::max(0.0f, value.rough[i] - rough[i]);
  value.rough = rough;
  return value;
}

Spectrum rough_towards_camera(const Scene &scene, const Surface &surface, const Vec3 &viewer, float distance,
                              const Wavelengths &w) {
  if (surface.is_gem) return bsdf_eval_rough(surface.closures, surface.sp, viewer, w, Transport::Flux);
  ShadingPoint sp = surface.sp;
  const Vec3 light = sp.wo;
  if (scene.groups[sp.instance->group].holdout) return Spectrum(0.0f);
  if (dot(viewer, sp.ng) < 0) {
    sp.ng = -sp.ng;
    sp.ns = -sp.ns;
    sp.backfacing = !sp.backfacing;
  }
  sp.wo = viewer;
  sp.ray_kind = OPAL_RAY_CAMERA;
  sp.depth = 0;
  sp.ray_length = distance;
  ClosureSet set;
  run_surface(scene, scene.materials[surface.material].surface, sp, set);
  // f |cos light| with the shading normal; light is spread over, and seen from, the face itself (Veach 1997, 5.3).
  const float received = std::abs(dot(light, sp.ng));
  if (!(received > 1e-7f)) return Spectrum(0.0f);
  return bsdf_eval_rough(set, sp, light, w, Transport::Radiance) * (std::abs(dot(viewer, sp.ng)) / received);
}

EventClass classify(const Surface &surface, const BsdfSample &sample, const Wavelengths &w, Transport transport, float u) {
  if (!surface.caster) return EventClass::Rough;
  if (sample.scattering & kScatterSpecular) return EventClass::Sharp;
  const SplitValue value = evaluate(surface, sample.wi, w, transport);
  const float total = value.rough.sum() + value.sharp.sum();
  return u * total < value.sharp.sum() ? EventClass::Sharp : EventClass::Rough;
}

Passage passage(const Scene &scene, const Ray &ray, MediumSet entered, const InteriorStack &interior, int max_layers,
                const Wavelengths &w, RandomStream random) {
  Passage result;
  Ray rest = ray;
  const auto attenuate = [&](float distance) {
    if (entered.empty()) return;
    const MediumSet media = media_that_fill(scene, entered, interior);
    if (media.empty()) return;
    if (StratifiedMedia::holds(scene, media)) {
      const Spectrum through = StratifiedMedia(scene, media, w, rest).transmittance(distance);
      result.medium *= through, result.path_pdf *= through;
      return;
    }
    RayMedia varying(scene, media, w, rest);
    Walk walk;
    float depth = 0;
    pass_through(varying, distance, random, walk, depth);
    result.medium *= walk.throughput, result.path_pdf *= walk.path_pdf, result.light_pdf *= walk.light_pdf;
  };
  if (!scene.any_transparent_shadow) {  // nothing to look through, so no boundary of a medium either
    if (scene.occluded(ray, OPAL_RAY_SHADOW)) result.surfaces = {};
    else attenuate(ray.t_max);
    return result;
  }
  for (int layer = 0;;) {
    const Hit hit = next_hit(scene, rest, OPAL_RAY_SHADOW);
    if (escapes(scene, rest, hit)) entered.leave_bodies();
    attenuate(std::min(hit.t, rest.t_max));
    if (!hit.valid()) return result;
    const Material &material = scene.material_at(hit);
    ShadingPoint sp = scene.shading_point(rest, hit);
    sp.ray_kind = OPAL_RAY_SHADOW;
    if (!material.no_surface()) {
      if (layer++ >= max_layers || material.is_gem || !(material.flags & OPAL_MATERIAL_TRANSPARENT_SHADOW)) {
        result.surfaces = {};
        return result;
      }
      result.surfaces *= run_transparency(scene, material.surface, sp);
      if (result.blocked()) return result;
    }
    cross_medium(material, sp, entered);
    const float left = rest.t_max - hit.t;
    if (!(left > 0)) return result;
    rest = leave_surface(scene, rest, sp, rest.direction);
    rest.t_max = left;
  }
}

}  // namespace opal
