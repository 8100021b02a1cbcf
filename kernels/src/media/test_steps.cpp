// SPDX-License-Identifier: GPL-3.0-or-later
// See opal_test_medium.h.
#include "media/tracking.h"
#include "opal_test_medium.h"

struct opal_scene : opal::Scene {};

int32_t opal_test_medium_steps(const opal_scene *scene, int32_t medium, int64_t n, const float *origins,
                               const float *directions, float length, int64_t *intervals, int64_t *collisions) {
  if (!scene || medium < 0 || size_t(medium) >= scene->media.size() || n < 0) return OPAL_ERROR_ARGUMENT;
  opal::MediumSet set;
  set.enter(opal::MediumSet::kOfWorld, medium);
  const opal::Wavelengths w = scene->colour.sample(0.5f);
  *intervals = *collisions = 0;
  for (int64_t i = 0; i < n; ++i) {
    const float *o = origins + 3 * i, *d = directions + 3 * i;
    opal::RayMedia media(*scene, set, w, {{o[0], o[1], o[2]}, {d[0], d[1], d[2]}});
    const opal::Sampler sampler(0, uint32_t(i), 0);
    opal::RandomStream random(sampler, 0);
    for (opal::RayMedia::Interval interval; media.next(length, interval);) {
      ++*intervals;
      const float rate = interval.majorant[0];
      for (float t = interval.begin; (t -= std::log1p(-random.next()) / rate) < interval.end;) ++*collisions;
    }
  }
  return OPAL_OK;
}
