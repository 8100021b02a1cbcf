// SPDX-License-Identifier: GPL-3.0-or-later
// See opal_test_lights.h.
#include "opal_test_lights.h"

#include "camera/camera.h"
#include "scene/scene.h"

#include <cmath>

struct opal_scene : opal::Scene {};

namespace {

using namespace opal;

constexpr int kSets = 8;  // of kWavelengths each

struct AllWavelengths {
  Wavelengths sets[kSets];
  explicit AllWavelengths(const ColourTables &colour) {
    for (int i = 0; i < kSets; ++i) sets[i] = colour.sample((float(i) + 0.5f) / (kSets * kWavelengths));
  }
};

// Calls ask(wavelengths) for the spectrum at each set and integrates it to RGB.
template <class Ask>
Vec3 integrate(const AllWavelengths &all, const Ask &ask) {
  Vec3 rgb;
  for (const Wavelengths &w : all.sets) rgb += to_rgb(ask(w), w) * (1.0f / kSets);
  return rgb;
}

Vec3 load(const float *v) { return {v[0], v[1], v[2]}; }
void store(const Vec3 &v, float *out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }
void store(const SourceId &id, int32_t *out) {
  out[0] = id.kind == SourceKind::None ? -1 : int32_t(id.kind), out[1] = int32_t(id.index);
}

}  // namespace

extern "C" {

int32_t opal_test_sample_light(const opal_scene *scene, const opal_test_receiver *r, int64_t n, const float *numbers,
                               float *direction, float *distance, float *radiance, float *pdf, int32_t *dirac,
                               int32_t *source) {
  if (!scene || !scene->lights || !r) return OPAL_ERROR_ARGUMENT;
  const AllWavelengths all(scene->colour);
  for (int64_t i = 0; i < n; ++i) {
    const float *u = numbers + 3 * i;
    LightSample s;
    bool sampled = true;
    const Vec3 rgb = integrate(all, [&](const Wavelengths &w) {
      s = {};
      sampled &= sample_light(*scene, load(r->position), load(r->normal), r->transmissive, r->light_group, u[0], {u[1], u[2]},
                              w, 0, s);
      return s.radiance;
    });
    store(s.wi, direction + 3 * i);
    distance[i] = s.distance;
    store(sampled ? rgb : Vec3{}, radiance + 3 * i);
    pdf[i] = sampled ? s.pdf : 0;
    dirac[i] = s.dirac;
    store(s.source, source + 2 * i);
  }
  return OPAL_OK;
}

int32_t opal_test_light_pdf(const opal_scene *scene, const opal_test_receiver *r, int64_t n, const int32_t *source,
                            const float *direction, const float *distance, float *pdf) {
  if (!scene || !scene->lights || !r) return OPAL_ERROR_ARGUMENT;
  for (int64_t i = 0; i < n; ++i) {
    const SourceId id{source[2 * i] < 0 ? SourceKind::None : SourceKind(source[2 * i]), uint32_t(source[2 * i + 1])};
    pdf[i] = light_pdf(*scene, id, load(r->position), load(r->normal), r->transmissive, r->light_group, load(direction + 3 * i),
                       distance[i], {}, {}, 0);
  }
  return OPAL_OK;
}

int32_t opal_test_lights_along(const opal_scene *scene, int64_t n, const float *origin, const float *direction,
                               uint32_t ray_kind, float *distance, float *radiance, int32_t *source) {
  if (!scene || !scene->lights) return OPAL_ERROR_ARGUMENT;
  const AllWavelengths all(scene->colour);
  for (int64_t i = 0; i < n; ++i) {
    const Ray ray{load(origin + 3 * i), load(direction + 3 * i), 0, kInfinity, 0};
    SourceId id;
    distance[i] = kInfinity;
    const Vec3 rgb = integrate(all, [&](const Wavelengths &w) {
      LampHit hit;
      if (intersect_lamps(*scene, ray, 0, kInfinity, ray_kind, w, hit)) {
        distance[i] = hit.t;
        id = {SourceKind::Lamp, hit.lamp};
        return hit.radiance;
      }
      EscapedRadiance escaped[8];
      Spectrum sum(0.0f);
      for (int k = 0, count = escaped_radiance(*scene, ray.direction, ray_kind, w, escaped, 8); k < count; ++k)
        sum += escaped[k].radiance, id = escaped[k].source;
      return sum;
    });
    store(rgb, radiance + 3 * i);
    store(id, source + 2 * i);
  }
  return OPAL_OK;
}

int32_t opal_test_sample_emission(const opal_scene *scene, int32_t n_targets, const float *targets, int64_t n,
                                  const float *numbers, const float *probe, float *origin, float *direction, float *flux,
                                  int32_t *source) {
  if (!scene || !scene->lights) return OPAL_ERROR_ARGUMENT;
  const AllWavelengths all(scene->colour);
  std::vector<EmissionTarget> spheres;
  for (int32_t i = 0; i < n_targets; ++i) spheres.push_back({load(targets + 4 * i), targets[4 * i + 3]});
  for (int64_t i = 0; i < n; ++i) {
    const float *u = numbers + 6 * i;
    EmissionSample s;
    bool emitted = true;
    const Vec3 rgb = integrate(all, [&](const Wavelengths &w) {
      s = {};
      s.flux = Spectrum(0.0f);
      emitted &= sample_emission(*scene, spheres, {u[0], u[1]}, {u[2], u[3]}, {u[4], u[5]}, 0, w, s);
      return s.flux;
    });
    if (probe) emitted = emitted && emission_reaches(s, load(probe));
    store(s.ray.origin, origin + 3 * i);
    store(s.ray.direction, direction + 3 * i);
    store(emitted ? rgb : Vec3{}, flux + 3 * i);
    store(s.source, source + 2 * i);
  }
  return OPAL_OK;
}

int32_t opal_test_camera_rays(const opal_camera_desc *camera, int64_t n, const float *film, const float *lens,
                              const float *time, float *origin, float *direction, float *range) {
  if (!camera) return OPAL_ERROR_ARGUMENT;
  for (int64_t i = 0; i < n; ++i) {
    Ray ray;
    if (!generate_ray(*camera, film[2 * i], film[2 * i + 1], {lens[2 * i], lens[2 * i + 1]}, time[i], ray))
      return OPAL_ERROR_ARGUMENT;
    store(ray.origin, origin + 3 * i);
    store(ray.direction, direction + 3 * i);
    range[2 * i] = ray.t_min, range[2 * i + 1] = ray.t_max;
  }
  return OPAL_OK;
}

int32_t opal_test_camera_connect(const opal_camera_desc *camera, int64_t n, const float *points, const float *lens,
                                 const float *time, float *film, float *importance, float *distance, float *direction) {
  if (!camera) return OPAL_ERROR_ARGUMENT;
  for (int64_t i = 0; i < n; ++i) {
    CameraConnection c;
    const bool seen = connect(*camera, load(points + 3 * i), {lens[2 * i], lens[2 * i + 1]}, time[i], c);
    film[2 * i] = c.film_x, film[2 * i + 1] = c.film_y;
    importance[i] = seen ? c.importance : 0;
    distance[i] = c.distance;
    store(c.to_camera, direction + 3 * i);
  }
  return OPAL_OK;
}

}  // extern "C"
