/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Lorenz-Mie scattering by homogeneous spheres: the sums that are too slow in Python.
 *
 * Conventions (Bohren and Huffman 1983)
 *   - m = n + ik relative to the surrounding medium, k >= 0 absorbs; x = 2 pi a / lambda, lambda in the surrounding medium.
 *   - S1 is the amplitude perpendicular to the scattering plane, S2 the parallel one; angle 0 is forward.
 *   - Every function is independent of the number of threads, to the last bit. None throws or prints. */
#ifndef OPAL_MIE_H
#define OPAL_MIE_H

#include "opal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Largest size parameter that is computed: a drop of 8 mm radius in violet light. */
#define OPAL_MIE_MAX_X 150000.0

/* Terms of the series that a sphere needs (Wiscombe 1980); OPAL_ERROR_ARGUMENT outside 0 < x <= OPAL_MIE_MAX_X. */
OPAL_EXPORT int32_t opal_mie_terms(double x);

/* n spheres: m_re, m_im, x (n each). out: n x 3, Q_ext, Q_sca and the asymmetry g. */
OPAL_EXPORT int32_t opal_mie_efficiencies(int32_t n, const double *m_re, const double *m_im, const double *x, double *out);

/* Amplitudes of n spheres at n_angles angles and at their mirrors about 90 degrees, which come almost for nothing.
 * cosines: n_angles, cosine of the scattering angle.
 * out: n x n_angles x 8: S1 and S2 at the cosine, then S1 and S2 at minus the cosine, real and imaginary parts.
 * threads: 0 takes every core. */
OPAL_EXPORT int32_t opal_mie_amplitudes(int32_t n, const double *m_re, const double *m_im, const double *x, int32_t n_angles,
                                        const double *cosines, int32_t threads, double *out);

#ifdef __cplusplus
}
#endif
#endif
