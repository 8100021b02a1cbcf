// SPDX-License-Identifier: GPL-3.0-or-later
// The door through which tests run programs without rendering.
#include "opal_test_shader.h"
#include "scene/scene.h"

#include <cstdio>

struct opal_scene : opal::Scene {};

using namespace opal;

int32_t opal_test_run_program(const opal_scene *scene, const opal_program *desc, int64_t n, const float *points,
                              const int32_t *hits, float ray_length, float *emission, float *transparency, char *error,
                              int32_t error_size) try {
  static const Scene kEmpty{};
  Program program;
  const char *message = "";
  const int n_images = scene ? int(scene->images.size()) : 0;
  if (!program_from_desc(*desc, n_images, program, &message)) {
    std::snprintf(error, size_t(error_size), "%s", message);
    return OPAL_ERROR_ARGUMENT;
  }
  const auto store = [](float *to, int64_t i, const Vec3 &v) {
    if (to) to[3 * i] = v.x, to[3 * i + 1] = v.y, to[3 * i + 2] = v.z;
  };
  const Scene &s = scene ? static_cast<const Scene &>(*scene) : kEmpty;
  for (int64_t i = 0; i < n; ++i) {
    ShadingPoint sp;
    if (hits) {
      const float *p = points + 5 * i;
      Ray ray;
      ray.direction = -Vec3{p[2], p[3], p[4]};
      Hit hit;
      hit.t = ray_length, hit.u = p[0], hit.v = p[1];
      hit.instance = uint32_t(hits[2 * i]), hit.triangle = uint32_t(hits[2 * i + 1]);
      sp = s.shading_point(ray, hit);
      sp.ray_kind = OPAL_RAY_CAMERA;
    } else {
      sp.p = {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
    }
    if (emission) store(emission, i, run_emission(s, program, sp));
    if (transparency) store(transparency, i, run_transparency(s, program, sp));
  }
  return OPAL_OK;
} catch (...) {
  return OPAL_ERROR_INTERNAL;
}
