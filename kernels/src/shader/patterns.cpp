// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader/patterns.h"

#include "shader/maths.h"
#include "shader/noise.h"

namespace opal {
namespace {

// Keeps whole coordinates, where faces often lie, off the edge between two cells.
Vec3 off_lattice(const Vec3 &p) { return (p + Vec3{1e-6f, 1e-6f, 1e-6f}) * 0.999999f; }

// float -> int32 without undefined behaviour for what does not fit.
int32_t to_int(float x) { return std::abs(x) < 2147483520.0f ? int32_t(x) : 0; }

// An integer hash in [0, 1): the linear congruence that Blender's bricks have always had.
float brick_random(uint32_t n) {
  n = (n + 1013u) & 0x7fffffffu;
  n = (n >> 13) ^ n;
  return float((n * (n * n * 60493u + 19990303u) + 1376312589u) & 0x7fffffffu) * 0.5f / 1073741824.0f;
}

}  // namespace

bool checker(const Vec3 &p) {
  const Vec3 q = off_lattice(p);
  const bool x = to_int(std::floor(q.x)) & 1, y = to_int(std::floor(q.y)) & 1, z = to_int(std::floor(q.z)) & 1;
  return (x == y) == z;
}

float wave(const Wave &w, const Vec3 &p_in) {
  const Vec3 p = off_lattice(p_in);
  float n;
  if (!w.rings) {
    n = w.direction < 3 ? p[w.direction] * 20 : (p.x + p.y + p.z) * 10;
  } else {
    Vec3 r = p;
    if (w.direction < 3) r[w.direction] = 0;
    n = length(r) * 20;
  }
  n += w.phase;
  if (w.distortion != 0) {
    Fractal f;
    f.detail = clamp(w.detail, 0, 15);
    f.roughness = w.detail_roughness;
    const Vec3 q = p * w.detail_scale;
    n += w.distortion * (fractal_noise<3>(f, {{q.x, q.y, q.z}}) * 2 - 1);
  }
  if (w.profile == 0) return 0.5f + 0.5f * std::sin(n - kPi / 2);
  n /= 2 * kPi;
  return w.profile == 1 ? n - std::floor(n) : std::abs(n - std::floor(n + 0.5f)) * 2;
}

Vec3 magic(const Vec3 &p, int depth, float distortion) {
  // Sines of sums do not change by whole turns; reducing first keeps large coordinates accurate.
  const float a = std::fmod(p.x, 2 * kPi), b = std::fmod(p.y, 2 * kPi), c = std::fmod(p.z, 2 * kPi);
  float x = std::sin((a + b + c) * 5), y = std::cos((-a + b - c) * 5), z = -std::cos((-a - b + c) * 5);
  const float d = distortion;
  if (depth > 0) {
    x *= d, y *= d, z *= d;
    y = -std::cos(x - y + z) * d;
  }
  if (depth > 1) x = std::cos(x - y - z) * d;
  if (depth > 2) z = std::sin(-x - y - z) * d;
  if (depth > 3) x = -std::cos(-x + y - z) * d;
  if (depth > 4) y = -std::sin(-x + y + z) * d;
  if (depth > 5) y = -std::cos(-x + y + z) * d;
  if (depth > 6) x = std::cos(x + y + z) * d;
  if (depth > 7) z = std::sin(x + y - z) * d;
  if (depth > 8) x = -std::cos(-x - y + z) * d;
  if (depth > 9) y = -std::sin(x - y + z) * d;
  if (d != 0) x /= 2 * d, y /= 2 * d, z /= 2 * d;
  return {0.5f - x, 0.5f - y, 0.5f - z};
}

BrickSample brick(const Brick &b, const Vec3 &p) {
  const int32_t row = to_int(std::floor(p.y / b.row_height));
  float width = b.width, offset = 0;
  if (b.offset_frequency && b.squash_frequency) {
    if (row % b.squash_frequency == 0) width *= b.squash;
    if (row % b.offset_frequency == 0) offset = width * b.offset;
  }
  const int32_t number = to_int(std::floor((p.x + offset) / width));
  const float x = p.x + offset - width * float(number), y = p.y - b.row_height * float(row);
  BrickSample s;
  s.tint = saturate(brick_random((uint32_t(row) << 16) + (uint32_t(number) & 0xFFFFu)) + b.bias);
  const float edge = std::min(std::min(x, y), std::min(width - x, b.row_height - y));
  s.mortar = edge >= b.mortar_size  ? 0.0f
             : b.mortar_smooth == 0 ? 1.0f
                                    : smoothstep01((1 - edge / b.mortar_size) / b.mortar_smooth);
  return s;
}

float gradient(int mode, const Vec3 &p) {
  // A little less than 1, so that points of a unit sphere give 0 whatever their rounding.
  const float sphere = std::max(0.999999f - length(p), 0.0f);
  switch (mode) {
    case OPAL_GRADIENT_QUADRATIC: return saturate(sqr(std::max(p.x, 0.0f)));
    case OPAL_GRADIENT_EASING: return smoothstep01(p.x);
    case OPAL_GRADIENT_DIAGONAL: return saturate((p.x + p.y) * 0.5f);
    case OPAL_GRADIENT_RADIAL: return saturate(std::atan2(p.y, p.x) / (2 * kPi) + 0.5f);
    case OPAL_GRADIENT_SPHERICAL: return saturate(sphere);
    case OPAL_GRADIENT_QUADRATIC_SPHERE: return saturate(sphere * sphere);
    default: return saturate(p.x);
  }
}

}  // namespace opal
