// SPDX-License-Identifier: GPL-3.0-or-later
// Decomposition and interpolation of transforms. Conventions in motion.h.
#include "core/motion.h"

namespace opal {
namespace {

// Of a right-handed rotation with columns x, y, z; from its largest component (Shepperd 1978).
Quaternion quaternion_from(const Vec3 &x, const Vec3 &y, const Vec3 &z) {
  const float trace = x.x + y.y + z.z;
  Quaternion q;
  if (trace > x.x && trace > y.y && trace > z.z) q = {1 + trace, y.z - z.y, z.x - x.z, x.y - y.x};
  else if (x.x > y.y && x.x > z.z) q = {y.z - z.y, 1 + x.x - y.y - z.z, y.x + x.y, z.x + x.z};
  else if (y.y > z.z) q = {z.x - x.z, y.x + x.y, 1 - x.x + y.y - z.z, z.y + y.z};
  else q = {x.y - y.x, z.x + x.z, z.y + y.z, 1 - x.x - y.y + z.z};
  return normalize(q);
}

DecomposedTransform decompose(const Transform &t) {
  DecomposedTransform d;
  d.translation = t.origin();
  Vec3 x = t.axis(0), y = t.axis(1), z = t.axis(2);
  d.scale.x = length(x), x = x / d.scale.x;
  d.skew.x = dot(x, y), y -= x * d.skew.x;
  d.scale.y = length(y), y = y / d.scale.y;
  d.skew.y = dot(x, z), z -= x * d.skew.y;
  d.skew.z = dot(y, z), z -= y * d.skew.z;
  d.scale.z = length(z), z = z / d.scale.z;
  if (dot(cross(x, y), z) < 0) {  // a mirror image: only turns are quaternions
    x = -x, y = -y, z = -z;
    d.scale = -d.scale, d.skew = -d.skew;
  }
  d.rotation = quaternion_from(x, y, z);
  return d;
}

Transform compose(const DecomposedTransform &d) {
  const auto [r, i, j, k] = d.rotation;
  const Vec3 x{1 - 2 * (j * j + k * k), 2 * (i * j + r * k), 2 * (i * k - r * j)};
  const Vec3 y{2 * (i * j - r * k), 1 - 2 * (i * i + k * k), 2 * (j * k + r * i)};
  const Vec3 z{2 * (i * k + r * j), 2 * (j * k - r * i), 1 - 2 * (i * i + j * j)};
  const Vec3 a = x * d.scale.x, b = x * d.skew.x + y * d.scale.y, c = x * d.skew.y + y * d.skew.z + z * d.scale.z;
  const Vec3 &o = d.translation;
  return {{a.x, b.x, c.x, o.x, a.y, b.y, c.y, o.y, a.z, b.z, c.z, o.z}};
}

// Embree's own formula and threshold, for a point must be shaded where Embree hit it.
Quaternion slerp(const Quaternion &a, const Quaternion &b, float t) {
  const float cosine = dot(a, b);
  if (cosine > 0.9995f) return normalize(a * (1 - t) + b * t);
  const float angle = t * std::acos(clamp(cosine, -1.0f, 1.0f));
  return a * std::cos(angle) + normalize(b + a * -cosine) * std::sin(angle);
}

}  // namespace

Motion::Motion(const Transform &open, const Transform &middle, const Transform &close)
    : keys{decompose(open), decompose(middle), decompose(close)} {
  for (int i = 1; i < kKeys; ++i)
    if (dot(keys[i - 1].rotation, keys[i].rotation) < 0) keys[i].rotation = keys[i].rotation * -1;
}

Transform Motion::at(float time) const {
  const float steps = time * float(kKeys - 1);
  const int i = std::clamp(int(steps), 0, kKeys - 2);
  const float t = steps - float(i);
  const DecomposedTransform &a = keys[i], &b = keys[i + 1];
  return compose({a.rotation == b.rotation ? a.rotation : slerp(a.rotation, b.rotation, t),
                  lerp(a.translation, b.translation, t), lerp(a.scale, b.scale, t), lerp(a.skew, b.skew, t)});
}

Bounds Motion::path(const Vec3 &local) const {
  // Between two keys the turn is half a circle at most. An arc of angle d rises over its chord by chord * tan(d / 4) / 2:
  // by less than a fortieth for a sixteenth of that, and a twentieth leaves room for place and scale that change with it.
  const int steps = turns() ? 16 * (kKeys - 1) : kKeys - 1;
  Bounds b;
  Vec3 before = at(0).point(local);
  b.extend(before);
  for (int i = 1; i <= steps; ++i) {
    const Vec3 p = at(float(i) / float(steps)).point(local);
    const float rise = turns() ? length(p - before) * 0.05f : 0;
    const Vec3 r{rise, rise, rise};
    for (const Vec3 &q : {before, p}) b.extend(q - r), b.extend(q + r);
    before = p;
  }
  return b;
}

}  // namespace opal
