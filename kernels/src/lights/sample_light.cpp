// SPDX-License-Identifier: GPL-3.0-or-later
// The four questions of lights.h for receivers: choose a source and a direction, the probability of a direction that was
// found otherwise, lamps along a ray, and what rays that leave the scene see.
#include "lights/directions.h"
#include "lights/light_tables.h"
#include "lights/triangle_light.h"
#include "scene/scene.h"

namespace opal {
namespace {

// Irradiance of a far source, in the units of importance(LightBounds).
float far_importance(const LightTables &t, const SourceId &id, const Receiver &r) {
  if (id.kind == SourceKind::World) return kPi * t.world.brightness();
  const LampModel &sun = t.lamps[id.index];
  if (!lights_group(sun.receivers, r.light_group)) return 0;
  const float irradiance = std::abs(sun.intensity) * sun.brightness;
  if (length_squared(r.normal) == 0) return irradiance;
  float c = -dot(sun.axis, r.normal);
  if (r.transmissive) c = std::abs(c);
  return irradiance * std::max(c + std::sqrt(2 * sun.sun_omc), kSmallestCosine);
}

bool same(const SourceId &a, const SourceId &b) { return a.kind == b.kind && a.index == b.index; }

// Weighs the far sources, and the near ones while they are few (else the tree as one). Returns their number.
struct Weights {
  float values[2 * kFewLights];
  size_t count = 0;
  float total = 0;
  bool tree = false;  // the last value is the tree's
  LightTree::Cut cut;

  Weights(const LightTables &t, const Receiver &r) {
    // More than a handful of suns: the rest share the last place and are found by a second choice.
    for (const SourceId &id : t.far) {
      const float v = far_importance(t, id, r);
      if (count < kFewLights) values[count++] = v;
      else values[count - 1] += v;
      total += v;
    }
    tree = !t.tree.empty();
    if (tree) {
      t.tree.cut(r, cut);
      total += values[count++] = cut.total;
    } else {
      for (const LightBounds &b : t.near_bounds) total += values[count++] = importance(b, r);
    }
    if (t.far.size() <= kFewLights) share_out();
  }

