/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Rainbows of drops of many sizes, from a few folded wavefronts: the sum that is too slow in Python.
 *
 * A fold is a few smooth curves over delta, the angle from its caustic into the bright side, per unit of a drop's radius; a
 * size between two folds takes their mean. Near the caustic the two rays' waves are continued through it by the uniform
 * approximation of Chester, Friedman and Ursell (Proc. Camb. Phil. Soc. 53 (1957) 599), I = pi [sum (zeta/delta)^(1/2)
 * Ai^2(-zeta) + difference (zeta/delta)^(-1/2) Ai'^2(-zeta)],  zeta = scale x^(2/3) delta; further on one ray arrives alone. */
#ifndef OPAL_BOW_H
#define OPAL_BOW_H

#include "opal.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct OpalFolds {
  int32_t n_folds, n_dark, n_points, n_single;
  double side;          /* 1 where the bright side has larger scattering angles, else -1 */
  double dark;          /* radians that the first n_dark points, evenly, reach into the dark */
  double shortest;      /* delta/last of point i beyond is (s (shortest + (1 - shortest) s))^2, s = (i - n_dark + 1)/n_points */
  const double *curves; /* n_folds x 5 x (n_dark + n_points): sum and difference, perpendicular and parallel each, and scale */
  const double *ends;   /* n_folds x 3: last, and the two deltas between which `single` is spaced evenly */
  const double *single; /* n_folds x 2 x n_single: intensity where one ray alone arrives */
} OpalFolds;

/* Ai^2(-z) and Ai'^2(-z) at first, first + step ...; end values hold beyond. */
typedef struct OpalAirySquares {
  int32_t n;
  double first, step;
  const double *value, *slope;
} OpalAirySquares;

/* n_sizes drops: place (among the folds: 1.25 lies a quarter of the way from the second to the third), angle (of the caustic),
 * x (size parameter), share, shadow (radians into the dark within which light is looked for); n each. angles: n_angles
 * scattering angles, radians. out: 2 x n_angles, perpendicular and parallel. One thread; independent of all else. */
OPAL_EXPORT int32_t opal_bow_sum(const OpalFolds *folds, const OpalAirySquares *airy, int32_t n_sizes, const double *place,
                                 const double *angle, const double *x, const double *share, const double *shadow,
                                 int32_t n_angles, const double *angles, double *out);

#ifdef __cplusplus
}
#endif
#endif
