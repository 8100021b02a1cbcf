// SPDX-License-Identifier: GPL-3.0-or-later
#include "mie/coefficients.h"

#include <cmath>

namespace opal::mie {

namespace {

using Complex = std::complex<double>;

// Logarithmic derivative D_n(y) = psi_n'(y)/psi_n(y), n = 0 .. n_max, downward: stable for every y. It starts as far above
// |y| as the recurrence needs to forget its start; |y| + 15, as often printed, is too low for large clear spheres.
std::vector<Complex> logarithmic_derivative(Complex y, int n_max) {
  const double size = std::abs(y);
  const int start = std::max(n_max, int(size)) + int(8 * std::cbrt(size)) + 16;
  std::vector<Complex> d(size_t(n_max) + 1);
  Complex value = 0;
  const Complex inverse = 1.0 / y;
  for (int n = start; n > 0; --n) {
    const Complex ratio = double(n) * inverse;
    value = ratio - 1.0 / (value + ratio);
    if (n - 1 <= n_max) d[size_t(n - 1)] = value;
  }
  return d;
}

// psi_n(x), n = 0 .. n_max. Upward it is stable as long as n < x; beyond, psi falls and its ratio psi_n/psi_(n-1) is taken
// from a downward recurrence.
std::vector<double> riccati_bessel_psi(double x, int n_max) {
  const int start = n_max + int(8 * std::cbrt(x)) + 16;
  const int turn = std::min(n_max, int(x));
  std::vector<double> ratio(size_t(n_max) + 2, 0.0);
  double r = x / (2 * start + 1);
  for (int n = start; n > turn; --n) {
    r = 1 / ((2 * n + 1) / x - r);
    if (n <= n_max) ratio[size_t(n)] = r;
  }
  std::vector<double> psi(size_t(n_max) + 1);
  double before = std::cos(x), now = std::sin(x);  // psi_-1, psi_0
  psi[0] = now;
  for (int n = 1; n <= n_max; ++n) {
    const double next = n <= turn ? (2 * n - 1) / x * now - before : ratio[size_t(n)] * now;
    before = now;
    psi[size_t(n)] = now = next;
  }
  return psi;
}

}  // namespace

int terms(double x) {
  const double root = std::cbrt(x);
  if (x <= 8) return int(x + 4 * root + 1);
  if (x < 4200) return int(x + 4.05 * root + 2);
  return int(x + 4 * root + 2);
}

Coefficients coefficients(Complex m, double x) {
  const int n_max = std::max(terms(x), 1);
  const std::vector<Complex> d = logarithmic_derivative(m * x, n_max);
  const std::vector<double> psi = riccati_bessel_psi(x, n_max);
  Coefficients c{x, {}, {}};
  c.a.reserve(size_t(n_max));
  c.b.reserve(size_t(n_max));
  double chi_before = -std::sin(x), chi = std::cos(x);  // chi_-1, chi_0; upward is stable
  for (int n = 1; n <= n_max; ++n) {
    const double chi_next = (2 * n - 1) / x * chi - chi_before;
    const Complex xi(psi[size_t(n)], -chi_next), xi_before(psi[size_t(n) - 1], -chi);
    const Complex electric = d[size_t(n)] / m + n / x, magnetic = d[size_t(n)] * m + n / x;
    c.a.push_back((electric * psi[size_t(n)] - psi[size_t(n) - 1]) / (electric * xi - xi_before));
    c.b.push_back((magnetic * psi[size_t(n)] - psi[size_t(n) - 1]) / (magnetic * xi - xi_before));
    chi_before = chi;
    chi = chi_next;
  }
  return c;
}

Efficiencies efficiencies(const Coefficients &c) {
  double extinction = 0, scattering = 0, asymmetry = 0;
  for (size_t i = 0; i < c.a.size(); ++i) {
    const double n = double(i + 1);
    extinction += (2 * n + 1) * (c.a[i] + c.b[i]).real();
    scattering += (2 * n + 1) * (std::norm(c.a[i]) + std::norm(c.b[i]));
    asymmetry += (2 * n + 1) / (n * (n + 1)) * (c.a[i] * std::conj(c.b[i])).real();
    if (i + 1 < c.a.size())
      asymmetry += n * (n + 2) / (n + 1) * (c.a[i] * std::conj(c.a[i + 1]) + c.b[i] * std::conj(c.b[i + 1])).real();
  }
  const double area = 2 / (c.x * c.x);
  return {area * extinction, area * scattering, scattering > 0 ? 2 * asymmetry / scattering : 0};
}

}  // namespace opal::mie
