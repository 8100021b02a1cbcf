// SPDX-License-Identifier: GPL-3.0-or-later
// One lamp, prepared: shape, spectrum, and the questions every kind of lamp answers.
//
// Radiometry equals Cycles (PHYSICS 6b). With power P, unit colour, and `normalize` set:
//   point    radiance P / (4 pi^2 r^2) over its sphere or facing disc; r = 0: intensity P / (4 pi)
//   spot     the same times smoothstep((cos - cos_half) / (blend (1 - cos_half))) of the direction that leaves
//   area     radiance P / (pi A) on the side it looks to, times the spread's attenuation
//   sun      radiance P / (pi sin^2 half) over its disc; half = 0: irradiance P
#pragma once

#include "core/spectrum.h"
#include "lights/lights.h"

namespace opal {

struct LampModel {
  int type = OPAL_LIGHT_POINT;
  bool valid = false;   // finite, not singular, not black
  bool sphere = false;  // point, spot: a sphere, not a disc that faces who looks
  bool ellipse = false;
  uint32_t visibility = OPAL_RAY_ALL;
  bool cast_shadow = true, caustics = true;
  uint64_t receivers = ~uint64_t(0);
  Vec3 position, axis;  // axis: where it looks; sun: where its light goes
  Vec3 u, v;            // area: unit, perpendicular
  float half_u = 0, half_v = 0, area = 0;
  float radius = 0;
  float radiance = 0;   // of shapes with a size, per unit of colour
  float intensity = 0;  // point, spot: on the axis; area: on the axis; sun: irradiance
  // Spot
  Transform to_local;
  float cos_half = -1, inverse_blend = 0, cone_omc = 2;  // cone_omc: 1 - cos of the whole cone, transform's scale included
  // Area
  bool has_spread = false;
  float tan_spread = 0, spread_scale = 1;
  // Sun
  float sun_omc = 0;
  // Colour
  Vec3 colour;
  int table = -1;        // into LightTables::lamp_tables
  float brightness = 0;  // luminance of the colour, absolute, for importance

  bool has_size() const { return type == OPAL_LIGHT_SUN ? sun_omc > 0 : radius > 0 || (area > 0 && !parallel()); }
  bool parallel() const { return has_spread && tan_spread < 1e-5f; }
  bool is_round() const { return type == OPAL_LIGHT_POINT || type == OPAL_LIGHT_SPOT; }
  bool is_area() const { return type == OPAL_LIGHT_RECTANGLE || type == OPAL_LIGHT_ELLIPSE; }
};

LampModel make_lamp(const opal_light_desc &desc);
// How much a colour counts when lamps are chosen between.
float brightness_of(const Vec3 &colour);

// What a lamp sends towards a point: the sampled direction and a scalar to be multiplied by the lamp's spectrum.
struct LampSample {
  Vec3 wi;
  float distance = kInfinity;
  float value = 0;  // radiance, or irradiance for Dirac lamps
  float pdf = 0;    // solid angle; Dirac: 1
  bool dirac = false;
};
bool sample_lamp(const LampModel &lamp, const Vec3 &p, Vec2 u, LampSample &out);
// pdf of sample_lamp for a direction that hits the lamp at `distance`; 0 for Dirac lamps.
float lamp_pdf(const LampModel &lamp, const Vec3 &p, const Vec3 &wi, float distance);
// Where a ray meets the lamp beyond t_after and before t_max, what it sees there (scalar radiance) and the normal.
bool hit_lamp(const LampModel &lamp, const Ray &ray, float t_after, float t_max, float &t, Vec3 &normal, float &radiance);

// The part of a ray within which a lamp's beam may light it: within a spot's cone, before an area lamp's face and within its
// spread. No lit place is left out; begin > end: none is lit. Suns: all of the ray.
struct LitPart {
  float begin = 0, end = kInfinity;
};
LitPart lit_part(const LampModel &lamp, const Ray &ray, float t_max);

// Factor of a spot for light leaving in world direction d; 1 for points.
float spot_attenuation(const LampModel &lamp, const Vec3 &d);
// Factor of an area lamp's spread for light leaving at `cosine` to its axis: what passes a grid of slats, (tan s - tan a) /
// (tan s - s) with s half of the spread, so that the power stays what it is. 1 without spread, 0 behind.
float spread_attenuation(const LampModel &lamp, float cosine);

}  // namespace opal
