// SPDX-License-Identifier: GPL-3.0-or-later
// Faces that coincide: a gem that lies on a floor, water that touches its glass, clouds side by side.
//
// A ray that leaves a surface starts a rounding error's width off it, and would pass over whatever lies in the same place.
// Where bodies touch, a ray therefore starts on the near side of all of them and keeps account of those that it has crossed.
// Reflected, it meets just these again. Of several boundaries in one place those of gems that are entered come first, then
// those of gems that are left, then surfaces, then those of media: gems that touch are in optical contact, a gem does not shine
// through its floor, and what a surface throws back stays in the fog that it came through.
#pragma once

#include "scene/interior.h"
#include "scene/scene.h"

namespace opal {

// The next boundary along the ray.
Hit next_hit(const Scene &scene, const Ray &ray, uint32_t visibility);

// The ray that leaves sp, where `arrived` has hit, along `direction`.
Ray leave_surface(const Scene &scene, const Ray &arrived, const ShadingPoint &sp, const Vec3 &direction);

}  // namespace opal
