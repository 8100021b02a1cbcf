// SPDX-License-Identifier: GPL-3.0-or-later
// Phase functions: how a medium turns light, per steradian, with integral 1 over the sphere.
//
// The angle is between propagation directions: cosine 1 is straight on. Four kinds: isotropic, Henyey-Greenstein (1941),
// Rayleigh (1871, unpolarised), and tables over wavelength and angle (a rainbow's droplets). What is evaluated is what is
// sampled: the density of sample() is value() at the hero wavelength. Particles that are not round send light otherwise to the
// sides than up and down: value() is then the mean over all places of a bow, still what is sampled, and scattered() the truth.
#pragma once

#include "core/spectrum.h"
#include "core/vec.h"

#include <cstdint>
#include <vector>

namespace opal {

// What opal_phase_desc says of a table; sizes as there.
struct PhaseTable {
  const float *wavelengths = nullptr, *angles = nullptr, *elevations = nullptr, *clocks = nullptr;
  int n_wavelengths = 0, n_angles = 0, n_elevations = 0, n_clocks = 0;
  const float *values = nullptr, *polarization = nullptr;
};

// A linear polarising filter, by the direction of the field that it lets through. It passes half of unpolarised light, which is
// taken off every path alike; `factor` is what it makes of light of a degree of polarisation beside that.
struct Polariser {
  bool present = false;
  Vec3 axis;

  // 1 + P cos(2 psi), psi between the axis, as the ray sees it, and the perpendicular of the plane of scattering.
  float factor(float degree, const Vec3 &light, const Vec3 &onward) const {
    const Vec3 seen = axis - onward * dot(axis, onward), perpendicular = cross(light, onward);
    const float size = length_squared(seen) * length_squared(perpendicular);
    return size > 1e-12f ? 1 + degree * (2 * sqr(dot(seen, perpendicular)) / size - 1) : 1.0f;
  }
};

enum class PhaseKind : uint8_t { Isotropic, HenyeyGreenstein, Rayleigh, Table };

class PhaseFunction {
 public:
  static PhaseFunction isotropic() { return PhaseFunction(PhaseKind::Isotropic, 0); }
  // anisotropy: mean cosine, -1 < g < 1.
  static PhaseFunction henyey_greenstein(float anisotropy) {
    return PhaseFunction(PhaseKind::HenyeyGreenstein, clamp(anisotropy, -0.999f, 0.999f));
  }
  static PhaseFunction rayleigh() { return PhaseFunction(PhaseKind::Rayleigh, 0); }
  // Rows are in 1/sr up to a factor (they are normalised). Linear in the angle's cosine and in everything else.
  static PhaseFunction table(const PhaseTable &table);

  // 1/sr at one wavelength (nm) for the cosine of the angle.
  float value(float nm, float cosine) const;
  // The same at every wavelength of a path.
  Spectrum value(const Wavelengths &w, float cosine) const;
  // 1/sr for unpolarised light that goes along `light` and on along `onward`, through the camera's filter if there is one.
  Spectrum scattered(const Wavelengths &w, const Vec3 &light, const Vec3 &onward, const Polariser *filter) const;
  // A direction to go on in, with density value(nm of the hero, cosine).
  Vec3 sample(float nm, const Vec3 &forward, float pick, Vec2 u, float &density) const;

  PhaseKind kind() const { return kind_; }
  bool chromatic() const { return kind_ == PhaseKind::Table && n_rows_ > 1; }

 private:
  PhaseFunction(PhaseKind kind, float g) : kind_(kind), g_(g) {}

  // The two rows that bracket a wavelength, and the weight of the second.
  void rows(float nm, int &first, int &second, float &weight) const;
  // The interval of the cosines, and where in it.
  size_t interval(float cosine, float &within) const;
  void build_guide();
  // Between two rows at the same angle: where the tables keep them (place, 0 for round particles; node of the cosines).
  size_t slot(size_t place, size_t node) const { return (place * size_t(n_nodes_) + node) * size_t(n_rows_); }
  float row_sample(int row, float u) const;  // cosine
  void normalise(float *row, float *cumulative) const;
  // Four corners of (elevation, clock) with weights, for light from somewhere seen from somewhere; 1 for round particles.
  int places(const Vec3 &light, const Vec3 &onward, size_t place[4], float weight[4]) const;

  PhaseKind kind_ = PhaseKind::Isotropic;
  float g_ = 0;
  int n_rows_ = 0, n_nodes_ = 0;
  float per_nm_ = 0;  // rows a nm where the wavelengths are equally spaced, else 0
  std::vector<float> wavelengths_;
  std::vector<float> cosines_;              // ascending, -1 .. 1
  std::vector<uint32_t> guide_;             // over equal steps of the cosine: the first node beyond each step's begin
  std::vector<float> values_;               // n_nodes_ x n_rows_: a path asks for many wavelengths at one angle
  std::vector<float> elevations_, clocks_;  // empty for round particles
  std::vector<float> oriented_;             // elevations x clocks x n_nodes_ x n_rows_, empty for round particles
  std::vector<float> degree_;               // of polarisation, as oriented_ or as values_; may be empty
  std::vector<float> cumulative_;           // n_rows_ x n_nodes_, 0 .. 1
};

}  // namespace opal
