// SPDX-License-Identifier: GPL-3.0-or-later
// Building the tables; bounds of every kind of source for the light tree.
#include "lights/light_tables.h"

#include "lights/directions.h"
#include "scene/scene.h"

#include <algorithm>

namespace opal {
namespace {

// What smooth spectra get where no lamp, world or face has one: enough that nothing is left without samples.
constexpr float kLeastSmoothShare = 0.03f;

Bounds lamp_box(const LampModel &lamp) {
  Bounds box;
  if (lamp.is_round()) {
    const Vec3 r{lamp.radius, lamp.radius, lamp.radius};
    box.extend(lamp.position - r), box.extend(lamp.position + r);
  } else {
    for (int i = 0; i < 4; ++i)
      box.extend(lamp.position + lamp.u * (i & 1 ? lamp.half_u : -lamp.half_u) + lamp.v * (i & 2 ? lamp.half_v : -lamp.half_v));
  }
  return box;
}

LightBounds bounds_of(const LampModel &lamp) {
  LightBounds b;
  b.box = lamp_box(lamp);
  b.axis = lamp.axis;
  b.power = std::abs(lamp.intensity) * lamp.brightness;
  b.receivers = lamp.receivers;
  if (lamp.type == OPAL_LIGHT_POINT) b.theta_o = kPi, b.theta_e = 0.5f * kPi;
  else if (lamp.type == OPAL_LIGHT_SPOT) b.theta_e = std::acos(1 - std::min(lamp.cone_omc, 1.0f));
  else b.theta_e = lamp.has_spread ? std::atan(lamp.tan_spread) : 0.5f * kPi;
  // Who stands within a spherical spot sees it whatever the cone.
  if (lamp.type == OPAL_LIGHT_SPOT && lamp.sphere) b.theta_o = 0;
  return b;
}

LightBounds bounds_of(const Scene &scene, const EmissiveTriangle &t) {
  LightBounds b;
  b.box.extend(t.p0), b.box.extend(t.p1), b.box.extend(t.p2);
  const Instance &instance = scene.instances[t.instance];
  const Mesh &mesh = *scene.meshes[instance.mesh];
  if (instance.motion || mesh.moving()) {
    for (int corner = 0; corner < 3; ++corner) {
      const int v = mesh.triangles[size_t(t.triangle) * 3 + size_t(corner)];
      for (int key = 0; key < Motion::kKeys; ++key) {
        const Vec3 local = mesh.vertex(v, Motion::time_of(key));
        if (instance.motion) b.box.extend(instance.motion->path(local));
        else b.box.extend(instance.to_world.point(local));
      }
    }
    b.theta_o = kPi;  // it may turn to any side
  }
  b.axis = safe_normalize(cross(t.p1 - t.p0, t.p2 - t.p0), {0, 0, 1});
  b.theta_e = 0.5f * kPi;
  b.two_sided = true;
  b.power = 0.5f * (luminance(t.emission) + average(t.emission)) * t.area;
  b.receivers = ~uint64_t(0);
  return b;
}

// The emissive triangles of each instance as one ball; they come instance by instance.
std::vector<LightTables::Glow> glows_of(const Scene &scene) {
  std::vector<LightTables::Glow> glows;
  for (size_t first = 0, last = 0; first < scene.emissive.size(); first = last) {
    LightBounds all;
    for (; last < scene.emissive.size() && scene.emissive[last].instance == scene.emissive[first].instance; ++last) {
      const LightBounds one = bounds_of(scene, scene.emissive[last]);
      all.box.extend(one.box.low), all.box.extend(one.box.high);
      all.power += one.power;
    }
    glows.push_back({all.box.centre(), all.box.radius(), all.power});
  }
  return glows;
}

// A lamp's own spectrum at luminance 1, seen through a filter of its colour: white glass leaves it as bright as D65 would be.
SpectralTable filtered_table(const Scene &scene, const SpectralTable &relative, const Vec3 &colour) {
  const float *observer_y = scene.observer_table.data() + kTableSize;
  double y = 0, of_one = 0;
  for (size_t i = 0; i < kTableSize; ++i) {
    y += double(relative[i]) * double(observer_y[i]);
    of_one += double(observer_y[i]);
  }
  SpectralTable out;
  const double scale = y > 0 ? of_one / y : 0;
  for (size_t i = 0; i < kTableSize; ++i) {
    const float filter =
        colour.x * scene.colour.basis[0][i] + colour.y * scene.colour.basis[1][i] + colour.z * scene.colour.basis[2][i];
    out[i] = float(double(relative[i]) * scale) * filter;
  }
  return out;
}

// The colour of a table under the observer, as `brightness` of a lamp wants it.
Vec3 colour_of(const ColourTables &colour, const SpectralTable &table) {
  Vec3 rgb;
  for (size_t i = 0; i < kTableSize; ++i)
    rgb += Vec3{colour.rgb_response[0][i], colour.rgb_response[1][i], colour.rgb_response[2][i]} * table[i];
  return rgb;
}

}  // namespace

Vec3 triangle_emission(const Scene &scene, const EmissiveTriangle &triangle, const Vec3 &origin, const Vec3 &direction,
                       float distance, float b1, float b2, float time) {
  const Program &program = scene.materials[triangle.material].surface;
  if (program.constant_emission) return program.emission;
  const Hit hit{distance, b1, b2, triangle.instance, triangle.triangle};
  ShadingPoint sp = scene.shading_point({origin, direction, 0, kInfinity, time}, hit);
  return run_emission(scene, program, sp);
}

std::shared_ptr<LightTables> build_light_tables(const Scene &scene) {
  auto tables = std::make_shared<LightTables>();
  LightTables &t = *tables;
  t.near_of_lamp.assign(scene.lamps.size(), kNoSource);
  t.near_of_triangle.assign(scene.emissive.size(), kNoSource);
  const auto add_near = [&](SourceId id, const LightBounds &bounds) {
    t.near.push_back(id);
    t.near_bounds.push_back(bounds);
    t.near_bounds.back().finish();
    return uint32_t(t.near.size() - 1);
  };

  for (uint32_t i = 0; i < scene.lamps.size(); ++i) {
    const opal_light_desc &desc = scene.lamps[i].desc;
    LampModel lamp = make_lamp(desc);
    if (lamp.valid && desc.spectrum >= 0 && size_t(desc.spectrum) < scene.spectra.size()) {
      lamp.table = int(t.lamp_tables.size());
      t.lamp_tables.push_back(filtered_table(scene, scene.spectra[size_t(desc.spectrum)], lamp.colour));
      lamp.brightness = brightness_of(colour_of(scene.colour, t.lamp_tables.back()));
      lamp.valid = lamp.brightness > 0 && std::isfinite(lamp.brightness);
    }
    t.lamps.push_back(lamp);
    if (!lamp.valid) continue;
    if (lamp.type == OPAL_LIGHT_SUN) {
      t.far.push_back({SourceKind::Lamp, i});
      t.suns.push_back({-lamp.axis, std::abs(lamp.intensity) * lamp.brightness});
      continue;
    }
    if (lamp.has_size()) t.sized.push_back(i);
    t.near_of_lamp[i] = add_near({SourceKind::Lamp, i}, bounds_of(lamp));
  }
  scene.stop_if_cancelled();
  for (uint32_t i = 0; i < scene.emissive.size(); ++i)
    t.near_of_triangle[i] = add_near({SourceKind::Triangle, i}, bounds_of(scene, scene.emissive[i]));
  scene.stop_if_cancelled();
  t.glows = glows_of(scene);
  scene.stop_if_cancelled();
  if (scene.lights && !scene.world_dirty) t.world = scene.lights->world;
  else t.world.build(scene);
  if (t.world.present() && t.world.brightness() > 0) t.far.push_back({SourceKind::World, 0});
  float suns = 0;
  for (const LightTables::Sun &sun : t.suns) suns += sun.share;
  for (LightTables::Sun &sun : t.suns) sun.share /= suns;
  if (suns > 0) t.sun_share = suns / (suns + (t.world.present() ? kPi * t.world.brightness() : 0.0f));

  if (t.near.size() > kFewLights) {
    t.tree.build(t.near_bounds, scene.commit_cancelled);
    scene.stop_if_cancelled();
    t.near_bounds.clear();
    t.near_bounds.shrink_to_fit();
  }
  t.to_casters.build(scene, t, scene.casters, true);
  if (!scene.bounds.empty())
    t.to_scene.build(scene, t, {{scene.bounds.centre(), scene.bounds.radius() * 1.001f + 1e-6f}}, false);
  else if (scene.world_medium >= 0)  // lamps in nothing but fog; no ray from afar is aimed at a point
    t.to_scene.build(scene, t, std::vector<EmissionTarget>(1), false);
  return tables;
}

void weigh_wavelengths(const Scene &scene, ColourTables &colour) {
  // A lamp's table counts by what the eye and the film make of it; lamps of one spectrum count once.
  bool smooth = scene.world.present || !scene.emissive.empty();
  for (const Medium &medium : scene.media) smooth |= medium.emission >= 0;
  std::vector<SpectralTable> shares;
  std::vector<int32_t> seen;
  for (size_t i = 0; scene.lights && i < scene.lights->lamps.size(); ++i) {
    const LampModel &lamp = scene.lights->lamps[i];
    if (!lamp.valid) continue;
    if (lamp.table < 0) {
      smooth = true;
      continue;
    }
    const int32_t spectrum = scene.lamps[i].desc.spectrum;
    if (std::find(seen.begin(), seen.end(), spectrum) != seen.end()) continue;
    seen.push_back(spectrum);
    SpectralTable share = scene.lights->lamp_tables[size_t(lamp.table)];
    for (size_t k = 0; k < share.size(); ++k) share[k] = std::max(share[k], 0.0f) * colour.smooth[k];
    shares.push_back(share);
  }
  colour.weigh(shares, smooth ? 1 / float(shares.size() + 1) : kLeastSmoothShare);
}

}  // namespace opal
