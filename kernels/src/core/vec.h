// SPDX-License-Identifier: GPL-3.0-or-later
// Three-vectors, 3x4 affine transforms and orthonormal frames. Single precision, value types.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace opal {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInfinity = __builtin_huge_valf();

struct Vec2 {
  float x = 0, y = 0;
};

struct Vec3 {
  float x = 0, y = 0, z = 0;

  constexpr float operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  constexpr float &operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr Vec3 operator-() const { return {-x, -y, -z}; }
  constexpr Vec3 &operator+=(const Vec3 &b) { return *this = {x + b.x, y + b.y, z + b.z}; }
  constexpr Vec3 &operator-=(const Vec3 &b) { return *this = {x - b.x, y - b.y, z - b.z}; }
  constexpr Vec3 &operator*=(float s) { return *this = {x * s, y * s, z * s}; }
  constexpr Vec3 &operator*=(const Vec3 &b) { return *this = {x * b.x, y * b.y, z * b.z}; }
  constexpr bool operator==(const Vec3 &) const = default;
};

constexpr Vec3 operator+(Vec3 a, const Vec3 &b) { return a += b; }
constexpr Vec3 operator-(Vec3 a, const Vec3 &b) { return a -= b; }
constexpr Vec3 operator*(Vec3 a, float s) { return a *= s; }
constexpr Vec3 operator*(float s, Vec3 a) { return a *= s; }
constexpr Vec3 operator*(Vec3 a, const Vec3 &b) { return a *= b; }
constexpr Vec3 operator/(const Vec3 &a, float s) { return {a.x / s, a.y / s, a.z / s}; }

constexpr float dot(const Vec3 &a, const Vec3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(const Vec3 &a, const Vec3 &b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr float length_squared(const Vec3 &a) { return dot(a, a); }
inline float length(const Vec3 &a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalize(const Vec3 &a) { return a / length(a); }
// Unit vector along a, or `fallback` where a has no direction.
inline Vec3 safe_normalize(const Vec3 &a, const Vec3 &fallback) {
  const float l = length(a);
  return l > 0 && std::isfinite(l) ? a / l : fallback;
}
constexpr Vec3 reflect(const Vec3 &w, const Vec3 &n) { return 2 * dot(w, n) * n - w; }
constexpr Vec3 lerp(const Vec3 &a, const Vec3 &b, float t) { return a * (1 - t) + b * t; }
// Between equals exactly their value: a constant table of indices must not look dispersive by its last bit.
constexpr float lerp(float a, float b, float t) { return a + (b - a) * t; }
constexpr Vec3 min(const Vec3 &a, const Vec3 &b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
constexpr Vec3 max(const Vec3 &a, const Vec3 &b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
constexpr float max_component(const Vec3 &a) { return std::max(a.x, std::max(a.y, a.z)); }
constexpr float average(const Vec3 &a) { return (a.x + a.y + a.z) * (1.0f / 3.0f); }
constexpr float luminance(const Vec3 &rgb) { return 0.2126729f * rgb.x + 0.7151522f * rgb.y + 0.0721750f * rgb.z; }
inline bool is_finite(const Vec3 &a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
constexpr float clamp(float x, float low, float high) { return x < low ? low : x > high ? high : x; }
constexpr float saturate(float x) { return clamp(x, 0.0f, 1.0f); }
constexpr float sqr(float x) { return x * x; }
inline float safe_sqrt(float x) { return x > 0 ? std::sqrt(x) : 0.0f; }

// Row-major 3x4 affine transform.
struct Transform {
  float m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  constexpr Vec3 point(const Vec3 &p) const {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
            m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
  }
  constexpr Vec3 vector(const Vec3 &v) const {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z, m[8] * v.x + m[9] * v.y + m[10] * v.z};
  }
  // For normals: multiplies by the transpose, so call it on the inverse transform.
  constexpr Vec3 transposed_vector(const Vec3 &v) const {
    return {m[0] * v.x + m[4] * v.y + m[8] * v.z, m[1] * v.x + m[5] * v.y + m[9] * v.z, m[2] * v.x + m[6] * v.y + m[10] * v.z};
  }
  constexpr Vec3 axis(int i) const { return {m[i], m[4 + i], m[8 + i]}; }
  constexpr Vec3 origin() const { return axis(3); }
  constexpr float determinant() const { return dot(axis(0), cross(axis(1), axis(2))); }
};

// The inverse; a singular transform gives zeros (and nothing is hit through it).
constexpr Transform inverse(const Transform &t) {
  const Vec3 a = t.axis(0), b = t.axis(1), c = t.axis(2), o = t.origin();
  const float det = t.determinant();
  const float s = det != 0 ? 1 / det : 0;
  const Vec3 r0 = cross(b, c) * s, r1 = cross(c, a) * s, r2 = cross(a, b) * s;
  return {{r0.x, r0.y, r0.z, -dot(r0, o), r1.x, r1.y, r1.z, -dot(r1, o), r2.x, r2.y, r2.z, -dot(r2, o)}};
}

constexpr Transform lerp(const Transform &a, const Transform &b, float t) {
  Transform r;
  for (int i = 0; i < 12; ++i) r.m[i] = lerp(a.m[i], b.m[i], t);
  return r;
}

// Right-handed orthonormal frame around z (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
struct Frame {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  static Frame from_z(const Vec3 &n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }
  // x as close to `t` as a perpendicular of n can be.
  static Frame from_zx(const Vec3 &n, const Vec3 &t) {
    const Vec3 x = t - n * dot(n, t);
    const float l2 = length_squared(x);
    if (!(l2 > 1e-12f * length_squared(t))) return from_z(n);
    const Vec3 xn = x / std::sqrt(l2);
    return {xn, cross(n, xn), n};
  }
  constexpr Vec3 to_local(const Vec3 &v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  constexpr Vec3 to_world(const Vec3 &v) const { return x * v.x + y * v.y + z * v.z; }
};

// Where faces coincide: which of them a path has crossed there already (scene/contact.h). Faces of one instance that look the
// same way are one, and those that look the other way another: cubes of one mesh that touch.
struct Contact {
  static constexpr int kMost = 16;
  uint32_t crossed[kMost] = {};  // as face() numbers them, met forwards
  int count = 0;
  bool backward = false;  // after a reflection: what was crossed is met again from behind, and nothing else
  float until = 0;        // up to this distance along the ray; 0: no contact

  // back: the ray meets it from behind.
  uint32_t face(uint32_t instance, bool back) const { return instance << 1 | uint32_t(back != backward); }
  int find(uint32_t instance, bool back) const {
    const uint32_t wanted = face(instance, back);
    for (int i = 0; i < count; ++i)
      if (crossed[i] == wanted) return i;
    return -1;
  }
  bool meets(uint32_t instance, bool back) const { return (find(instance, back) >= 0) == backward; }
};

struct Ray {
  Vec3 origin, direction;  // direction is of unit length
  float t_min = 0, t_max = kInfinity;
  float time = 0;  // 0 at shutter open, 1 at close
  Contact contact = {};
};

struct Bounds {
  Vec3 low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};

  void extend(const Vec3 &p) { low = min(low, p), high = max(high, p); }
  void extend(const Bounds &b) { low = min(low, b.low), high = max(high, b.high); }
  bool empty() const { return !(low.x <= high.x); }
  bool contains(const Vec3 &p) const {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
  }
  Vec3 centre() const { return (low + high) * 0.5f; }
  float radius() const { return empty() ? 0.0f : 0.5f * length(high - low); }
};

}  // namespace opal
