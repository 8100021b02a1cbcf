// SPDX-License-Identifier: GPL-3.0-or-later
// Phase functions: how a medium turns light, per steradian, with integral 1 over the sphere.
//
// The angle is between propagation directions: cosine 1 is straight on. Four kinds: isotropic, Henyey-Greenstein (1941),
// Rayleigh (1871, unpolarised), and tables over wavelength and angle (a rainbow's droplets). What is evaluated is what is
// sampled: the density of sample() is value() at the hero wavelength.
#pragma once

#include "core/spectrum.h"
#include "core/vec.h"

#include <vector>

namespace opal {

enum class PhaseKind : uint8_t { Isotropic, HenyeyGreenstein, Rayleigh, Table };

class PhaseFunction {
 public:
  static PhaseFunction isotropic() { return PhaseFunction(PhaseKind::Isotropic, 0); }
  // anisotropy: mean cosine, -1 < g < 1.
  static PhaseFunction henyey_greenstein(float anisotropy) {
    return PhaseFunction(PhaseKind::HenyeyGreenstein, clamp(anisotropy, -0.999f, 0.999f));
  }
  static PhaseFunction rayleigh() { return PhaseFunction(PhaseKind::Rayleigh, 0); }
  // values: n_wavelengths rows of n_angles, in 1/sr up to a factor (rows are normalised); wavelengths (nm) and angles
  // (radians, from 0 to pi) ascend. Linear in the angle's cosine and in wavelength.
  static PhaseFunction table(const float *wavelengths, int n_wavelengths, const float *angles, int n_angles,
                             const float *values);

  // 1/sr at one wavelength (nm) for the cosine of the angle.
  float value(float nm, float cosine) const;
  // The same at every wavelength of a path.
  Spectrum value(const Wavelengths &w, float cosine) const;
  // A direction to go on in, with density value(nm of the hero, cosine).
  Vec3 sample(float nm, const Vec3 &forward, float pick, Vec2 u, float &density) const;

  PhaseKind kind() const { return kind_; }
  bool chromatic() const { return kind_ == PhaseKind::Table && n_rows_ > 1; }

 private:
  PhaseFunction(PhaseKind kind, float g) : kind_(kind), g_(g) {}

  // The two rows that bracket a wavelength, and the weight of the second.
  void rows(float nm, int &first, int &second, float &weight) const;
  float row_value(int row, float cosine) const;
  float row_sample(int row, float u) const;  // cosine

  PhaseKind kind_ = PhaseKind::Isotropic;
  float g_ = 0;
  int n_rows_ = 0, n_nodes_ = 0;
  std::vector<float> wavelengths_;
  std::vector<float> cosines_;     // ascending, -1 .. 1
  std::vector<float> values_;      // n_rows_ x n_nodes_, over cosines_
  std::vector<float> cumulative_;  // n_rows_ x n_nodes_, 0 .. 1
};

}  // namespace opal
