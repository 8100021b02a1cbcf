// SPDX-License-Identifier: GPL-3.0-or-later
// Thin-lens camera, perspective and orthographic. Conventions in camera.h.
#include "camera/camera.h"

#include "core/motion.h"

#include <cstring>

namespace opal {
namespace {

Transform from_array(const float (&m)[12]) {
  Transform t;
  std::memcpy(t.m, m, sizeof m);
  return t;
}

Vec2 uniform_disc(Vec2 u) {
  // Concentric map (Shirley & Chiu 1997): keeps the stratification of u.
  const float x = 2 * u.x - 1, y = 2 * u.y - 1;
  if (x == 0 && y == 0) return {0, 0};
  const bool wide = std::abs(x) > std::abs(y);
  const float r = wide ? x : y;
  const float angle = wide ? kPi / 4 * (y / x) : kPi / 2 - kPi / 4 * (x / y);
  return {r * std::cos(angle), r * std::sin(angle)};
}

Vec2 uniform_polygon(int corners, float rotation, Vec2 u) {
  const float side = std::min(std::floor(u.x * float(corners)), float(corners - 1));
  // Uniform in the triangle (centre, corner, next corner): `root` of the way out, then anywhere across.
  const float root = std::sqrt(saturate(u.x * float(corners) - side));
  const float half = kPi / float(corners);
  const float px = root * std::cos(half), py = root * std::sin(half) * (2 * u.y - 1);
  const float angle = rotation + (2 * side + 1) * half;
  const float c = std::cos(angle), s = std::sin(angle);
  return {c * px - s * py, s * px + c * py};
}

float window_area(const opal_camera_desc &camera) {
  return (camera.window[1] - camera.window[0]) * (camera.window[3] - camera.window[2]);
}

}  // namespace

Vec2 sample_aperture(const opal_camera_desc &camera, Vec2 u) {
  Vec2 p = camera.blades < 3 ? uniform_disc(u) : uniform_polygon(camera.blades, camera.blade_rotation, u);
  if (camera.aperture_ratio > 0) p.x /= camera.aperture_ratio;
  return p;
}

Transform camera_transform(const opal_camera_desc &camera, float time) {
  const auto same = [&](const float (&m)[12]) { return std::memcmp(camera.transform, m, sizeof m) == 0; };
  if (same(camera.transform_start) && same(camera.transform_end)) return from_array(camera.transform);
  return Motion(from_array(camera.transform_start), from_array(camera.transform), from_array(camera.transform_end)).at(time);
}

bool generate_ray(const opal_camera_desc &camera, float x, float y, Vec2 lens, float time, Ray &ray) {
  const float *w = camera.window;
  const float wx = lerp(w[0], w[1], x), wy = lerp(w[2], w[3], y);
  const bool perspective = camera.type == OPAL_CAMERA_PERSPECTIVE;
  // Camera space with the axis along +Z: mirrored on the way out.
  Vec3 origin = perspective ? Vec3{} : Vec3{wx, wy, 0};
  Vec3 direction = perspective ? Vec3{wx, wy, 1} : Vec3{0, 0, 1};
  if (camera.aperture_radius > 0) {
    const Vec2 a = sample_aperture(camera, lens);
    const Vec3 offset{a.x * camera.aperture_radius, a.y * camera.aperture_radius, 0};
    const float focus = std::max(camera.focus_distance, 1e-5f);
    direction = direction * focus - offset;
    origin += offset;
  }
  direction = normalize(direction);
  const float per_z = 1 / direction.z;
  const Transform t = camera_transform(camera, time);
  ray.origin = t.point({origin.x, origin.y, -origin.z});
  ray.direction = safe_normalize(t.vector({direction.x, direction.y, -direction.z}), Vec3{});
  ray.t_min = camera.clip_start * per_z;
  ray.t_max = camera.clip_end * per_z;
  ray.time = time;
  if (!perspective) {  // clip_start may lie behind the plane of the camera (viewports)
    ray.origin += ray.direction * ray.t_min;
    ray.t_max -= ray.t_min;
    ray.t_min = 0;
  }
  return is_finite(ray.origin) && is_finite(ray.direction) && length_squared(ray.direction) > 0;
}

bool connect(const opal_camera_desc &camera, const Vec3 &p, Vec2 lens, float time, CameraConnection &out, float margin_x,
             float margin_y) {
  const Transform t = camera_transform(camera, time);
  Vec3 q = inverse(t).point(p);
  q.z = -q.z;
  if (!(q.z > camera.clip_start && q.z < camera.clip_end)) return false;
  const bool perspective = camera.type == OPAL_CAMERA_PERSPECTIVE;
  if (perspective && !(q.z > 0)) return false;
  Vec3 offset;
  const float focus = std::max(camera.focus_distance, 1e-5f);
  if (camera.aperture_radius > 0) {
    const Vec2 a = sample_aperture(camera, lens);
    offset = {a.x * camera.aperture_radius, a.y * camera.aperture_radius, 0};
  }
  Vec3 from_lens;  // towards p
  float wx, wy;
  if (perspective) {
    from_lens = q - offset;
    // Where the line crosses the plane in focus, scaled to distance 1; for a pinhole any plane will do.
    wx = offset.x / focus + from_lens.x / q.z;
    wy = offset.y / focus + from_lens.y / q.z;
  } else {
    from_lens = Vec3{-offset.x / focus, -offset.y / focus, 1} * q.z;
    wx = q.x - from_lens.x - offset.x;
    wy = q.y - from_lens.y - offset.y;
  }
  const float *w = camera.window;
  out.film_x = (wx - w[0]) / (w[1] - w[0]);
  out.film_y = (wy - w[2]) / (w[3] - w[2]);
  if (!(out.film_x >= -margin_x && out.film_x < 1 + margin_x && out.film_y >= -margin_y && out.film_y < 1 + margin_y))
    return false;
  const float d = length(from_lens);
  const float cosine = std::abs(from_lens.z) / d;
  out.lens_distance = q.z < 0 ? -d : d;
  out.distance = (q.z - camera.clip_start) / cosine;
  const float area = std::abs(window_area(camera));
  out.importance = perspective ? 1 / (area * cosine * cosine * cosine * d * d) : 1 / (area * cosine);
  const Vec3 back = from_lens * (q.z < 0 ? 1 / d : -1 / d);
  out.to_camera = t.vector({back.x, back.y, -back.z});
  return std::isfinite(out.importance);
}

}  // namespace opal