 private:
  // What a source brings is an upper estimate: the strongest may be hidden by something. A part of the samples is shared
  // evenly among all that can bring anything, so that no source is left to rare and heavy samples.
  void share_out() {
    constexpr float kShared = 0.3f;
    size_t n = 0;
    for (size_t i = 0; i < count; ++i) n += values[i] > 0;
    if (n < 2 || !std::isfinite(total)) return;
    for (size_t i = 0; i < count; ++i)
      if (values[i] > 0) values[i] = (1 - kShared) * values[i] + kShared * total / float(n);
  }
};

size_t far_slots(const LightTables &t) { return std::min(t.far.size(), kFewLights); }

bool choose_source(const LightTables &t, const Receiver &r, float u, SourceId &id, float &probability) {
  if (t.far.size() + t.near.size() == 1) {
    id = t.far.empty() ? t.near[0] : t.far[0];
    probability = 1;
    return id.kind != SourceKind::Lamp || lights_group(t.lamps[id.index].receivers, r.light_group);
  }
  const Weights w(t, r);
  if (!(w.total > 0) || !std::isfinite(w.total)) return false;
  float x = u * w.total;
  size_t i = 0;
  while (i + 1 < w.count && x >= w.values[i]) x -= w.values[i++];
  while (i > 0 && !(w.values[i] > 0)) --i, x = 0;
  if (!(w.values[i] > 0)) return false;
  probability = w.values[i] / w.total;
  const float rest = clamp(x / w.values[i], 0.0f, 0x1.fffffep-1f);
  const size_t slots = far_slots(t);
  if (i < slots) {
    id = t.far[i];
    if (i + 1 < kFewLights || t.far.size() <= kFewLights) return true;
    float y = rest * w.values[i];
    for (size_t k = i; k < t.far.size(); ++k) {
      const float v = far_importance(t, t.far[k], r);
      if (v > 0) id = t.far[k], probability = v / w.total;
      if (y < v) break;
      y -= v;
    }
    return true;
  }
  if (!w.tree) {
    id = t.near[i - slots];
    return true;
  }
  uint32_t light = 0;
  float inner = 0;
  if (!t.tree.sample(w.cut, r, rest, light, inner)) return false;
  id = t.near[light];
  probability *= inner;
  return probability > 0;
}

float source_probability(const LightTables &t, const Receiver &r, const SourceId &id) {
  if (t.far.size() + t.near.size() == 1) return 1;
  const Weights w(t, r);
  if (!(w.total > 0) || !std::isfinite(w.total)) return 0;
  if (id.kind == SourceKind::World || (id.kind == SourceKind::Lamp && t.lamps[id.index].type == OPAL_LIGHT_SUN)) {
    for (size_t i = 0; i < t.far.size(); ++i)
      if (same(t.far[i], id)) return (t.far.size() <= kFewLights ? w.values[i] : far_importance(t, id, r)) / w.total;
    return 0;
  }
  const std::vector<uint32_t> &index = id.kind == SourceKind::Lamp ? t.near_of_lamp : t.near_of_triangle;
  const uint32_t near = id.index < index.size() ? index[id.index] : kNoSource;
  if (near == kNoSource) return 0;
  if (!w.tree) return w.values[far_slots(t) + near] / w.total;
  return w.values[w.count - 1] / w.total * t.tree.probability(w.cut, r, near);
}

bool sample_triangle_light(const Scene &scene, uint32_t index, const Vec3 &p, Vec2 u, const Wavelengths &w, float time,
                           LightSample &out) {
  const EmissiveTriangle e = scene.emissive_at(index, time);
  TriangleSample s;
  if (!sample_triangle(e.p0, e.p1, e.p2, e.area, p, u, s)) return false;
  const Vec3 rgb = triangle_emission(scene, e, p, s.wi, s.distance, s.b1, s.b2, time);
  out.wi = s.wi, out.distance = s.distance, out.pdf = s.pdf, out.dirac = false;
  out.radiance = uplift_light(rgb, w);
  out.cast_shadow = true;
  out.visibility = scene.groups[scene.instances[e.instance].group].visibility;
  return max_component(rgb) > 0;
}

}  // namespace

bool sample_light(const Scene &scene, const Vec3 &p, const Vec3 &normal, bool transmissive, int32_t light_group, float pick,
                  Vec2 u, const Wavelengths &w, float time, LightSample &out) {
  if (!scene.lights) return false;
  const LightTables &t = *scene.lights;
  if (t.far.empty() && t.near.empty()) return false;
  const Receiver r{p, normal, transmissive, light_group};
  float probability = 0;
  if (!choose_source(t, r, pick, out.source, probability)) return false;

  switch (out.source.kind) {
    case SourceKind::Lamp: {
      const LampModel &lamp = t.lamps[out.source.index];
      LampSample s;
      if (!sample_lamp(lamp, p, u, s)) return false;
      out.wi = s.wi, out.distance = s.distance, out.pdf = s.pdf, out.dirac = s.dirac;
      out.radiance = lamp_spectrum(t, lamp, w) * s.value;
      out.cast_shadow = lamp.cast_shadow;
      out.visibility = lamp.visibility;
      break;
    }
    case SourceKind::Triangle:
      if (!sample_triangle_light(scene, out.source.index, p, u, w, time, out)) return false;
      break;
    case SourceKind::World: {
      out.wi = t.world.sample(normal, transmissive, u, out.pdf);
      out.distance = kInfinity, out.dirac = false, out.cast_shadow = true;
      out.visibility = scene.world.visibility;
      if (!(out.pdf > 0)) return false;
      out.radiance = uplift_light(world_radiance(scene, out.wi, 0), w);
      break;
    }
    default: return false;
  }
  out.pdf *= probability;
  return out.pdf > 0 && !out.radiance.is_zero();
}

float light_pdf(const Scene &scene, const SourceId &source, const Vec3 &p, const Vec3 &normal, bool transmissive,
                int32_t light_group, const Vec3 &wi, float distance, const Vec3 &, const Vec3 &, float time) {
  if (!scene.lights) return 0;
  const LightTables &t = *scene.lights;
  float pdf = 0;
  switch (source.kind) {
    case SourceKind::Lamp: {
      const LampModel &lamp = t.lamps[source.index];
      if (!lamp.valid || !lights_group(lamp.receivers, light_group)) return 0;
      pdf = lamp_pdf(lamp, p, wi, distance);
      break;
    }
    case SourceKind::Triangle: {
      if (source.index >= scene.emissive.size()) return 0;
      const EmissiveTriangle e = scene.emissive_at(source.index, time);
      pdf = triangle_pdf(e.p0, e.p1, e.p2, e.area, p, wi, distance);
      break;
    }
    case SourceKind::World: pdf = t.world.present() ? t.world.pdf(normal, transmissive, wi) : 0.0f; break;
    default: return 0;
  }
  return pdf > 0 ? pdf * source_probability(t, {p, normal, transmissive, light_group}, source) : 0.0f;
}

bool lights_receiver(const Scene &scene, const SourceId &source, int32_t light_group) {
  return source.kind != SourceKind::Lamp || lights_group(scene.lamps[source.index].desc.receivers, light_group);
}

bool intersect_lamps(const Scene &scene, const Ray &ray, float t_after, float t_max, uint32_t ray_kind, const Wavelengths &w,
                     LampHit &out) {
  if (!scene.lights) return false;
  const LightTables &tables = *scene.lights;
  float best = std::min(t_max, ray.t_max), value = 0;
  const float start = std::max(t_after, ray.t_min);
  bool found = false;
  for (const uint32_t i : tables.sized) {
    const LampModel &lamp = tables.lamps[i];
    if (!visible_to(lamp.visibility, ray_kind)) continue;
    float t, radiance;
    Vec3 normal;
    if (!hit_lamp(lamp, ray, start, best, t, normal, radiance)) continue;
    best = t, value = radiance;
    out.t = t, out.lamp = i, out.normal = normal;
    found = true;
  }
  if (found) out.radiance = lamp_spectrum(tables, tables.lamps[out.lamp], w) * value;
  return found;
}

int escaped_radiance(const Scene &scene, const Vec3 &direction, uint32_t ray_kind, const Wavelengths &w, EscapedRadiance *out,
                     int capacity) {
  if (!scene.lights) return 0;
  const LightTables &tables = *scene.lights;
  int n = 0;
  for (const SourceId &id : tables.far) {
    if (id.kind != SourceKind::Lamp || n >= capacity) continue;
    const LampModel &sun = tables.lamps[id.index];
    if (!(sun.sun_omc > 0) || !visible_to(sun.visibility, ray_kind) || !in_cone(direction, -sun.axis, sun.sun_omc)) continue;
    out[n++] = {id, lamp_spectrum(tables, sun, w) * sun.radiance};
  }
  if (scene.world.present && n < capacity && visible_to(scene.world.visibility, ray_kind)) {
    const Vec3 rgb = world_radiance(scene, direction, ray_kind);
    if (max_component(rgb) > 0) out[n++] = {{SourceKind::World, 0}, uplift_light(rgb, w)};
  }
  return n;
}

}  // namespace opal
