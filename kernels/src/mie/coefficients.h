// SPDX-License-Identifier: GPL-3.0-or-later
// The expansion coefficients a_n, b_n of Lorenz-Mie theory, and what follows from them alone.
//
// Bohren and Huffman 1983, eq. 4.88; number of terms: Wiscombe, Appl. Opt. 19 (1980) 1505. m = n + ik, psi = x j(x),
// xi = psi - i chi, time factor exp(-i omega t).
#pragma once

#include <complex>
#include <vector>

namespace opal::mie {

struct Coefficients {
  double x = 0;
  std::vector<std::complex<double>> a, b;  // a[n - 1] is a_n
};

int terms(double x);
Coefficients coefficients(std::complex<double> m, double x);

struct Efficiencies {
  double extinction, scattering, asymmetry;
};
Efficiencies efficiencies(const Coefficients &c);

}  // namespace opal::mie
