// SPDX-License-Identifier: GPL-3.0-or-later
// The amplitudes S1 and S2 of a sphere from its coefficients, several angles at once and each with its mirror image.
//
// S1 = sum (2n+1)/(n(n+1)) (a_n pi_n + b_n tau_n), S2 with pi and tau exchanged (Bohren and Huffman 1983, eq. 4.74).
// pi_n(-mu) = (-1)^(n+1) pi_n(mu) and tau_n(-mu) = (-1)^n tau_n(mu): so the sum over odd n of a pi plus that over even n of
// b tau, and the rest, give S1 at mu by their sum and S1 at -mu by their difference: two angles for little more than one.
#pragma once

#include "mie/coefficients.h"

namespace opal::mie {

// What the inner loop reads of one term, weight (2n+1)/(n(n+1)) included, and the factors of the recurrence
// pi_(n+1) = forward mu pi_n - back pi_(n-1).
struct Term {
  double a_re, a_im, b_re, b_im, n, forward, back;
};

std::vector<Term> series(const Coefficients &c);

// out: n_angles x 8, as opal_mie_amplitudes().
void amplitudes(const std::vector<Term> &series, int n_angles, const double *cosines, double *out);

}  // namespace opal::mie
