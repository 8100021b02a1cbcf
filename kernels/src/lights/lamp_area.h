// SPDX-License-Identifier: GPL-3.0-or-later
// Area lamps: rectangles and ellipses that shine to one side, with Blender's spread.
//
// Rectangles are sampled uniformly in solid angle (Urena, Fajardo & King 2013, "An Area-Preserving Parametrization for
// Spherical Rectangles"), ellipses uniformly in area. With a spread only the part of the lamp that reaches the point is
// sampled, within its bounding rectangle.
#pragma once

#include "lights/lamp.h"

namespace opal {

bool sample_area(const LampModel &lamp, const Vec3 &p, Vec2 u, LampSample &out);
float pdf_area(const LampModel &lamp, const Vec3 &p, const Vec3 &wi, float distance);
bool hit_area(const LampModel &lamp, const Ray &ray, float t_after, float t_max, float &t, Vec3 &normal, float &radiance);

// A rectangle as seen from the origin: corners x0..x1, y0..y1 at height z0 < 0.
class SphericalRectangle {
 public:
  SphericalRectangle(double x0, double x1, double y0, double y1, double z0);
  double solid_angle() const { return solid_angle_; }
  // The point (x, y) of the rectangle for uniform u.
  Vec2 sample(Vec2 u) const;

 private:
  double x0_, x1_, y0_, y1_, z0_, b0_, b1_, k_, solid_angle_;
};

}  // namespace opal
