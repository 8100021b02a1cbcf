// SPDX-License-Identifier: GPL-3.0-or-later
// Point and spot lamps: spheres, or discs that face whoever looks at them.
//
// Blender's "Soft Falloff" (its default) gives every point p a disc of the lamp's radius through its centre, facing p, of
// the radiance that the sphere would have: irradiance I / (d^2 + r^2), finite everywhere. Without it the lamp is a
// sphere, and its irradiance I / d^2.
#pragma once

#include "lights/lamp.h"

namespace opal {

bool sample_round(const LampModel &lamp, const Vec3 &p, Vec2 u, LampSample &out);
float pdf_round(const LampModel &lamp, const Vec3 &p, const Vec3 &wi, float distance);
bool hit_round(const LampModel &lamp, const Ray &ray, float t_after, float t_max, float &t, Vec3 &normal, float &radiance);

}  // namespace opal
