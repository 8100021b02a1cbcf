// SPDX-License-Identifier: GPL-3.0-or-later
// Sampling a triangle as seen from a point: uniformly in solid angle where it looms large, by area where it is small.
//
// Arvo 1995, "Stratified Sampling of Spherical Triangles", in the vector form of Pharr, Jakob & Humphreys (pbrt, 4th
// edition, section 6.5.4).
#pragma once

#include "core/vec.h"

namespace opal {

struct TriangleSample {
  Vec3 wi;
  float distance = 0, b1 = 0, b2 = 0;  // barycentrics of p1 and p2
  float pdf = 0;                       // solid angle
};

// `area`: of the triangle. Both faces are sampled alike.
bool sample_triangle(const Vec3 &p0, const Vec3 &p1, const Vec3 &p2, float area, const Vec3 &p, Vec2 u, TriangleSample &out);
// pdf of the above for the direction wi that meets the triangle at `distance`.
float triangle_pdf(const Vec3 &p0, const Vec3 &p1, const Vec3 &p2, float area, const Vec3 &p, const Vec3 &wi, float distance);

// Solid angle of the triangle of unit vectors a, b, c (Van Oosterom & Strackee 1983).
float spherical_triangle_area(const Vec3 &a, const Vec3 &b, const Vec3 &c);

}  // namespace opal
