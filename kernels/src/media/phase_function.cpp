// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/phase_function.h"

namespace opal {
namespace {

constexpr float kInv4Pi = 0.07957747154594767f;

float henyey_greenstein_value(float g, float cosine) {
  const float d = 1 + g * g - 2 * g * cosine;
  return kInv4Pi * (1 - g * g) / (d * std::sqrt(d));
}

// The cosine whose cumulative probability is u.
float sample_henyey_greenstein(float g, float u) {
  if (std::abs(g) < 1e-3f) return 2 * u - 1;
  const float s = (1 - g * g) / (1 - g + 2 * g * u);
  return clamp((1 + g * g - s * s) / (2 * g), -1.0f, 1.0f);
}

// Inverse of the cumulative 1/2 + 3/8 c + 1/8 c^3 (Cardano's formula; Frisvad 2011).
float sample_rayleigh(float u) {
  const float a = 2 * (2 * u - 1);
  const float b = std::cbrt(a + std::sqrt(a * a + 1));
  return clamp(b - 1 / b, -1.0f, 1.0f);
}

}  // namespace

PhaseFunction PhaseFunction::table(const float *wavelengths, int n_wavelengths, const float *angles, int n_angles,
                                   const float *values) {
  PhaseFunction p(PhaseKind::Table, 0);
  p.n_rows_ = n_wavelengths, p.n_nodes_ = n_angles;
  p.wavelengths_.assign(wavelengths, wavelengths + n_wavelengths);
  p.cosines_.resize(size_t(n_angles));
  for (int i = 0; i < n_angles; ++i) p.cosines_[size_t(n_angles - 1 - i)] = float(std::cos(double(angles[i])));
  p.cosines_.front() = -1, p.cosines_.back() = 1;
  p.values_.resize(size_t(n_wavelengths) * size_t(n_angles));
  p.cumulative_.resize(p.values_.size());
  for (int r = 0; r < n_wavelengths; ++r) {
    float *row = &p.values_[size_t(r) * size_t(n_angles)];
    float *cumulative = &p.cumulative_[size_t(r) * size_t(n_angles)];
    for (int i = 0; i < n_angles; ++i) row[n_angles - 1 - i] = std::max(0.0f, values[size_t(r) * size_t(n_angles) + size_t(i)]);
    double sum = 0;
    std::vector<double> running(size_t(n_angles), 0.0);
    for (int i = 1; i < n_angles; ++i) {
      sum += 0.5 * (double(row[i]) + row[i - 1]) * (double(p.cosines_[size_t(i)]) - p.cosines_[size_t(i) - 1]);
      running[size_t(i)] = sum;
    }
    const double scale = sum > 0 ? 1 / sum : 0;
    for (int i = 0; i < n_angles; ++i) {
      row[i] = sum > 0 ? float(row[i] * scale * 0.15915494309189535) : kInv4Pi;
      cumulative[i] = sum > 0 ? float(running[size_t(i)] * scale) : 0.5f * (p.cosines_[size_t(i)] + 1);
    }
  }
  return p;
}

void PhaseFunction::rows(float nm, int &first, int &second, float &weight) const {
  const auto it = std::upper_bound(wavelengths_.begin(), wavelengths_.end(), nm);
  second = std::clamp(int(it - wavelengths_.begin()), 0, n_rows_ - 1);
  first = std::max(0, int(it - wavelengths_.begin()) - 1);
  weight =
      second > first ? (nm - wavelengths_[size_t(first)]) / (wavelengths_[size_t(second)] - wavelengths_[size_t(first)]) : 0.0f;
}

float PhaseFunction::row_value(int row, float cosine) const {
  const auto it = std::upper_bound(cosines_.begin() + 1, cosines_.end() - 1, cosine);
  const size_t i = size_t(it - cosines_.begin());
  const float *v = &values_[size_t(row) * size_t(n_nodes_)];
  const float span = cosines_[i] - cosines_[i - 1];
  return lerp(v[i - 1], v[i], span > 0 ? saturate((cosine - cosines_[i - 1]) / span) : 0.0f);
}

float PhaseFunction::row_sample(int row, float u) const {
  const float *c = &cumulative_[size_t(row) * size_t(n_nodes_)];
  const float *v = &values_[size_t(row) * size_t(n_nodes_)];
  const size_t i = size_t(std::upper_bound(c + 1, c + n_nodes_ - 1, u) - c);
  // Within the interval the density is linear: solve the quadratic for the part of its mass below u.
  const float span = cosines_[i] - cosines_[i - 1], mass = c[i] - c[i - 1];
  if (!(span > 0) || !(mass > 0)) return cosines_[i - 1];
  const float target = saturate((u - c[i - 1]) / mass), a = v[i - 1], b = v[i];
  const float root = safe_sqrt(lerp(a * a, b * b, target));
  const float t = a + root > 0 ? target * (a + b) / (a + root) : target;
  return clamp(cosines_[i - 1] + span * saturate(t), -1.0f, 1.0f);
}

float PhaseFunction::value(float nm, float cosine) const {
  switch (kind_) {
    case PhaseKind::Isotropic: return kInv4Pi;
    case PhaseKind::HenyeyGreenstein: return henyey_greenstein_value(g_, cosine);
    case PhaseKind::Rayleigh: return 0.75f * kInv4Pi * (1 + cosine * cosine);
    case PhaseKind::Table: {
      int first, second;
      float weight;
      rows(nm, first, second, weight);
      return lerp(row_value(first, cosine), row_value(second, cosine), weight);
    }
  }
  return 0;
}

Spectrum PhaseFunction::value(const Wavelengths &w, float cosine) const {
  if (kind_ != PhaseKind::Table) return Spectrum(value(w.nm[0], cosine));
  Spectrum s;
  for (int i = 0; i < kWavelengths; ++i) s[i] = value(w.nm[i], cosine);
  return s;
}

Vec3 PhaseFunction::sample(float nm, const Vec3 &forward, float pick, Vec2 u, float &density) const {
  float cosine = 2 * u.x - 1;
  switch (kind_) {
    case PhaseKind::Isotropic: break;
    case PhaseKind::HenyeyGreenstein: cosine = sample_henyey_greenstein(g_, u.x); break;
    case PhaseKind::Rayleigh: cosine = sample_rayleigh(u.x); break;
    case PhaseKind::Table: {
      int first, second;
      float weight;
      rows(nm, first, second, weight);
      cosine = row_sample(pick < weight ? second : first, u.x);
      break;
    }
  }
  density = value(nm, cosine);
  const float sine = safe_sqrt(1 - cosine * cosine), phi = 2 * kPi * u.y;
  return Frame::from_z(forward).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
}

}  // namespace opal
