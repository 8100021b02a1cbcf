// SPDX-License-Identifier: GPL-3.0-or-later
// See triangle_light.h.
#include "lights/triangle_light.h"

namespace opal {
namespace {

// Outside this range of solid angles the spherical form loses its digits (small) or its meaning (half of everything).
constexpr float kSmallest = 2e-3f, kLargest = 6.2f;

struct Corners {
  Vec3 a, b, c;  // unit
  float solid_angle = 0;
  bool spherical = false;
};

Corners look(const Vec3 &p0, const Vec3 &p1, const Vec3 &p2, float area, const Vec3 &p) {
  Corners s;
  const Vec3 d0 = p0 - p, d1 = p1 - p, d2 = p2 - p;
  // An upper bound first: most emissive triangles are small and far.
  const float nearest2 = std::min({length_squared(d0), length_squared(d1), length_squared(d2)});
  if (16 * area < kSmallest * nearest2) return s;
  s.a = safe_normalize(d0, {}), s.b = safe_normalize(d1, {}), s.c = safe_normalize(d2, {});
  s.solid_angle = spherical_triangle_area(s.a, s.b, s.c);
  s.spherical = s.solid_angle > kSmallest && s.solid_angle < kLargest;
  return s;
}

float angle_between(const Vec3 &a, const Vec3 &b) {
  if (dot(a, b) < 0) return kPi - 2 * std::asin(std::min(0.5f * length(a + b), 1.0f));
  return 2 * std::asin(std::min(0.5f * length(b - a), 1.0f));
}

// Uniform direction in the spherical triangle.
bool sample_spherical(const Corners &s, Vec2 u, Vec3 &wi) {
  const Vec3 &a = s.a, &b = s.b, &c = s.c;
  const Vec3 ab = cross(a, b), bc = cross(b, c), ca = cross(c, a);
  if (!(length_squared(ab) > 0 && length_squared(bc) > 0 && length_squared(ca) > 0)) return false;
  const Vec3 nab = normalize(ab), nbc = normalize(bc), nca = normalize(ca);
  const float alpha = angle_between(nab, -nca), beta = angle_between(nbc, -nab), gamma = angle_between(nca, -nbc);
  // The sub-triangle with corner a that has u.x of the area: its third corner c' lies on the arc from a to c.
  const float area_plus_pi = lerp(kPi, alpha + beta + gamma, u.x);
  const float cos_alpha = std::cos(alpha), sin_alpha = std::sin(alpha);
  const float sin_phi = std::sin(area_plus_pi) * cos_alpha - std::cos(area_plus_pi) * sin_alpha;
  const float cos_phi = std::cos(area_plus_pi) * cos_alpha + std::sin(area_plus_pi) * sin_alpha;
  const float k1 = cos_phi + cos_alpha, k2 = sin_phi - sin_alpha * dot(a, b);
  const float denominator = (sin_phi * k2 + cos_phi * k1) * sin_alpha;
  const float numerator = k2 + (cos_phi * k2 - sin_phi * k1) * cos_alpha;
  const float cos_bp = denominator != 0 ? clamp(numerator / denominator, -1, 1) : 1.0f;
  const Vec3 along = safe_normalize(c - a * dot(c, a), {});
  const Vec3 cp = a * cos_bp + along * safe_sqrt(1 - cos_bp * cos_bp);
  const float cos_theta = 1 - u.y * (1 - dot(cp, b));
  wi = b * cos_theta + safe_normalize(cp - b * dot(cp, b), {}) * safe_sqrt(1 - cos_theta * cos_theta);
  wi = safe_normalize(wi, {});
  return length_squared(wi) > 0;
}

float area_pdf(const Vec3 &p0, const Vec3 &p1, const Vec3 &p2, float area, const Vec3 &wi, float distance) {
  const float cosine = std::abs(dot(wi, cross(p1 - p0, p2 - p0))) / (2 * area);
  return cosine > 1e-7f ? distance * distance / (cosine * area) : 0.0f;
}

}  // namespace

float spherical_triangle_area(const Vec3 &a, const Vec3 &b, const Vec3 &c) {
  const float numerator = std::abs(dot(a, cross(b, c)));
  const float denominator = 1 + dot(a, b) + dot(b, c) + dot(a, c);
  return std::abs(2 * std::atan2(numerator, denominator));
}

bool sample_triangle(const Vec3 &p0, const Vec3 &p1, const Vec3 &p2, float area, const Vec3 &p, Vec2 u, TriangleSample &out) {
  const Corners s = look(p0, p1, p2, area, p);
  const Vec3 e1 = p1 - p0, e2 = p2 - p0;
  if (s.spherical) {
    Vec3 wi;
    if (!sample_spherical(s, u, wi)) return false;
    // Where that direction meets the plane (Moeller & Trumbore 1997).
    const Vec3 q = cross(wi, e2);
    const float det = dot(e1, q);
    if (det == 0) return false;
    const Vec3 from = p - p0;
    out.b1 = saturate(dot(from, q) / det);
    out.b2 = clamp(dot(wi, cross(from, e1)) / det, 0.0f, 1 - out.b1);
    out.pdf = 1 / s.solid_angle;
  } else {
    // Uniform in area (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
    if (u.x < u.y) out.b1 = 0.5f * u.x, out.b2 = u.y - out.b1;
    else out.b2 = 0.5f * u.y, out.b1 = u.x - out.b2;
  }
  const float b0 = 1 - out.b1 - out.b2;
  const Vec3 to_point = p0 * b0 + p1 * out.b1 + p2 * out.b2 - p;
  out.distance = length(to_point);
  if (!(out.distance > 0)) return false;
  out.wi = to_point / out.distance;
  if (!s.spherical) out.pdf = area_pdf(p0, p1, p2, area, out.wi, out.distance);
  return out.pdf > 0 && std::isfinite(out.pdf);
}

float triangle_pdf(const Vec3 &p0, const Vec3 &p1, const Vec3 &p2, float area, const Vec3 &p, const Vec3 &wi, float distance) {
  const Corners s = look(p0, p1, p2, area, p);
  return s.spherical ? 1 / s.solid_angle : area_pdf(p0, p1, p2, area, wi, distance);
}

}  // namespace opal
