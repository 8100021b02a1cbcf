// SPDX-License-Identifier: GPL-3.0-or-later
// Preparing a lamp from its description; sending each question to the lamp's kind.
#include "lights/lamp.h"

#include "lights/directions.h"
#include "lights/lamp_area.h"
#include "lights/lamp_round.h"

#include <cstring>

namespace opal {
namespace {

bool describe_round(const opal_light_desc &d, const Transform &t, LampModel &lamp) {
  lamp.radius = std::max(d.radius, 0.0f);
  const float area = 4 * kPi * sqr(lamp.radius);
  // Unnormalised lamps keep their radiance when resized; without a size it stands for an intensity.
  lamp.radiance = d.power * kInvPi / (d.normalize && area > 0 ? area : 1.0f);
  lamp.intensity = area > 0 ? lamp.radiance * kPi * sqr(lamp.radius) : d.power * kInvPi * (d.normalize ? 0.25f : 1.0f);
  lamp.sphere = !d.soft_falloff && area > 0;
  if (d.type == OPAL_LIGHT_POINT) return true;
  lamp.to_local = inverse(t);
  const float half = 0.5f * clamp(d.spot_angle, 0.0f, kPi);
  lamp.cos_half = std::cos(half);
  lamp.inverse_blend = 1 / std::max(one_minus_cos(half) * saturate(d.spot_blend), 1e-12f);
  const float w2 = length_squared(t.axis(2));
  const float uv2 = std::max(length_squared(t.axis(0)), length_squared(t.axis(1)));
  const float tan2 = sqr(std::tan(half)) * uv2 / w2;
  lamp.cone_omc = half < 0.4999f * kPi ? one_minus_cos_from_sin2(tan2 / (1 + tan2)) : 1.0f;
  return t.determinant() != 0 && half > 0;
}

bool describe_area(const opal_light_desc &d, const Transform &t, LampModel &lamp) {
  lamp.ellipse = d.type == OPAL_LIGHT_ELLIPSE;
  const Vec3 x = t.axis(0), y = t.axis(1);
  lamp.half_u = 0.5f * length(x) * std::abs(d.size_u);
  lamp.half_v = 0.5f * length(y) * std::abs(d.size_v);
  lamp.area = lamp.half_u * lamp.half_v * (lamp.ellipse ? kPi : 4.0f);
  const Frame f = Frame::from_zx(lamp.axis, safe_normalize(x, {1, 0, 0}));
  lamp.u = f.x, lamp.v = f.y;
  lamp.radiance = d.power * kInvPi / (d.normalize ? lamp.area : 1.0f);
  if (d.spread < kPi) {
    const double s = 0.5 * std::max(d.spread, 0.0f);
    lamp.has_spread = true;
    lamp.tan_spread = float(std::tan(s));
    lamp.spread_scale = float(s > 0.01 ? 1 / (std::tan(s) - s) : 3 / (s * s * s * (1 + 0.4 * s * s)));
  }
  lamp.intensity = lamp.radiance * lamp.area * (lamp.parallel() ? kPi : spread_attenuation(lamp, 1));
  return lamp.area > 0;
}

bool describe_sun(const opal_light_desc &d, LampModel &lamp) {
  const float half = clamp(d.radius, 0.0f, 0.5f * kPi);
  lamp.sun_omc = one_minus_cos(half);
  const float projected = kPi * sqr(std::sin(half));  // solid angle weighted by the cosine
  lamp.radiance = half > 0 ? d.power / (d.normalize ? projected : 1.0f) : 0.0f;
  lamp.intensity = half > 0 ? lamp.radiance * projected : d.power;
  return true;
}

}  // namespace

// The mean keeps saturated blue from counting for next to nothing.
float brightness_of(const Vec3 &c) {
  return 0.5f * std::abs(luminance(c)) + (std::abs(c.x) + std::abs(c.y) + std::abs(c.z)) / 6;
}

LampModel make_lamp(const opal_light_desc &desc) {
  LampModel lamp;
  Transform t;
  std::memcpy(t.m, desc.transform, sizeof desc.transform);
  lamp.type = desc.type;
  lamp.visibility = desc.visibility;
  lamp.cast_shadow = desc.cast_shadow != 0;
  lamp.caustics = desc.caustics != 0;
  lamp.receivers = desc.receivers;
  lamp.position = t.origin();
  lamp.axis = safe_normalize(-t.axis(2), {0, 0, -1});
  lamp.colour = {desc.color[0], desc.color[1], desc.color[2]};
  lamp.valid = lamp.is_area()                ? describe_area(desc, t, lamp)
               : lamp.type == OPAL_LIGHT_SUN ? describe_sun(desc, lamp)
                                             : describe_round(desc, t, lamp);
  lamp.brightness = brightness_of(lamp.colour);
  lamp.valid = lamp.valid && is_finite(lamp.position) && std::isfinite(lamp.radiance) && std::isfinite(lamp.intensity) &&
               lamp.brightness > 0 && std::isfinite(lamp.brightness) && lamp.intensity != 0;
  return lamp;
}

namespace {

// Where a line is within a cone of half angle below 90 degrees. A cone is convex, so this is one interval; in it
// (x . axis)^2 >= cos^2 x^2 and x . axis >= 0 for x from the apex.
LitPart within_cone(const Vec3 &from_apex, const Vec3 &direction, const Vec3 &axis, float cosine) {
  const double o = dot(from_apex, axis), d = dot(direction, axis), c2 = double(cosine) * cosine;
  const double a = d * d - c2, b = o * d - c2 * dot(from_apex, direction), c = o * o - c2 * length_squared(from_apex);
  const LitPart none{kInfinity, -kInfinity};
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return none;
  const double root = std::sqrt(discriminant);
  // The roots of a t^2 + 2 b t + c without cancellation.
  const double q = -(b + std::copysign(root, b));
  if (a == 0 || q == 0) return o >= 0 || d > 0 ? LitPart{-kInfinity, kInfinity} : none;
  const double near = std::min(q / a, c / q), far = std::max(q / a, c / q);
  if (a > 0) return d > 0 ? LitPart{float(far), kInfinity} : LitPart{-kInfinity, float(near)};
  return o + d * 0.5 * (near + far) >= 0 ? LitPart{float(near), float(far)} : none;
}

LitPart both(const LitPart &a, const LitPart &b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

}  // namespace

LitPart lit_part(const LampModel &lamp, const Ray &ray, float t_max) {
  LitPart lit{0, t_max};
  const Vec3 from_lamp = ray.origin - lamp.position;
  // A lamp of some size: the cone round all its points has its apex behind it.
  const auto cone = [&](float size, float cosine) {
    const float sine = std::sqrt(std::max(1 - sqr(cosine), 0.0f));
    return within_cone(from_lamp + lamp.axis * (size * (1 + 1e-4f) / sine), ray.direction, lamp.axis, cosine * (1 - 1e-6f));
  };
  if (lamp.type == OPAL_LIGHT_SPOT && lamp.cone_omc < 0.999f) return both(lit, cone(lamp.radius, 1 - lamp.cone_omc));
  if (!lamp.is_area()) return lit;
  const float o = dot(from_lamp, lamp.axis), d = dot(ray.direction, lamp.axis);
  if (d > 0) lit.begin = std::max(lit.begin, -o / d);
  else if (d < 0) lit.end = std::min(lit.end, -o / d);
  else if (o <= 0) return {kInfinity, -kInfinity};
  if (!lamp.has_spread || lamp.tan_spread > 50) return lit;
  const float tangent = std::max(lamp.tan_spread, 1e-3f);
  return both(lit, cone(std::hypot(lamp.half_u, lamp.half_v), 1 / std::sqrt(1 + sqr(tangent))));
}

bool sample_lamp(const LampModel &lamp, const Vec3 &p, Vec2 u, LampSample &out) {
  if (lamp.is_round()) return sample_round(lamp, p, u, out);
  if (lamp.is_area()) return sample_area(lamp, p, u, out);
  out.distance = kInfinity;
  out.dirac = !(lamp.sun_omc > 0);
  out.wi = out.dirac ? -lamp.axis : normalize(sample_cone(Frame::from_z(-lamp.axis), lamp.sun_omc, u));
  out.value = out.dirac ? lamp.intensity : lamp.radiance;
  out.pdf = out.dirac ? 1.0f : 1 / cone_solid_angle(lamp.sun_omc);
  return true;
}

float lamp_pdf(const LampModel &lamp, const Vec3 &p, const Vec3 &wi, float distance) {
  if (!lamp.has_size()) return 0;
  if (lamp.is_round()) return pdf_round(lamp, p, wi, distance);
  if (lamp.is_area()) return pdf_area(lamp, p, wi, distance);
  return in_cone(wi, -lamp.axis, lamp.sun_omc) ? 1 / cone_solid_angle(lamp.sun_omc) : 0.0f;
}

bool hit_lamp(const LampModel &lamp, const Ray &ray, float t_after, float t_max, float &t, Vec3 &normal, float &radiance) {
  if (!lamp.has_size()) return false;
  if (lamp.is_round()) return hit_round(lamp, ray, t_after, t_max, t, normal, radiance);
  if (lamp.is_area()) return hit_area(lamp, ray, t_after, t_max, t, normal, radiance);
  return false;  // suns are met by rays that leave the scene
}

}  // namespace opal
