// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader/image_lookup.h"

#include "shader/colour_nodes.h"

namespace opal {
namespace {

Float4 texel(const Image &image, int x, int y) {
  const size_t first = (size_t(y) * size_t(image.width) + size_t(x)) * size_t(image.channels);
  float c[4] = {0, 0, 0, 1};
  if (image.pixel_type == OPAL_PIXEL_U8) {
    for (int i = 0; i < image.channels; ++i) c[i] = float(image.bytes[first + size_t(i)]) * (1 / 255.0f);
  } else {
    for (int i = 0; i < image.channels; ++i) c[i] = image.floats[first + size_t(i)];
  }
  if (image.channels == 1) c[1] = c[2] = c[0];
  return {c[0], c[1], c[2], c[3]};
}

// The pixel that stands for index i of a row of n, or -1 for none.
int wrap(int i, int n, int extension) {
  switch (extension) {
    case OPAL_EXTEND_EDGE: return std::clamp(i, 0, n - 1);
    case OPAL_EXTEND_CLIP: return i < 0 || i >= n ? -1 : i;
    case OPAL_EXTEND_MIRROR: {
      const int m = (i < 0 ? -(i + 1) : i) % (2 * n);
      return m >= n ? 2 * n - 1 - m : m;
    }
    default: {
      const int m = i % n;
      return m < 0 ? m + n : m;
    }
  }
}

struct Tap {
  int index[4];
  float weight[4];
  int count;
};

// The pixels of one axis that a filter mixes.
Tap taps(float x, int n, const ImageSettings &s) {
  Tap t{};
  const float centred = s.interpolation == OPAL_INTERPOLATE_CLOSEST ? x : x - 0.5f;
  const float whole = std::floor(centred), f = centred - whole;
  const int i = int(whole);
  int first = i;
  switch (s.interpolation) {
    case OPAL_INTERPOLATE_CLOSEST:
      t.count = 1;
      t.weight[0] = 1;
      break;
    case OPAL_INTERPOLATE_CUBIC: {
      t.count = 4, first = i - 1;
      const float g = 1 - f;
      t.weight[0] = g * g * g * (1 / 6.0f);
      t.weight[1] = (4 + f * f * (3 * f - 6)) * (1 / 6.0f);
      t.weight[2] = (4 + g * g * (3 * g - 6)) * (1 / 6.0f);
      t.weight[3] = f * f * f * (1 / 6.0f);
      break;
    }
    default: t.count = 2; t.weight[0] = 1 - f, t.weight[1] = f;
  }
  for (int k = 0; k < t.count; ++k) t.index[k] = wrap(first + k, n, s.extension);
  return t;
}

// Keeps coordinates where float -> int is defined; nothing is lost, pixels that far away have no position left.
float bounded(float x) { return std::isfinite(x) ? clamp(x, -1e6f, 1e6f) : 0.0f; }

}  // namespace

Float4 lookup_image(const Image &image, const ImageSettings &s, float u, float v) {
  if (image.width <= 0 || image.height <= 0) return {};
  u = bounded(u), v = bounded(v);
  if (s.extension == OPAL_EXTEND_REPEAT) u -= std::floor(u), v -= std::floor(v);
  const Tap tx = taps(clamp(u * float(image.width), -1e9f, 1e9f), image.width, s);
  const Tap ty = taps(clamp(v * float(image.height), -1e9f, 1e9f), image.height, s);
  Float4 c{};
  for (int j = 0; j < ty.count; ++j) {
    if (ty.index[j] < 0) continue;
    Float4 row{};
    for (int i = 0; i < tx.count; ++i)
      if (tx.index[i] >= 0) row = row + tx.weight[i] * texel(image, tx.index[i], ty.index[j]);
    c = c + ty.weight[j] * row;
  }
  if (s.flags & OPAL_IMAGE_IGNORE_ALPHA) c.w = 1;
  if ((s.flags & OPAL_IMAGE_UNASSOCIATE_ALPHA) && c.w != 0 && c.w != 1) c = {c.x / c.w, c.y / c.w, c.z / c.w, c.w};
  if (image.transfer == OPAL_TRANSFER_SRGB) c = {srgb_to_linear(c.x), srgb_to_linear(c.y), srgb_to_linear(c.z), c.w};
  return c;
}

Vec2 project_sphere(const Vec3 &p) {
  const Vec3 d = (p - Vec3{0.5f, 0.5f, 0.5f}) * 2;
  const float l = length(d);
  if (!(l > 0)) return {};
  return {d.x == 0 && d.y == 0 ? 0.0f : 0.5f - std::atan2(d.x, d.y) / (2 * kPi), 1 - std::acos(clamp(d.z / l, -1, 1)) * kInvPi};
}

Vec2 project_tube(const Vec3 &p) {
  const Vec3 d = (p - Vec3{0.5f, 0.5f, 0.5f}) * 2;
  if (d.x == 0 && d.y == 0) return {};
  return {(1 - std::atan2(d.x, d.y) * kInvPi) * 0.5f, (d.z + 1) * 0.5f};
}

Vec2 project_equirectangular(const Vec3 &direction) {
  const float l = length(direction);
  if (!(l > 0)) return {};
  return {0.5f - std::atan2(direction.y, direction.x) / (2 * kPi), 1 - std::acos(clamp(direction.z / l, -1, 1)) * kInvPi};
}

Vec2 project_mirror_ball(const Vec3 &direction) {
  Vec3 d = safe_normalize(direction, {0, 1, 0});
  d.y -= 1;
  const float divisor = 2 * safe_sqrt(-0.5f * d.y);
  if (divisor > 0) d = d / divisor;
  return {0.5f * (d.x + 1), 0.5f * (d.z + 1)};
}

Vec3 box_weights(const Vec3 &normal, float blend) {
  Vec3 n{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const float sum = n.x + n.y + n.z;
  if (!(sum > 0)) return {1, 0, 0};
  n = n / sum;
  const float limit = 0.5f * (1 + blend);
  const auto rules = [limit](float a, float b, float c) { return a > limit * (a + b) && a > limit * (a + c); };
  if (rules(n.x, n.y, n.z)) return {1, 0, 0};
  if (rules(n.y, n.x, n.z)) return {0, 1, 0};
  if (rules(n.z, n.x, n.y)) return {0, 0, 1};
  if (!(blend > 0)) return {1, 0, 0};
  // Between two planes (the third is far), or among all three.
  const auto share = [blend](float a, float b) { return saturate((a / (a + b) - 0.5f * (1 - blend)) / blend); };
  if (n.z < (1 - limit) * (n.y + n.x)) {
    const float s = share(n.x, n.y);
    return {s, 1 - s, 0};
  }
  if (n.x < (1 - limit) * (n.y + n.z)) {
    const float s = share(n.y, n.z);
    return {0, s, 1 - s};
  }
  if (n.y < (1 - limit) * (n.x + n.z)) {
    const float s = share(n.x, n.z);
    return {s, 0, 1 - s};
  }
  const float divisor = 2 * limit - 1;
  return (n * (2 - limit) + Vec3{1, 1, 1} * (limit - 1)) / divisor;
}

}  // namespace opal
