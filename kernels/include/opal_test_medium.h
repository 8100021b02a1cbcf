/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * How much work a medium makes along rays, counted for the tests: what a second is depends on the machine. */
#ifndef OPAL_TEST_MEDIUM_H
#define OPAL_TEST_MEDIUM_H

#include "opal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Follows n rays (origins and unit directions, n x 3, in the medium's space) over `length` metres.
 * Out: the intervals in which collisions are looked for, and the tentative collisions, at each of which the density is read;
 * both over all rays, for one walk of ratio tracking each. */
OPAL_EXPORT int32_t opal_test_medium_steps(const opal_scene *scene, int32_t medium, int64_t n, const float *origins,
                                           const float *directions, float length, int64_t *intervals, int64_t *collisions);

#ifdef __cplusplus
}
#endif
#endif
