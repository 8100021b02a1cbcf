// SPDX-License-Identifier: GPL-3.0-or-later
// The C door of opal_mie.h: arguments checked, work shared among threads, nothing thrown out.
#include "opal_mie.h"

#include "core/parallel.h"
#include "mie/amplitudes.h"

#include <cmath>

namespace {

constexpr int kAnglesPerTask = 64;

bool valid(double m_re, double m_im, double x) {
  return std::isfinite(m_re) && std::isfinite(m_im) && m_re > 0 && m_im >= 0 && x > 0 && x <= OPAL_MIE_MAX_X;
}

bool valid(int32_t n, const double *m_re, const double *m_im, const double *x) {
  if (n < 0 || !m_re || !m_im || !x) return false;
  for (int32_t i = 0; i < n; ++i)
    if (!valid(m_re[i], m_im[i], x[i])) return false;
  return true;
}

}  // namespace

extern "C" {

int32_t opal_mie_terms(double x) { return x > 0 && x <= OPAL_MIE_MAX_X ? opal::mie::terms(x) : int32_t(OPAL_ERROR_ARGUMENT); }

int32_t opal_mie_efficiencies(int32_t n, const double *m_re, const double *m_im, const double *x, double *out) {
  if (!valid(n, m_re, m_im, x) || !out) return OPAL_ERROR_ARGUMENT;
  try {
    for (int32_t i = 0; i < n; ++i) {
      const auto e = opal::mie::efficiencies(opal::mie::coefficients({m_re[i], m_im[i]}, x[i]));
      out[3 * i] = e.extinction, out[3 * i + 1] = e.scattering, out[3 * i + 2] = e.asymmetry;
    }
  } catch (...) {  // only an allocation can fail
    return OPAL_ERROR_MEMORY;
  }
  return OPAL_OK;
}

int32_t opal_mie_amplitudes(int32_t n, const double *m_re, const double *m_im, const double *x, int32_t n_angles,
                            const double *cosines, int32_t threads, double *out) {
  if (!valid(n, m_re, m_im, x) || n_angles < 0 || !cosines || !out) return OPAL_ERROR_ARGUMENT;
  for (int32_t i = 0; i < n_angles; ++i)
    if (!(std::fabs(cosines[i]) <= 1)) return OPAL_ERROR_ARGUMENT;
  try {
    const int crew = opal::resolve_threads(threads);
    const std::atomic<bool> cancel{false};
    std::vector<std::vector<opal::mie::Term>> series(static_cast<size_t>(n));
    opal::parallel_for(n, crew, cancel, [&](int64_t i) {
      series[size_t(i)] = opal::mie::series(opal::mie::coefficients({m_re[i], m_im[i]}, x[i]));
    });
    const int64_t blocks = (int64_t(n_angles) + kAnglesPerTask - 1) / kAnglesPerTask;
    opal::parallel_for(n * blocks, crew, cancel, [&](int64_t task) {
      const int64_t i = task / blocks, first = task % blocks * kAnglesPerTask;
      const int count = int(std::min<int64_t>(kAnglesPerTask, n_angles - first));
      opal::mie::amplitudes(series[size_t(i)], count, cosines + first, out + (i * n_angles + first) * 8);
    });
  } catch (...) {
    return OPAL_ERROR_MEMORY;
  }
  return OPAL_OK;
}

}  // extern "C"
