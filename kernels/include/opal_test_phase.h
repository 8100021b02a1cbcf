/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A scene's phase functions, one by one, for the tests that hold their samplers to their values. */
#ifndef OPAL_TEST_PHASE_H
#define OPAL_TEST_PHASE_H

#include "opal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* n directions into which light along +Z is scattered at one wavelength.
 * numbers: n x 3, a choice and two for the direction. Out: direction n x 3, density n and value n, both 1/sr. */
OPAL_EXPORT int32_t opal_test_sample_phase(const opal_scene *scene, int32_t phase, float nm, int64_t n, const float *numbers,
                                           float *direction, float *density, float *value);

#ifdef __cplusplus
}
#endif
#endif
