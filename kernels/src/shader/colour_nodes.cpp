// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader/colour_nodes.h"

namespace opal {
namespace {

Vec3 mix(const Vec3 &a, const Vec3 &b, float t) { return a * (1 - t) + b * t; }
constexpr Vec3 kOne{1, 1, 1};

template <class F>
Vec3 each(const Vec3 &a, const Vec3 &b, F f) {
  return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}

float overlay(float a, float b, float t) {
  return a < 0.5f ? a * (1 - t + 2 * t * b) : 1 - (1 - t + 2 * t * (1 - b)) * (1 - a);
}
float divide(float a, float b, float t) { return b != 0 ? (1 - t) * a + t * a / b : a; }
float dodge(float a, float b, float t) {
  if (a == 0) return 0;
  const float d = 1 - t * b;
  return d <= 0 ? 1.0f : std::min(a / d, 1.0f);
}
float burn(float a, float b, float t) {
  const float d = 1 - t + t * b;
  return d <= 0 ? 0.0f : saturate(1 - (1 - a) / d);
}

}  // namespace

Vec3 rgb_to_hsv(const Vec3 &c) {
  const float high = max_component(c), low = std::min(c.x, std::min(c.y, c.z)), range = high - low;
  const float s = high != 0 ? range / high : 0.0f;
  if (s == 0) return {0, 0, high};
  const Vec3 d = (Vec3{high, high, high} - c) / range;
  float h = c.x == high ? d.z - d.y : c.y == high ? 2 + d.x - d.z : 4 + d.y - d.x;
  h /= 6;
  return {h < 0 ? h + 1 : h, s, high};
}

Vec3 hsv_to_rgb(const Vec3 &c) {
  if (c.y == 0) return {c.z, c.z, c.z};
  const float h = (c.x == 1 ? 0.0f : c.x) * 6, sextant = std::floor(h), f = h - sextant;
  const float v = c.z, p = v * (1 - c.y), q = v * (1 - c.y * f), t = v * (1 - c.y * (1 - f));
  if (sextant == 0) return {v, t, p};
  if (sextant == 1) return {q, v, p};
  if (sextant == 2) return {p, v, t};
  if (sextant == 3) return {p, q, v};
  if (sextant == 4) return {t, p, v};
  return {v, p, q};
}

Vec3 rgb_to_hsl(const Vec3 &c) {
  const float high = max_component(c), low = std::min(c.x, std::min(c.y, c.z)), range = high - low;
  const float l = std::min(1.0f, (high + low) / 2);
  if (range == 0) return {0, 0, l};
  const float s = range / (l > 0.5f ? 2 - high - low : high + low);
  const float h = high == c.x   ? (c.y - c.z) / range + (c.y < c.z ? 6.0f : 0.0f)
                  : high == c.y ? (c.z - c.x) / range + 2
                                : (c.x - c.y) / range + 4;
  return {h / 6, s, l};
}

Vec3 hsl_to_rgb(const Vec3 &c) {
  const float h = c.x * 6, chroma = (1 - std::abs(2 * c.z - 1)) * c.y;
  const Vec3 hue{saturate(std::abs(h - 3) - 1), saturate(2 - std::abs(h - 2)), saturate(2 - std::abs(h - 4))};
  return (hue - 0.5f * kOne) * chroma + Vec3{c.z, c.z, c.z};
}

Vec3 blend(int mode, float t, const Vec3 &a, const Vec3 &b) {
  switch (mode) {
    case OPAL_MIX_DARKEN: return mix(a, min(a, b), t);
    case OPAL_MIX_MULTIPLY: return a * (kOne * (1 - t) + t * b);
    case OPAL_MIX_BURN: return each(a, b, [t](float x, float y) { return burn(x, y, t); });
    case OPAL_MIX_LIGHTEN: return mix(a, max(a, b), t);
    case OPAL_MIX_SCREEN: return kOne - (kOne * (1 - t) + t * (kOne - b)) * (kOne - a);
    case OPAL_MIX_DODGE: return each(a, b, [t](float x, float y) { return dodge(x, y, t); });
    case OPAL_MIX_ADD: return a + t * b;
    case OPAL_MIX_OVERLAY: return each(a, b, [t](float x, float y) { return overlay(x, y, t); });
    case OPAL_MIX_SOFT_LIGHT: {
      const Vec3 screen = kOne - (kOne - b) * (kOne - a);
      return mix(a, (kOne - a) * b * a + a * screen, t);
    }
    case OPAL_MIX_LINEAR_LIGHT: return a + t * (2 * b - kOne);
    case OPAL_MIX_DIFFERENCE: return mix(a, each(a, b, [](float x, float y) { return std::abs(x - y); }), t);
    case OPAL_MIX_EXCLUSION: return max(mix(a, a + b - 2 * (a * b), t), Vec3{});
    case OPAL_MIX_SUBTRACT: return a - t * b;
    case OPAL_MIX_DIVIDE: return each(a, b, [t](float x, float y) { return divide(x, y, t); });
    case OPAL_MIX_HUE: {
      const Vec3 h = rgb_to_hsv(b);
      if (h.y == 0) return a;
      const Vec3 own = rgb_to_hsv(a);
      return mix(a, hsv_to_rgb({h.x, own.y, own.z}), t);
    }
    case OPAL_MIX_SATURATION: {
      const Vec3 own = rgb_to_hsv(a);
      return own.y == 0 ? a : hsv_to_rgb({own.x, lerp(own.y, rgb_to_hsv(b).y, t), own.z});
    }
    case OPAL_MIX_COLOR: {
      const Vec3 h = rgb_to_hsv(b);
      return h.y == 0 ? a : mix(a, hsv_to_rgb({h.x, h.y, rgb_to_hsv(a).z}), t);
    }
    case OPAL_MIX_VALUE: {
      const Vec3 own = rgb_to_hsv(a);
      return hsv_to_rgb({own.x, own.y, lerp(own.z, rgb_to_hsv(b).z, t)});
    }
    default: return mix(a, b, t);
  }
}

Vec3 hue_saturation(float factor, const Vec3 &color, float hue, float saturation, float value) {
  Vec3 c = rgb_to_hsv(color);
  const float h = c.x + hue + 0.5f;
  c = {h - std::floor(h), saturate(c.y * saturation), c.z * value};
  return max(mix(color, hsv_to_rgb(c), factor), Vec3{});
}

Vec3 gamma_correct(const Vec3 &color, float gamma) {
  if (gamma == 0) return kOne;
  return each(color, {}, [gamma](float c, float) { return c > 0 ? std::pow(c, gamma) : c; });
}

Vec3 bright_contrast(const Vec3 &color, float bright, float contrast) {
  const float offset = bright - contrast * 0.5f;
  return max(color * (1 + contrast) + Vec3{offset, offset, offset}, Vec3{});
}

float srgb_to_linear(float c) {
  if (c < 0.04045f) return c < 0 ? 0.0f : c * (1 / 12.92f);
  return std::pow((c + 0.055f) * (1 / 1.055f), 2.4f);
}

}  // namespace opal
