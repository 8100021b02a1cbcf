// SPDX-License-Identifier: GPL-3.0-or-later
// Photons from every kind of source.
//
// flux = emitted radiance x cosine / (probabilities), so that the mean over photons of the flux through any surface is the
// true flux. Round lamps are treated as all rays of one direction within their radius of the centre, which for spheres is
// exact: then the flux depends on the direction alone.
#include "lights/aim.h"
#include "lights/directions.h"
#include "lights/light_tables.h"
#include "scene/scene.h"

namespace opal {
namespace {

// What misses the scene is seen all the same where the world has a medium: lamps then shine all round.
const std::vector<EmissionTarget> kAllRound = {{{}, kInfinity}};

Emitter emitter_of(const LampModel &lamp) {
  if (lamp.type == OPAL_LIGHT_POINT) return {};
  if (lamp.type == OPAL_LIGHT_SPOT) return {Emitter::Kind::Everywhere, lamp.axis, lamp.cone_omc};
  Emitter e{Emitter::Kind::OneSided, lamp.axis, 2};
  if (lamp.has_spread) e.cone_omc = one_minus_cos(std::min(std::atan(lamp.tan_spread) * 1.0001f, 0.5f * kPi));
  return e;
}

Vec3 triangle_normal(const EmissiveTriangle &e) { return safe_normalize(cross(e.p1 - e.p0, e.p2 - e.p0), {0, 0, 1}); }

// Power that a lamp sends to the targets, roughly; never 0 where it sends any.
float lamp_reach(const LampModel &lamp, const std::vector<EmissionTarget> &targets) {
  if (lamp.type == OPAL_LIGHT_SUN) return std::abs(lamp.intensity) * ParallelAim(lamp.axis, targets).total();
  const Emitter emitter = emitter_of(lamp);
  if (lamp.parallel()) {  // its whole power, if the beam meets a target at all
    const float half = std::hypot(lamp.half_u, lamp.half_v);
    for (const EmissionTarget &target : targets) {
      const Vec3 to_target = target.centre - lamp.position;
      const float ahead = dot(to_target, lamp.axis);
      if (ahead + target.radius > 0 && length_squared(to_target - lamp.axis * ahead) < sqr(target.radius + half))
        return std::abs(lamp.intensity);
    }
    return 0;
  }
  if (lamp.is_round()) return std::abs(lamp.intensity) * DirectionAim(lamp.position, emitter, targets, lamp.radius).total();
  float sum = 0;
  for (int i = 0; i < 5; ++i) {
    const float x = i == 4 ? 0 : i & 1 ? 0.7f : -0.7f, y = i == 4 ? 0 : i & 2 ? 0.7f : -0.7f;
    const Vec3 at = lamp.position + lamp.u * (x * lamp.half_u) + lamp.v * (y * lamp.half_v);
    sum += DirectionAim(at, emitter, targets, 0).total() / 5;
  }
  // A narrow beam may reach a target from between those points.
  const float floor = lamp.has_spread ? 1e-2f * cone_solid_angle(emitter.cone_omc) : 0.0f;
  return std::abs(lamp.intensity) * (sum + floor);
}

struct Emission {
  Vec3 origin, direction, normal;
  float factor = 0;  // x the source's spectrum
  float reach = kInfinity;
};

// Who is inside of a lamp's sphere sees it shine from all round (sample_round). Photons of that light cross the sphere and end
// there: what lies beyond sees the side that faces it. A spot shines outwards only. This share of a lamp's photons is spent on
// it where media may be inside.
constexpr float kInwards = 1.0f / 16;

bool emit_inwards(const LampModel &lamp, Vec2 position, Vec2 direction, Emission &e) {
  e.direction = sample_sphere(direction);
  const Vec2 q = sample_disc(position);
  const Frame frame = Frame::from_z(e.direction);
  const float half = lamp.radius * safe_sqrt(1 - q.x * q.x - q.y * q.y);
  e.origin = lamp.position + (frame.x * q.x + frame.y * q.y) * lamp.radius - e.direction * half;
  e.reach = 2 * half;
  e.factor = lamp.radiance * kPi * sqr(lamp.radius) * kFourPi / kInwards;
  return e.factor != 0;
}

bool emit_round(const LampModel &lamp, const std::vector<EmissionTarget> &targets, Vec2 pick, Vec2 position, Vec2 direction,
                Emission &e) {
  const DirectionAim aim(lamp.position, emitter_of(lamp), targets, lamp.radius);
  float pdf;
  if (!aim.sample(pick.y, direction, e.direction, pdf)) return false;
  const Vec2 q = sample_disc(position);
  const Frame frame = Frame::from_z(e.direction);
  e.origin = lamp.position + (frame.x * q.x + frame.y * q.y) * lamp.radius;
  if (lamp.sphere) e.origin += e.direction * (lamp.radius * safe_sqrt(1 - q.x * q.x - q.y * q.y));
  e.factor = lamp.intensity * spot_attenuation(lamp, e.direction) / pdf;
  return e.factor != 0;
}

bool emit_area(const LampModel &lamp, const std::vector<EmissionTarget> &targets, Vec2 pick, Vec2 position, Vec2 direction,
               Emission &e) {
  const Vec2 q = lamp.ellipse ? sample_disc(position) : Vec2{2 * position.x - 1, 2 * position.y - 1};
  e.origin = lamp.position + lamp.u * (q.x * lamp.half_u) + lamp.v * (q.y * lamp.half_v);
  e.normal = lamp.axis;
  if (lamp.parallel()) {
    e.direction = lamp.axis;
    e.factor = lamp.radiance * kPi * lamp.area;
    return true;
  }
  const DirectionAim aim(e.origin, emitter_of(lamp), targets, 0);
  float pdf;
  if (!aim.sample(pick.y, direction, e.direction, pdf)) return false;
  const float cosine = dot(e.direction, lamp.axis);
  e.factor = lamp.radiance * spread_attenuation(lamp, cosine) * cosine * lamp.area / pdf;
  return cosine > 0 && e.factor != 0;
}

// Starts a ray of this direction through `point` outside of everything.
Vec3 start_outside(const Scene &scene, const Vec3 &point, const Vec3 &direction) {
  if (scene.bounds.empty()) return point - direction;
  const float back = dot(point - scene.bounds.centre(), direction) + 1.01f * scene.bounds.radius();
  return point - direction * std::max(back, 0.0f);
}

bool emit_parallel(const Scene &scene, const std::vector<EmissionTarget> &targets, Vec2 pick, Vec2 position, Emission &e) {
  const ParallelAim aim(e.direction, targets);
  Vec3 point;
  float pdf;
  if (!aim.sample(pick.y, position, point, pdf)) return false;
  e.origin = start_outside(scene, point, e.direction);
  e.factor /= pdf;
  return true;
}

bool emit_sun(const Scene &scene, const LampModel &sun, const std::vector<EmissionTarget> &targets, Vec2 pick, Vec2 position,
              Vec2 direction, Emission &e) {
  const bool disc = sun.sun_omc > 0;
  e.direction = disc ? normalize(sample_cone(Frame::from_z(sun.axis), sun.sun_omc, direction)) : sun.axis;
  e.factor = disc ? sun.radiance * cone_solid_angle(sun.sun_omc) : sun.intensity;
  return emit_parallel(scene, targets, pick, position, e);
}

bool emit_world(const Scene &scene, const WorldLight &world, const std::vector<EmissionTarget> &targets, Vec2 pick,
                Vec2 position, Vec2 direction, const Wavelengths &w, Emission &e, Spectrum &spectrum) {
  float pdf;
  const Vec3 towards = world.sample_emission(direction, pdf);
  if (!(pdf > 0)) return false;
  const Vec3 rgb = world_radiance(scene, towards, 0);
  if (!(max_component(rgb) > 0)) return false;
  spectrum = uplift_light(rgb, w);
  e.direction = -towards;
  e.factor = 1 / pdf;
  return emit_parallel(scene, targets, pick, position, e);
}

bool emit_triangle(const Scene &scene, const EmissiveTriangle &t, const std::vector<EmissionTarget> &targets, Vec2 pick,
                   Vec2 position, Vec2 direction, float time, const Wavelengths &w, Emission &e, Spectrum &spectrum) {
  float b1 = 0.5f * position.x, b2 = position.y - b1;  // Heitz 2019, as in triangle_light.cpp
  if (position.x >= position.y) b2 = 0.5f * position.y, b1 = position.x - b2;
  e.origin = t.p0 * (1 - b1 - b2) + t.p1 * b1 + t.p2 * b2;
  e.normal = triangle_normal(t);
  const DirectionAim aim(e.origin, {Emitter::Kind::TwoSided, e.normal, 2}, targets, 0);
  float pdf;
  if (!aim.sample(pick.y, direction, e.direction, pdf)) return false;
  float cosine = dot(e.direction, e.normal);
  if (cosine < 0) e.normal = -e.normal, cosine = -cosine;
  const float away = std::sqrt(t.area);
  const Vec3 rgb = triangle_emission(scene, t, e.origin + e.direction * away, -e.direction, away, b1, b2, time);
  if (!(max_component(rgb) > 0)) return false;
  spectrum = uplift_light(rgb, w);
  e.factor = cosine * t.area / pdf;
  return cosine > 0;
}

// The table for a set of targets that is not one of the scene's own: kept by the thread that asks.
const EmissionTable &other_table(const Scene &scene, const std::vector<EmissionTarget> &targets) {
  struct Kept {
    std::shared_ptr<LightTables> lights;
    EmissionTable table;
  };
  thread_local Kept kept;
  const auto equal = [](const EmissionTarget &a, const EmissionTarget &b) {
    return a.centre == b.centre && a.radius == b.radius;
  };
  if (kept.lights != scene.lights ||
      !std::equal(targets.begin(), targets.end(), kept.table.targets.begin(), kept.table.targets.end(), equal)) {
    kept.lights = scene.lights;
    kept.table.build(scene, *scene.lights, targets, true);
  }
  return kept.table;
}

}  // namespace

void EmissionTable::build(const Scene &scene, const LightTables &lights, std::vector<EmissionTarget> wanted,
                          bool caustics_only) {
  targets = std::move(wanted);
  sources.clear();
  cdf.clear();
  if (targets.empty()) return;
  std::vector<double> running{0};
  const auto add = [&](SourceId id, float power) {
    if (!(power > 0) || !std::isfinite(power)) return;
    sources.push_back(id);
    running.push_back(running.back() + double(power));
  };
  for (uint32_t i = 0; i < lights.lamps.size(); ++i) {
    const LampModel &lamp = lights.lamps[i];
    if (!lamp.valid || (caustics_only && !lamp.caustics)) continue;
    const bool all_round = !caustics_only && scene.world_medium >= 0 && lamp.type != OPAL_LIGHT_SUN;
    add({SourceKind::Lamp, i}, lamp.brightness * lamp_reach(lamp, all_round ? kAllRound : targets));
  }
  for (uint32_t i = 0; i < scene.emissive.size(); ++i) {
    if (i % 4096 == 0) scene.stop_if_cancelled();
    const EmissiveTriangle &t = scene.emissive[i];
    const Emitter emitter{Emitter::Kind::TwoSided, triangle_normal(t), 2};
    const float brightness = 0.5f * (luminance(t.emission) + average(t.emission));
    add({SourceKind::Triangle, i}, brightness * t.area * DirectionAim((t.p0 + t.p1 + t.p2) / 3, emitter, targets, 0).total());
  }
  if (lights.world.present() && (scene.world.caustics || !caustics_only))
    add({SourceKind::World, 0}, lights.world.brightness() * kFourPi * ParallelAim({0, 0, 1}, targets).total());
  if (sources.empty()) return;
  for (const double x : running) cdf.push_back(float(x / running.back()));
}

bool EmissionTable::choose(float &u, SourceId &source, float &probability) const {
  if (cdf.empty()) return false;
  const size_t i = std::min(size_t(std::upper_bound(cdf.begin(), cdf.end(), u) - cdf.begin()), sources.size()) - 1;
  probability = cdf[i + 1] - cdf[i];
  if (!(probability > 0)) return false;
  u = clamp((u - cdf[i]) / probability, 0.0f, 0x1.fffffep-1f);
  source = sources[i];
  return true;
}

bool emission_reaches(const EmissionSample &sample, const Vec3 &p) {
  if (!(sample.soft_radius > 0)) return true;
  const Vec3 to_centre = sample.centre - sample.ray.origin;
  const float miss2 = length_squared(to_centre - sample.ray.direction * dot(to_centre, sample.ray.direction));
  const float d2 = length_squared(p - sample.centre), r2 = sqr(sample.soft_radius);
  return miss2 * (d2 + r2) <= r2 * d2;
}

float emission_reaches_from(const EmissionSample &sample) {
  if (!(sample.soft_radius > 0)) return 0;
  const Vec3 to_centre = sample.centre - sample.ray.origin;
  const float foot = dot(to_centre, sample.ray.direction), r2 = sqr(sample.soft_radius);
  const float miss2 = length_squared(to_centre - sample.ray.direction * foot);
  if (!(miss2 < r2)) return kInfinity;
  return std::max(0.0f, foot + safe_sqrt(miss2 * r2 / (r2 - miss2) - miss2));
}

bool sample_emission(const Scene &scene, const std::vector<EmissionTarget> &targets, Vec2 pick, Vec2 position, Vec2 direction,
                     float time, const Wavelengths &w, EmissionSample &out) {
  if (!scene.lights) return false;
  const LightTables &lights = *scene.lights;
  const EmissionTable &table = targets.empty()              ? lights.to_scene
                               : &targets == &scene.casters ? lights.to_casters
                                                            : other_table(scene, targets);
  float probability = 0;
  if (!table.choose(pick.x, out.source, probability)) return false;
  Emission e;
  Spectrum spectrum;
  out.soft_radius = 0;
  out.from_infinity = out.source.kind == SourceKind::World;
  bool emitted = false;
  switch (out.source.kind) {
    case SourceKind::Lamp: {
      const LampModel &lamp = lights.lamps[out.source.index];
      const bool both_ways = lamp.type == OPAL_LIGHT_POINT && lamp.sphere && targets.empty() && scene.any_medium;
      const bool inwards = both_ways && pick.y < kInwards;
      if (both_ways && !inwards) pick.y = std::min((pick.y - kInwards) / (1 - kInwards), 0x1.fffffep-1f);
      const std::vector<EmissionTarget> &aims = targets.empty() && scene.world_medium >= 0 ? kAllRound : table.targets;
      emitted = inwards           ? emit_inwards(lamp, position, direction, e)
                : lamp.is_round() ? emit_round(lamp, aims, pick, position, direction, e)
                : lamp.is_area()  ? emit_area(lamp, aims, pick, position, direction, e)
                                  : emit_sun(scene, lamp, table.targets, pick, position, direction, e);
      if (both_ways && !inwards) e.factor /= 1 - kInwards;
      spectrum = lamp_spectrum(lights, lamp, w);
      out.from_infinity = lamp.type == OPAL_LIGHT_SUN;
      if (lamp.is_round() && !lamp.sphere) out.centre = lamp.position, out.soft_radius = lamp.radius;
      break;
    }
    case SourceKind::Triangle:
      emitted = emit_triangle(scene, scene.emissive_at(out.source.index, time), table.targets, pick, position, direction, time,
                              w, e, spectrum);
      break;
    case SourceKind::World:
      emitted = emit_world(scene, lights.world, table.targets, pick, position, direction, w, e, spectrum);
      break;
    default: break;
  }
  if (!emitted) return false;
  out.ray = {e.origin, e.direction, 0, kInfinity, time};
  out.normal = e.normal;
  out.reach = e.reach;
  out.flux = spectrum * (e.factor / probability);
  return out.flux.is_finite();
}

}  // namespace opal
