// SPDX-License-Identifier: GPL-3.0-or-later
// Looking an image up: projection, extension, interpolation, decoding.
//
// Pixel centres lie at half-integers, row 0 at the bottom. Interpolation acts on the stored values and the transfer
// function after it, as in Cycles. The cubic filter is the uniform B-spline, which smooths: that is Blender's Cubic.
#pragma once

#include "scene/scene.h"
#include "shader/registers.h"

namespace opal {

struct ImageSettings {
  int interpolation = OPAL_INTERPOLATE_LINEAR, extension = OPAL_EXTEND_REPEAT, flags = 0;
};

// rgba at (u, v); transparent black outside of a clipped image.
Float4 lookup_image(const Image &image, const ImageSettings &settings, float u, float v);

// Coordinates on a sphere, a tube (both from a vector in the box 0..1) and for a direction.
Vec2 project_sphere(const Vec3 &p);
Vec2 project_tube(const Vec3 &p);
Vec2 project_equirectangular(const Vec3 &direction);
Vec2 project_mirror_ball(const Vec3 &direction);

// How much each of the three planes of a box projection counts, for a normal in object space.
Vec3 box_weights(const Vec3 &normal, float blend);

}  // namespace opal
