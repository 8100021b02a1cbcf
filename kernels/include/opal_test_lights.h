/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The light samplers and the camera, one by one, for the tests that hold them to closed forms.
 *
 * Scenes are committed ones. Spectra are returned as linear Rec.709, integrated over 64 wavelengths (error below 1e-3).
 * Sources are pairs: kind (0 lamp, 1 emissive triangle, 2 world) and index. */
#ifndef OPAL_TEST_LIGHTS_H
#define OPAL_TEST_LIGHTS_H

#include "opal.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct opal_test_receiver {
  float position[3];
  float normal[3]; /* zero: a medium */
  int32_t transmissive;
  int32_t light_group;
} opal_test_receiver;

/* n samples towards lights. numbers: n x 3 (choice of the source, two for the direction).
 * Out: direction n x 3, distance n, radiance n x 3, pdf n (0: nothing was sampled), dirac n, source n x 2. */
OPAL_EXPORT int32_t opal_test_sample_light(const opal_scene *scene, const opal_test_receiver *receiver, int64_t n,
                                           const float *numbers, float *direction, float *distance, float *radiance, float *pdf,
                                           int32_t *dirac, int32_t *source);
/* The probability densities with which that happens for directions that meet the source at these distances. */
OPAL_EXPORT int32_t opal_test_light_pdf(const opal_scene *scene, const opal_test_receiver *receiver, int64_t n,
                                        const int32_t *source, const float *direction, const float *distance, float *pdf);
/* What rays see of lamps (nearest) and, where they meet none, of suns and the world (summed; source: the last one).
 * Out: distance n (infinite: sky), radiance n x 3, source n x 2 (kind -1: nothing). */
OPAL_EXPORT int32_t opal_test_lights_along(const opal_scene *scene, int64_t n, const float *origin, const float *direction,
                                           uint32_t ray_kind, float *distance, float *radiance, int32_t *source);
/* n photons towards targets (n_targets x 4: centre, radius; none: the whole scene). numbers: n x 6. A photon that carries
 * nothing has flux 0. probe (3, may be NULL): flux is 0 as well for photons that do not count at that point. */
OPAL_EXPORT int32_t opal_test_sample_emission(const opal_scene *scene, int32_t n_targets, const float *targets, int64_t n,
                                              const float *numbers, const float *probe, float *origin, float *direction,
                                              float *flux, int32_t *source);
/* Camera rays: film, lens n x 2, time n. Out: origin, direction n x 3, range n x 2. */
OPAL_EXPORT int32_t opal_test_camera_rays(const opal_camera_desc *camera, int64_t n, const float *film, const float *lens,
                                          const float *time, float *origin, float *direction, float *range);
/* How points are seen. Out: film n x 2, importance n (0: not seen), distance n, direction to the camera n x 3. */
OPAL_EXPORT int32_t opal_test_camera_connect(const opal_camera_desc *camera, int64_t n, const float *points, const float *lens,
                                             const float *time, float *film, float *importance, float *distance,
                                             float *direction);

#ifdef __cplusplus
}
#endif
#endif
