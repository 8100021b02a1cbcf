// SPDX-License-Identifier: GPL-3.0-or-later
// See lamp_area.h. The spherical rectangle is computed in double precision: its solid angle is a small difference of
// angles, and with doubles it keeps five digits down to 1e-9 sr.
#include "lights/lamp_area.h"

#include "lights/directions.h"

namespace opal {
namespace {

// Below this the rectangle is as good as flat and is sampled by area.
constexpr double kSmallestSolidAngle = 1e-7;

bool inside(const LampModel &lamp, float x, float y) {
  if (lamp.ellipse) return sqr(x / lamp.half_u) + sqr(y / lamp.half_v) <= 1;
  return std::abs(x) <= lamp.half_u && std::abs(y) <= lamp.half_v;
}

// The part of a lamp that is sampled from p, in the lamp's plane about its centre.
struct Region {
  float x0, x1, y0, y1;
  bool rectangle;
  float area;
};

// p at (x, y) over the lamp's plane, `height` above it. False where the lamp cannot reach p.
bool visible_region(const LampModel &lamp, float x, float y, float height, Region &r) {
  if (!(height > 0)) return false;
  r = {-lamp.half_u, lamp.half_u, -lamp.half_v, lamp.half_v, !lamp.ellipse, lamp.area};
  if (!lamp.has_spread) return true;
  const float reach = height * lamp.tan_spread;
  const float x0 = std::max(r.x0, x - reach), x1 = std::min(r.x1, x + reach);
  const float y0 = std::max(r.y0, y - reach), y1 = std::min(r.y1, y + reach);
  if (!(x0 < x1 && y0 < y1)) return false;
  const float clipped = (x1 - x0) * (y1 - y0);
  if (r.rectangle || clipped < r.area) r = {x0, x1, y0, y1, true, clipped};
  return true;
}

struct Seen {
  float x, y, height;  // p in the lamp's frame
};
Seen look(const LampModel &lamp, const Vec3 &p) {
  const Vec3 q = p - lamp.position;
  return {dot(q, lamp.u), dot(q, lamp.v), dot(q, lamp.axis)};
}

SphericalRectangle spherical(const Region &r, const Seen &s) {
  return {double(r.x0) - s.x, double(r.x1) - s.x, double(r.y0) - s.y, double(r.y1) - s.y, -double(s.height)};
}

}  // namespace

SphericalRectangle::SphericalRectangle(double x0, double x1, double y0, double y1, double z0)
    : x0_(x0), x1_(x1), y0_(y0), y1_(y1), z0_(z0) {
  // z components of the normals of the four planes through the origin and the edges, and the interior angles.
  const auto normal_z = [z0](double e) { return e / std::sqrt(z0 * z0 + e * e); };
  const double n0 = -normal_z(y0), n1 = normal_z(x1), n2 = normal_z(y1), n3 = -normal_z(x0);
  const auto angle = [](double c) { return std::acos(std::clamp(c, -1.0, 1.0)); };
  const double g0 = angle(-n0 * n1), g1 = angle(-n1 * n2), g2 = angle(-n2 * n3), g3 = angle(-n3 * n0);
  b0_ = n0, b1_ = n2;
  constexpr double kTwoPi = 6.283185307179586477;
  k_ = kTwoPi - g2 - g3;
  solid_angle_ = std::max(g0 + g1 - k_, 0.0);
}

Vec2 SphericalRectangle::sample(Vec2 u) const {
  const double au = u.x * solid_angle_ + k_;
  const double fu = (std::cos(au) * b0_ - b1_) / std::sin(au);
  double cu = std::copysign(1.0, fu) / std::sqrt(fu * fu + b0_ * b0_);
  cu = std::clamp(cu, -1.0, 1.0);
  const double xu = std::clamp(-cu * z0_ / std::sqrt(std::max(1 - cu * cu, 1e-30)), x0_, x1_);
  const double d2 = xu * xu + z0_ * z0_;
  const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
  const double hv = h0 + u.y * (h1 - h0), hv2 = hv * hv;
  const double yv = hv2 < 1 - 1e-12 ? hv * std::sqrt(d2 / (1 - hv2)) : y1_;
  return {float(xu), float(std::clamp(yv, y0_, y1_))};
}

float spread_attenuation(const LampModel &lamp, float cosine) {
  if (!(cosine > 0)) return 0;
  if (!lamp.has_spread) return 1;
  const float tangent = safe_sqrt(1 - cosine * cosine) / cosine;
  return std::max((lamp.tan_spread - tangent) * lamp.spread_scale, 0.0f);
}

bool sample_area(const LampModel &lamp, const Vec3 &p, Vec2 u, LampSample &out) {
  const Seen s = look(lamp, p);
  if (lamp.parallel()) {  // a beam as wide as the lamp
    if (!(s.height > 0) || !inside(lamp, s.x, s.y)) return false;
    out = {-lamp.axis, s.height, lamp.radiance * kPi, 1, true};
    return true;
  }
  Region r;
  if (!visible_region(lamp, s.x, s.y, s.height, r)) return false;
  float x, y;  // from p's foot, in the lamp's plane
  out.pdf = -1;
  if (r.rectangle) {
    const SphericalRectangle rectangle = spherical(r, s);
    if (rectangle.solid_angle() > kSmallestSolidAngle) {
      const Vec2 q = rectangle.sample(u);
      x = q.x, y = q.y;
      out.pdf = float(1 / rectangle.solid_angle());
    } else {
      x = lerp(r.x0, r.x1, u.x) - s.x, y = lerp(r.y0, r.y1, u.y) - s.y;
    }
  } else {
    const Vec2 q = sample_disc(u);
    x = q.x * lamp.half_u - s.x, y = q.y * lamp.half_v - s.y;
  }
  if (lamp.ellipse && r.rectangle && !inside(lamp, x + s.x, y + s.y)) return false;
  const Vec3 to_point = lamp.u * x + lamp.v * y - lamp.axis * s.height;
  out.distance = length(to_point);
  out.wi = to_point / out.distance;
  out.dirac = false;
  const float cosine = s.height / out.distance;
  if (out.pdf < 0) out.pdf = sqr(out.distance) / (cosine * r.area);
  out.value = lamp.radiance * spread_attenuation(lamp, cosine);
  return out.value != 0;
}

float pdf_area(const LampModel &lamp, const Vec3 &p, const Vec3 &wi, float distance) {
  const float cosine = -dot(wi, lamp.axis);
  const Seen s = look(lamp, p);
  Region r;
  if (!(cosine > 0) || !visible_region(lamp, s.x, s.y, s.height, r)) return 0;
  if (r.rectangle) {
    const double solid_angle = spherical(r, s).solid_angle();
    if (solid_angle > kSmallestSolidAngle) return float(1 / solid_angle);
  }
  return sqr(distance) / (cosine * r.area);
}

bool hit_area(const LampModel &lamp, const Ray &ray, float t_after, float t_max, float &t, Vec3 &normal, float &radiance) {
  const float cosine = -dot(ray.direction, lamp.axis);
  if (!(cosine > 0)) return false;
  const Vec3 q = ray.origin - lamp.position;
  t = dot(q, lamp.axis) / cosine;
  if (!(t > t_after && t < t_max)) return false;
  const Vec3 at = q + ray.direction * t;
  if (!inside(lamp, dot(at, lamp.u), dot(at, lamp.v))) return false;
  normal = lamp.axis;
  radiance = lamp.radiance * spread_attenuation(lamp, cosine);
  return radiance != 0;
}

}  // namespace opal
