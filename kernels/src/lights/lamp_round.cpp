// SPDX-License-Identifier: GPL-3.0-or-later
// See lamp_round.h. Spheres are sampled in the cone they fill (Shirley, Wang & Zimmerman 1996).
#include "lights/lamp_round.h"

#include "lights/directions.h"

namespace opal {

float spot_attenuation(const LampModel &lamp, const Vec3 &d) {
  if (lamp.type != OPAL_LIGHT_SPOT) return 1;
  const Vec3 local = lamp.to_local.vector(d);
  const float cosine = -local.z / length(local);
  const float x = saturate((cosine - lamp.cos_half) * lamp.inverse_blend);
  return x * x * (3 - 2 * x);
}

bool sample_round(const LampModel &lamp, const Vec3 &p, Vec2 u, LampSample &out) {
  const Vec3 to_lamp = lamp.position - p;
  const float d2 = length_squared(to_lamp), d = std::sqrt(d2), r2 = sqr(lamp.radius);
  if (!(d > 0)) return false;
  const Vec3 axis = to_lamp / d;

  if (lamp.radius <= 0) {
    out.wi = axis, out.distance = d, out.pdf = 1, out.dirac = true;
    out.value = lamp.intensity / d2 * spot_attenuation(lamp, -axis);
    return out.value != 0;
  }
  out.dirac = false;
  if (!lamp.sphere) {
    const Frame frame = Frame::from_z(axis);
    const Vec2 q = sample_disc(u);
    const Vec3 to_point = to_lamp + (frame.x * q.x + frame.y * q.y) * lamp.radius;
    out.distance = length(to_point);
    out.wi = to_point / out.distance;
  } else if (d2 > r2) {
    const float omc = one_minus_cos_from_sin2(r2 / d2);
    out.wi = normalize(sample_cone(Frame::from_z(axis), omc, u));
    const float cosine = dot(out.wi, axis);
    out.distance = d * cosine - safe_sqrt(r2 - length_squared(to_lamp - out.wi * (d * cosine)));
  } else {
    out.wi = sample_sphere(u);
    const float along = dot(to_lamp, out.wi);
    out.distance = along + safe_sqrt(r2 - d2 + along * along);
  }
  out.value = lamp.radiance * (lamp.sphere && d2 <= r2 ? 1.0f : spot_attenuation(lamp, -out.wi));
  out.pdf = pdf_round(lamp, p, out.wi, out.distance);
  return out.value != 0 && out.pdf > 0;
}

float pdf_round(const LampModel &lamp, const Vec3 &p, const Vec3 &wi, float distance) {
  const Vec3 to_lamp = lamp.position - p;
  const float d2 = length_squared(to_lamp), r2 = sqr(lamp.radius);
  if (lamp.sphere) return d2 > r2 ? 1 / cone_solid_angle(one_minus_cos_from_sin2(r2 / d2)) : 1 / kFourPi;
  const float cosine = dot(to_lamp, wi) / std::sqrt(d2);
  return cosine > 0 ? sqr(distance) / (cosine * kPi * r2) : 0.0f;
}

bool hit_round(const LampModel &lamp, const Ray &ray, float t_after, float t_max, float &t, Vec3 &normal, float &radiance) {
  const Vec3 to_lamp = lamp.position - ray.origin;
  const float d2 = length_squared(to_lamp), r2 = sqr(lamp.radius);
  const float along = dot(to_lamp, ray.direction);
  if (lamp.type == OPAL_LIGHT_SPOT && along <= 0) return false;  // seen from behind the centre a spot is nothing
  const bool inside = lamp.sphere && d2 <= r2;
  if (lamp.sphere) {
    const float miss2 = length_squared(to_lamp - ray.direction * along);
    if (miss2 > r2) return false;
    t = inside ? along + safe_sqrt(r2 - miss2) : along - safe_sqrt(r2 - miss2);
  } else {
    if (along <= 0) return false;
    t = d2 / along;  // the plane through the centre that faces the ray's origin
    if (length_squared(ray.direction * t - to_lamp) > r2) return false;
  }
  if (!(t > t_after && t < t_max)) return false;
  normal = lamp.sphere ? safe_normalize(ray.direction * t - to_lamp, -ray.direction) : safe_normalize(-to_lamp, -ray.direction);
  radiance = lamp.radiance * (inside ? 1.0f : spot_attenuation(lamp, -ray.direction));
  return radiance != 0;
}

}  // namespace opal
