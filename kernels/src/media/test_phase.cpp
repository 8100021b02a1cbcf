// SPDX-License-Identifier: GPL-3.0-or-later
// See opal_test_phase.h.
#include "opal_test_phase.h"

#include "media/phase_function.h"
#include "scene/scene.h"

struct opal_scene : opal::Scene {};

int32_t opal_test_sample_phase(const opal_scene *scene, int32_t phase, float nm, int64_t n, const float *numbers,
                               float *direction, float *density, float *value) {
  if (!scene || phase < 0 || size_t(phase) >= scene->phases.size() || n < 0) return OPAL_ERROR_ARGUMENT;
  const opal::PhaseFunction &function = scene->phases[size_t(phase)];
  for (int64_t i = 0; i < n; ++i) {
    const float *u = numbers + 3 * i;
    const opal::Vec3 d = function.sample(nm, {0, 0, 1}, u[0], {u[1], u[2]}, density[i]);
    direction[3 * i] = d.x, direction[3 * i + 1] = d.y, direction[3 * i + 2] = d.z;
    value[i] = function.value(nm, d.z);
  }
  return OPAL_OK;
}
