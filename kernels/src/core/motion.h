// SPDX-License-Identifier: GPL-3.0-or-later
// Motion within the shutter, of instances and of the camera: where they are at its opening, its middle and its close, and
// between those as Cycles and Embree have it, so that what turns keeps its size: turn, place and scale each by themselves.
//
// A transform is translation * rotation * scale, its scale an upper triangle (Gram and Schmidt's, on the columns) and its
// rotation a unit quaternion, which goes by the shorter great arc (Shoemake 1985) while all else goes straight.
#pragma once

#include "core/vec.h"

namespace opal {

// r + i I + j J + k K.
struct Quaternion {
  float r = 1, i = 0, j = 0, k = 0;

  constexpr Quaternion operator*(float s) const { return {r * s, i * s, j * s, k * s}; }
  constexpr Quaternion operator+(const Quaternion &b) const { return {r + b.r, i + b.i, j + b.j, k + b.k}; }
  constexpr bool operator==(const Quaternion &) const = default;
};

constexpr float dot(const Quaternion &a, const Quaternion &b) { return a.r * b.r + a.i * b.i + a.j * b.j + a.k * b.k; }
inline Quaternion normalize(const Quaternion &q) { return q * (1 / std::sqrt(dot(q, q))); }

struct DecomposedTransform {
  Quaternion rotation;
  Vec3 translation;
  Vec3 scale{1, 1, 1};  // the triangle's diagonal
  Vec3 skew;            // xy, xz and yz: what lies above it
};

struct Motion {
  static constexpr int kKeys = 3;

  DecomposedTransform keys[kKeys];

  // Transforms at the shutter's opening, middle and close, none of them singular.
  Motion(const Transform &open, const Transform &middle, const Transform &close);

  static constexpr float time_of(int key) { return float(key) / float(kKeys - 1); }
  // time: 0 at the opening, 1 at the close.
  Transform at(float time) const;
  // False where everything goes in straight lines between the keys.
  bool turns() const { return !(keys[0].rotation == keys[1].rotation && keys[1].rotation == keys[2].rotation); }
  // All that a point of the object passes.
  Bounds path(const Vec3 &local) const;
};

// Between values at the keys that go straight: vertices.
inline Vec3 between(const Vec3 &open, const Vec3 &middle, const Vec3 &close, float time) {
  return time < 0.5f ? lerp(open, middle, 2 * time) : lerp(middle, close, 2 * time - 1);
}

}  // namespace opal
