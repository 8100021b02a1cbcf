// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader/maths.h"

#include <cfloat>

namespace opal {
namespace {

float power(float base, float exponent) {
  if (exponent == 0) return 1;
  if (base == 0) return 0;
  if (base < 0 && exponent != std::trunc(exponent)) return 0;
  return std::pow(base, exponent);
}

float sign(float x) { return x == 0 ? 0.0f : x < 0 ? -1.0f : 1.0f; }

float wrap(float value, float high, float low) {
  const float range = high - low;
  return range != 0 ? value - range * std::floor((value - low) / range) : low;
}

float floored_modulo(float a, float b) { return b != 0 ? a - std::floor(a / b) * b : 0.0f; }

// Quilez' cubic polynomial smooth minimum.
float smooth_minimum(float a, float b, float k) {
  if (k == 0) return std::fmin(a, b);
  const float h = std::fmax(k - std::abs(a - b), 0.0f) / k;
  return std::fmin(a, b) - h * h * h * k * (1.0f / 6.0f);
}

template <class F>
Vec3 each(const Vec3 &a, F f) {
  return {f(a.x), f(a.y), f(a.z)};
}
template <class F>
Vec3 each(const Vec3 &a, const Vec3 &b, F f) {
  return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}

Vec3 direction_of(const Vec3 &v) { return safe_normalize(v, v); }

Vec3 refract_by(const Vec3 &incident, const Vec3 &n, float eta) {
  const float c = dot(n, incident);
  const float k = 1 - eta * eta * (1 - c * c);
  return k < 0 ? Vec3{} : eta * incident - (eta * c + std::sqrt(k)) * n;
}

float smootherstep01(float t) {
  t = saturate(t);
  return t * t * t * (t * (t * 6 - 15) + 10);
}

float range_factor(int mode, float t, float steps) {
  switch (mode) {
    case OPAL_RANGE_STEPPED: return steps > 0 ? std::floor(t * (steps + 1)) / steps : 0.0f;
    case OPAL_RANGE_SMOOTHSTEP: return smoothstep01(t);
    case OPAL_RANGE_SMOOTHERSTEP: return smootherstep01(t);
    default: return t;
  }
}

}  // namespace

float node_math(int mode, float a, float b, float c) {
  switch (mode) {
    case OPAL_MATH_ADD: return a + b;
    case OPAL_MATH_SUBTRACT: return a - b;
    case OPAL_MATH_MULTIPLY: return a * b;
    case OPAL_MATH_DIVIDE: return safe_divide(a, b);
    case OPAL_MATH_MULTIPLY_ADD: return a * b + c;
    case OPAL_MATH_POWER: return power(a, b);
    case OPAL_MATH_LOGARITHM: return a <= 0 || b <= 0 ? 0.0f : safe_divide(std::log(a), std::log(b));
    case OPAL_MATH_SQRT: return safe_sqrt(a);
    case OPAL_MATH_INVERSE_SQRT: return a > 0 ? 1 / std::sqrt(a) : 0.0f;
    case OPAL_MATH_ABSOLUTE: return std::abs(a);
    case OPAL_MATH_EXPONENT: return std::exp(a);
    case OPAL_MATH_MINIMUM: return std::fmin(a, b);
    case OPAL_MATH_MAXIMUM: return std::fmax(a, b);
    case OPAL_MATH_LESS_THAN: return a < b;
    case OPAL_MATH_GREATER_THAN: return a > b;
    case OPAL_MATH_SIGN: return sign(a);
    case OPAL_MATH_COMPARE: return a == b || std::abs(a - b) <= std::fmax(c, FLT_EPSILON);
    case OPAL_MATH_SMOOTH_MIN: return smooth_minimum(a, b, c);
    case OPAL_MATH_SMOOTH_MAX: return -smooth_minimum(-a, -b, c);
    case OPAL_MATH_ROUND: return std::floor(a + 0.5f);
    case OPAL_MATH_FLOOR: return std::floor(a);
    case OPAL_MATH_CEIL: return std::ceil(a);
    case OPAL_MATH_TRUNC: return std::trunc(a);
    case OPAL_MATH_FRACT: return a - std::floor(a);
    case OPAL_MATH_MODULO: return b != 0 ? std::fmod(a, b) : 0.0f;
    case OPAL_MATH_FLOORED_MODULO: return floored_modulo(a, b);
    case OPAL_MATH_WRAP: return wrap(a, b, c);
    case OPAL_MATH_SNAP: return std::floor(safe_divide(a, b)) * b;
    case OPAL_MATH_PINGPONG: {
      if (b == 0) return 0;
      const float t = (a - b) / (b * 2);
      return std::abs((t - std::floor(t)) * b * 2 - b);
    }
    case OPAL_MATH_SINE: return std::sin(a);
    case OPAL_MATH_COSINE: return std::cos(a);
    case OPAL_MATH_TANGENT: return std::tan(a);
    case OPAL_MATH_ARCSINE: return std::asin(clamp(a, -1, 1));
    case OPAL_MATH_ARCCOSINE: return std::acos(clamp(a, -1, 1));
    case OPAL_MATH_ARCTANGENT: return std::atan(a);
    case OPAL_MATH_ARCTAN2: return a == 0 && b == 0 ? 0.0f : std::atan2(a, b);
    case OPAL_MATH_SINH: return std::sinh(a);
    case OPAL_MATH_COSH: return std::cosh(a);
    case OPAL_MATH_TANH: return std::tanh(a);
    case OPAL_MATH_RADIANS: return a * (kPi / 180);
    case OPAL_MATH_DEGREES: return a * (180 / kPi);
    default: return 0;
  }
}

Vec3 node_vector_math(int mode, const Vec3 &a, const Vec3 &b, const Vec3 &c, float scale) {
  const auto all = [](float s) { return Vec3{s, s, s}; };
  switch (mode) {
    case OPAL_VECTOR_ADD: return a + b;
    case OPAL_VECTOR_SUBTRACT: return a - b;
    case OPAL_VECTOR_MULTIPLY: return a * b;
    case OPAL_VECTOR_DIVIDE: return safe_divide(a, b);
    case OPAL_VECTOR_MULTIPLY_ADD: return a * b + c;
    case OPAL_VECTOR_CROSS: return cross(a, b);
    case OPAL_VECTOR_PROJECT: {
      const float l2 = length_squared(b);
      return l2 != 0 ? b * (dot(a, b) / l2) : Vec3{};
    }
    case OPAL_VECTOR_REFLECT: {
      const Vec3 n = direction_of(b);
      return a - 2 * dot(a, n) * n;
    }
    case OPAL_VECTOR_REFRACT: return refract_by(a, direction_of(b), scale);
    case OPAL_VECTOR_FACEFORWARD: return dot(c, b) < 0 ? a : -a;
    case OPAL_VECTOR_DOT: return all(dot(a, b));
    case OPAL_VECTOR_DISTANCE: return all(length(a - b));
    case OPAL_VECTOR_LENGTH: return all(length(a));
    case OPAL_VECTOR_SCALE: return a * scale;
    case OPAL_VECTOR_NORMALIZE: return direction_of(a);
    case OPAL_VECTOR_ABSOLUTE: return each(a, [](float x) { return std::abs(x); });
    case OPAL_VECTOR_POWER: return each(a, b, power);
    case OPAL_VECTOR_SIGN: return each(a, sign);
    case OPAL_VECTOR_MINIMUM: return min(a, b);
    case OPAL_VECTOR_MAXIMUM: return max(a, b);
    case OPAL_VECTOR_FLOOR: return each(a, [](float x) { return std::floor(x); });
    case OPAL_VECTOR_CEIL: return each(a, [](float x) { return std::ceil(x); });
    case OPAL_VECTOR_FRACTION: return each(a, [](float x) { return x - std::floor(x); });
    case OPAL_VECTOR_MODULO: return each(a, b, [](float x, float y) { return y != 0 ? std::fmod(x, y) : 0.0f; });
    case OPAL_VECTOR_WRAP: return {wrap(a.x, b.x, c.x), wrap(a.y, b.y, c.y), wrap(a.z, b.z, c.z)};
    case OPAL_VECTOR_SNAP: return each(a, b, [](float x, float y) { return std::floor(safe_divide(x, y)) * y; });
    case OPAL_VECTOR_SINE: return each(a, [](float x) { return std::sin(x); });
    case OPAL_VECTOR_COSINE: return each(a, [](float x) { return std::cos(x); });
    case OPAL_VECTOR_TANGENT: return each(a, [](float x) { return std::tan(x); });
    case OPAL_VECTOR_ROUND: return each(a, [](float x) { return std::floor(x + 0.5f); });
    default: return {};
  }
}

float node_map_range(int mode, float value, float from_min, float from_max, float to_min, float to_max, float steps) {
  if (from_max == from_min) return 0;
  return to_min + range_factor(mode, (value - from_min) / (from_max - from_min), steps) * (to_max - to_min);
}

Vec3 node_vector_map_range(int mode, const Vec3 &value, const Vec3 &from_min, const Vec3 &from_max, const Vec3 &to_min,
                           const Vec3 &to_max, const Vec3 &steps, bool clamp_result) {
  Vec3 r;
  for (int i = 0; i < 3; ++i) {
    const float t = range_factor(mode, safe_divide(value[i] - from_min[i], from_max[i] - from_min[i]), steps[i]);
    r[i] = to_min[i] + t * (to_max[i] - to_min[i]);
    if (clamp_result) r[i] = clamp(r[i], std::min(to_min[i], to_max[i]), std::max(to_min[i], to_max[i]));
  }
  return r;
}

Transform euler_rotation(const Vec3 &angles) {
  const float cx = std::cos(angles.x), cy = std::cos(angles.y), cz = std::cos(angles.z);
  const float sx = std::sin(angles.x), sy = std::sin(angles.y), sz = std::sin(angles.z);
  return {{cy * cz, sy * sx * cz - cx * sz, sy * cx * cz + sx * sz, 0,  //
           cy * sz, sy * sx * sz + cx * cz, sy * cx * sz - sx * cz, 0,  //
           -sy, cy * sx, cy * cx, 0}};
}

Vec3 node_mapping(int mode, const Vec3 &v, const Vec3 &location, const Vec3 &rotation, const Vec3 &scale) {
  const Transform r = euler_rotation(rotation);
  switch (mode) {
    case OPAL_MAPPING_TEXTURE: return safe_divide(r.transposed_vector(v - location), scale);
    case OPAL_MAPPING_VECTOR: return r.vector(v * scale);
    case OPAL_MAPPING_NORMAL: return direction_of(r.vector(safe_divide(v, scale)));
    default: return r.vector(v * scale) + location;
  }
}

Vec3 node_vector_rotate(int mode, const Vec3 &v, const Vec3 &center, const Vec3 &axis_in, float angle, const Vec3 &rotation,
                        bool invert) {
  const Vec3 d = v - center;
  if (mode == OPAL_ROTATE_EULER) {
    const Transform r = euler_rotation(rotation);
    return (invert ? r.transposed_vector(d) : r.vector(d)) + center;
  }
  Vec3 axis = axis_in;
  if (mode != OPAL_ROTATE_AXIS_ANGLE)
    axis = {float(mode == OPAL_ROTATE_X), float(mode == OPAL_ROTATE_Y), float(mode == OPAL_ROTATE_Z)};
  const float l = length(axis);
  if (l == 0) return v;
  axis = axis / l;
  const float c = std::cos(angle), s = invert ? -std::sin(angle) : std::sin(angle);
  // Rodrigues' rotation formula.
  return d * c + cross(axis, d) * s + axis * (dot(axis, d) * (1 - c)) + center;
}

}  // namespace opal
