/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * For tests: a program run at given points. Not part of the interface that opal.h describes. */
#ifndef OPAL_TEST_SHADER_H
#define OPAL_TEST_SHADER_H

#include "opal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Runs `program` at n points and writes its emission and straight-through transmittance (n x 3 each, or NULL).
 * Without `hits`, `points` are positions (n x 3) seen as the world is, by their direction; `scene` may be NULL, then images
 * are grey. With `hits` (n x 2: instance, triangle), `points` are barycentrics u, v and the view direction's three
 * components away from the surface (n x 5), and `ray_length` is the length of the ray that came there.
 * On failure returns OPAL_ERROR_ARGUMENT and writes a sentence to error[0 .. error_size-1]. */
OPAL_EXPORT int32_t opal_test_run_program(const opal_scene *scene, const opal_program *program, int64_t n, const float *points,
                                          const int32_t *hits, float ray_length, float *emission, float *transparency,
                                          char *error, int32_t error_size);

#ifdef __cplusplus
}
#endif
#endif
