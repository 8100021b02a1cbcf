// SPDX-License-Identifier: GPL-3.0-or-later
// The Math, Vector Math, Map Range, Mapping and Vector Rotate nodes as functions.
//
// None of them gives a NaN where Blender gives a number: a division by zero is 0, the root of a negative number 0, the
// power of a negative number to a fraction 0, as in Cycles' kernel/svm/math_util.h.
#pragma once

#include "core/vec.h"
#include "opal_shader.h"

namespace opal {

float node_math(int mode, float a, float b, float c);
// Modes that give a number (Dot Product, Distance, Length) write it to all three components.
Vec3 node_vector_math(int mode, const Vec3 &a, const Vec3 &b, const Vec3 &c, float scale);
float node_map_range(int mode, float value, float from_min, float from_max, float to_min, float to_max, float steps);
Vec3 node_vector_map_range(int mode, const Vec3 &value, const Vec3 &from_min, const Vec3 &from_max, const Vec3 &to_min,
                           const Vec3 &to_max, const Vec3 &steps, bool clamp_result);
// Rotation about X, then Y, then Z (radians).
Transform euler_rotation(const Vec3 &angles);
Vec3 node_mapping(int mode, const Vec3 &v, const Vec3 &location, const Vec3 &rotation, const Vec3 &scale);
Vec3 node_vector_rotate(int mode, const Vec3 &v, const Vec3 &center, const Vec3 &axis, float angle, const Vec3 &rotation,
                        bool invert);

inline float safe_divide(float a, float b) { return b != 0 ? a / b : 0.0f; }
inline Vec3 safe_divide(const Vec3 &a, const Vec3 &b) {
  return {safe_divide(a.x, b.x), safe_divide(a.y, b.y), safe_divide(a.z, b.z)};
}
inline float smoothstep01(float t) { return t <= 0 ? 0.0f : t >= 1 ? 1.0f : t * t * (3 - 2 * t); }

}  // namespace opal
