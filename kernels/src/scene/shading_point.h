// SPDX-License-Identifier: GPL-3.0-or-later
// What a shader and a BSDF know about a point on a surface (or about a direction, for the world).
//
// Directions point away from the surface. As in Cycles, both normals face the viewer: where a ray meets the back of a
// face, ng and ns are flipped and `backfacing` is set.
#pragma once

#include "core/vec.h"

#include <cstdint>

namespace opal {

struct Mesh;
struct Instance;

struct ShadingPoint {
  Vec3 p;              // world space
  Vec3 ng, ns;         // geometric and interpolated shading normal, towards the viewer
  Vec3 wo;             // towards the viewer
  float u = 0, v = 0;  // barycentric: p = (1-u-v) p0 + u p1 + v p2
  uint32_t triangle = 0;
  uint32_t instance_index = 0;
  const Mesh *mesh = nullptr;  // nullptr: the world or a lamp; then p is the direction looked in
  const Instance *instance = nullptr;
  uint32_t ray_kind = 0;  // OPAL_RAY_* bits of the ray that came here
  uint32_t depth = 0;     // bounces before this point
  float ray_length = 0;
  float time = 0;
  Vec3 error;  // bound on the rounding error of p, per axis
  bool backfacing = false;
  bool smooth = false;  // the face has normals of its own
};

}  // namespace opal
