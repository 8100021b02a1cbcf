// SPDX-License-Identifier: GPL-3.0-or-later
#include "mie/amplitudes.h"

#include "mie/lanes.h"

#include <algorithm>

namespace opal::mie {

namespace {

// The sums that S1 and S2 at an angle and at its mirror are made of: S = same + other, mirrored S1 = same - other,
// mirrored S2 = same - other, where for odd n `same` takes a pi (S1) or b pi (S2), and for even n b tau or a tau.
struct Sums {
  Lane s1_same_re, s1_same_im, s1_other_re, s1_other_im;
  Lane s2_same_re, s2_same_im, s2_other_re, s2_other_im;
};

Sums sum_series(const std::vector<Term> &series, const Lane mu) {
  const Lane zero = mu - mu;
  Lane p_re = zero, p_im = zero, q_re = zero, q_im = zero, u_re = zero, u_im = zero, v_re = zero, v_im = zero;
  Lane before = zero, now = zero + 1.0;  // pi_(n-1), pi_n
  const Term *t = series.data(), *const end = t + series.size();
  const auto step = [&](Lane &tau) {  // tau_n = n mu pi_n - (n+1) pi_(n-1); then on to pi_(n+1)
    const Lane mu_now = mu * now;
    tau = t->n * mu_now - (t->n + 1) * before;
    const Lane next = t->forward * mu_now - t->back * before;
    before = now;
    now = next;
  };
  for (; t + 1 < end; ++t) {
    Lane tau, pi = now;
    step(tau);
    p_re += t->a_re * pi, p_im += t->a_im * pi, q_re += t->b_re * tau, q_im += t->b_im * tau;
    u_re += t->b_re * pi, u_im += t->b_im * pi, v_re += t->a_re * tau, v_im += t->a_im * tau;
    ++t;
    pi = now;
    step(tau);
    q_re += t->a_re * pi, q_im += t->a_im * pi, p_re += t->b_re * tau, p_im += t->b_im * tau;
    v_re += t->b_re * pi, v_im += t->b_im * pi, u_re += t->a_re * tau, u_im += t->a_im * tau;
  }
  if (t < end) {  // the series has an odd number of terms
    Lane tau, pi = now;
    step(tau);
    p_re += t->a_re * pi, p_im += t->a_im * pi, q_re += t->b_re * tau, q_im += t->b_im * tau;
    u_re += t->b_re * pi, u_im += t->b_im * pi, v_re += t->a_re * tau, v_im += t->a_im * tau;
  }
  return {p_re, p_im, q_re, q_im, u_re, u_im, v_re, v_im};
}

}  // namespace

std::vector<Term> series(const Coefficients &c) {
  std::vector<Term> result(c.a.size());
  for (size_t i = 0; i < result.size(); ++i) {
    const double n = double(i + 1), weight = (2 * n + 1) / (n * (n + 1));
    result[i] = {weight * c.a[i].real(),
                 weight * c.a[i].imag(),
                 weight * c.b[i].real(),
                 weight * c.b[i].imag(),
                 n,
                 (2 * n + 1) / n,
                 (n + 1) / n};
  }
  return result;
}

void amplitudes(const std::vector<Term> &series, int n_angles, const double *cosines, double *out) {
  for (int first = 0; first < n_angles; first += kLanes) {
    const int count = std::min(kLanes, n_angles - first);
    double mu[kLanes] = {};
    std::copy_n(cosines + first, count, mu);
    const Sums s = sum_series(series, load(mu));
    double v[8][kLanes];
    store(v[0], s.s1_same_re + s.s1_other_re);
    store(v[1], s.s1_same_im + s.s1_other_im);
    store(v[2], s.s2_same_re + s.s2_other_re);
    store(v[3], s.s2_same_im + s.s2_other_im);
    store(v[4], s.s1_same_re - s.s1_other_re);
    store(v[5], s.s1_same_im - s.s1_other_im);
    store(v[6], s.s2_same_re - s.s2_other_re);
    store(v[7], s.s2_same_im - s.s2_other_im);
    for (int lane = 0; lane < count; ++lane)
      for (int k = 0; k < 8; ++k) out[size_t(first + lane) * 8 + size_t(k)] = v[k][lane];
  }
}

}  // namespace opal::mie
