// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/phase_function.h"

#include <cstddef>

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

void PhaseFunction::normalise(float *row, float *cumulative) const {
  const size_t n = size_t(n_nodes_);
  double sum = 0;
  std::vector<double> running(n, 0.0);
  for (size_t i = 1; i < n; ++i) {
    sum += 0.5 * (double(row[i]) + row[i - 1]) * (double(cosines_[i]) - cosines_[i - 1]);
    running[i] = sum;
  }
  const double scale = sum > 0 ? 1 / sum : 0;
  for (size_t i = 0; i < n; ++i) {
    row[i] = sum > 0 ? float(row[i] * scale * 0.15915494309189535) : kInv4Pi;
    if (cumulative) cumulative[i] = sum > 0 ? float(running[i] * scale) : 0.5f * (cosines_[i] + 1);
  }
}

PhaseFunction PhaseFunction::table(const PhaseTable &t) {
  PhaseFunction p(PhaseKind::Table, 0);
  const size_t rows = size_t(t.n_wavelengths), n = size_t(t.n_angles);
  const size_t places = size_t(std::max(1, t.n_elevations)) * size_t(std::max(1, t.n_clocks));
  p.n_rows_ = t.n_wavelengths, p.n_nodes_ = t.n_angles;
  p.wavelengths_.assign(t.wavelengths, t.wavelengths + rows);
  p.cosines_.resize(n);
  for (size_t i = 0; i < n; ++i) p.cosines_[n - 1 - i] = float(std::cos(double(t.angles[i])));
  p.cosines_.front() = -1, p.cosines_.back() = 1;
  p.build_guide();
  const auto reversed = [&](const float *from, float least) {  // over ascending cosines
    std::vector<float> to(places * rows * n);
    for (size_t r = 0; r < places * rows; ++r)
      for (size_t i = 0; i < n; ++i) to[r * n + n - 1 - i] = std::max(least, from[r * n + i]);
    return to;
  };
  const auto by_angle = [&](const std::vector<float> &from) {
    std::vector<float> to(from.size());
    for (size_t place = 0; place < from.size() / (rows * n); ++place)
      for (size_t r = 0; r < rows; ++r)
        for (size_t i = 0; i < n; ++i) to[p.slot(place, i) + r] = from[(place * rows + r) * n + i];
    return to;
  };
  std::vector<float> every = reversed(t.values, 0), mean(rows * n, 0.0f);
  if (t.polarization) p.degree_ = by_angle(reversed(t.polarization, -1));
  p.cumulative_.resize(rows * n);
  for (size_t r = 0; r < places * rows; ++r) {
    p.normalise(&every[r * n], nullptr);
    for (size_t i = 0; i < n; ++i) mean[r % rows * n + i] += every[r * n + i];
  }
  for (size_t r = 0; r < rows; ++r) p.normalise(&mean[r * n], &p.cumulative_[r * n]);
  p.values_ = by_angle(mean);
  if (places > 1) {
    p.oriented_ = by_angle(every);
    p.elevations_.assign(t.elevations, t.elevations + std::max(1, t.n_elevations));
    p.clocks_.assign(t.clocks, t.clocks + std::max(1, t.n_clocks));
  }
  return p;
}

// Two nodes a step on the mean: what is left to search is short.
void PhaseFunction::build_guide() {
  const size_t steps = std::max<size_t>(1, cosines_.size() / 2);
  guide_.resize(steps + 1);
  for (size_t i = 0; i <= steps; ++i) {
    const float cosine = -1 + 2 * float(i) / float(steps);
    guide_[i] = uint32_t(std::upper_bound(cosines_.begin() + 1, cosines_.end() - 1, cosine) - cosines_.begin());
  }
  const float span = wavelengths_.back() - wavelengths_.front();
  if (n_rows_ < 2 || !(span > 0)) return;
  const float per_nm = float(n_rows_ - 1) / span;
  for (int i = 0; i < n_rows_; ++i)
    if (std::abs((wavelengths_[size_t(i)] - wavelengths_[0]) * per_nm - float(i)) > 1e-4f) return;
  per_nm_ = per_nm;
}

void PhaseFunction::rows(float nm, int &first, int &second, float &weight) const {
  if (per_nm_ > 0) {
    const float x = clamp((nm - wavelengths_[0]) * per_nm_, 0.0f, float(n_rows_ - 1));
    first = std::min(int(x), n_rows_ - 2), second = first + 1;
    weight = x - float(first);
    return;
  }
  const auto it = std::upper_bound(wavelengths_.begin(), wavelengths_.end(), nm);
  second = std::clamp(int(it - wavelengths_.begin()), 0, n_rows_ - 1);
  first = std::max(0, int(it - wavelengths_.begin()) - 1);
  weight =
      second > first ? (nm - wavelengths_[size_t(first)]) / (wavelengths_[size_t(second)] - wavelengths_[size_t(first)]) : 0.0f;
}

size_t PhaseFunction::interval(float cosine, float &within) const {
  const size_t steps = guide_.size() - 1;
  const size_t step = size_t(clamp(0.5f * (cosine + 1) * float(steps), 0.0f, float(steps - 1)));
  // One step to either side makes up for rounding.
  const uint32_t low = guide_[step > 0 ? step - 1 : 0], high = guide_[std::min(step + 2, steps)];
  const auto it =
      std::upper_bound(cosines_.begin() + low, cosines_.begin() + std::min<size_t>(high, cosines_.size() - 1), cosine);
  const size_t i = size_t(it - cosines_.begin());
  const float span = cosines_[i] - cosines_[i - 1];
  within = span > 0 ? saturate((cosine - cosines_[i - 1]) / span) : 0.0f;
  return i - 1;
}

float PhaseFunction::row_sample(int row, float u) const {
  const float *c = &cumulative_[size_t(row) * size_t(n_nodes_)];
  const size_t i = size_t(std::upper_bound(c + 1, c + n_nodes_ - 1, u) - c);
  // Within the interval the density is linear: solve the quadratic for the part of its mass below u.
  const float span = cosines_[i] - cosines_[i - 1], mass = c[i] - c[i - 1];
  if (!(span > 0) || !(mass > 0)) return cosines_[i - 1];
  const float target = saturate((u - c[i - 1]) / mass);
  const float a = values_[slot(0, i - 1) + size_t(row)], b = values_[slot(0, i) + size_t(row)];
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
      float weight, within;
      rows(nm, first, second, weight);
      const float *near = &values_[slot(0, interval(cosine, within))], *far = near + n_rows_;
      return lerp(lerp(near[first], far[first], within), lerp(near[second], far[second], within), weight);
    }
  }
  return 0;
}

Spectrum PhaseFunction::value(const Wavelengths &w, float cosine) const {
  if (kind_ != PhaseKind::Table) return Spectrum(value(w.nm[0], cosine));
  Spectrum s;
  float within;
  const float *near = &values_[slot(0, interval(cosine, within))], *far = near + n_rows_;
  for (int i = 0; i < kWavelengths; ++i) {
    int first, second;
    float weight;
    rows(w.nm[i], first, second, weight);
    s[i] = lerp(lerp(near[first], far[first], within), lerp(near[second], far[second], within), weight);
  }
  return s;
}

int PhaseFunction::places(const Vec3 &light, const Vec3 &onward, size_t place[4], float weight[4]) const {
  place[0] = 0, weight[0] = 1;
  if (oriented_.empty()) return 1;
  const auto between = [](const std::vector<float> &nodes, float x, size_t &first, float &t) {
    const auto it = std::upper_bound(nodes.begin(), nodes.end(), x);
    first = size_t(
        std::clamp<std::ptrdiff_t>(it - nodes.begin() - 1, 0, std::max<std::ptrdiff_t>(0, std::ptrdiff_t(nodes.size()) - 2)));
    t = nodes.size() > 1 ? saturate((x - nodes[first]) / std::max(nodes[first + 1] - nodes[first], 1e-9f)) : 0.0f;
  };
  const float elevation = std::asin(clamp(-light.z, -1.0f, 1.0f));
  const Vec3 up = Vec3{0, 0, 1} - light * light.z, side = cross(light, up), seen = -onward;
  const float clock = std::atan2(std::abs(dot(seen, side)), dot(seen, up));
  size_t e, c;
  float te, tc;
  between(elevations_, elevation, e, te);
  between(clocks_, clock, c, tc);
  int count = 0;
  for (size_t k = 0; k < 4; ++k) {
    const float part = (k / 2 ? te : 1 - te) * (k % 2 ? tc : 1 - tc);
    if (!(part > 0)) continue;
    place[count] = (e + k / 2) * clocks_.size() + c + k % 2;
    weight[count++] = part;
  }
  return count;
}

Spectrum PhaseFunction::scattered(const Wavelengths &w, const Vec3 &light, const Vec3 &onward, const Polariser *filter) const {
  const float cosine = dot(light, onward);
  const bool filtered = filter && filter->present;
  if (kind_ == PhaseKind::Rayleigh && filtered) {
    const float degree = (1 - sqr(cosine)) / (1 + sqr(cosine));
    return value(w, cosine) * filter->factor(degree, light, onward);
  }
  if (kind_ != PhaseKind::Table || (oriented_.empty() && !(filtered && !degree_.empty()))) return value(w, cosine);
  const std::vector<float> &table = oriented_.empty() ? values_ : oriented_;
  size_t place[4];
  float weight[4];
  const int n = places(light, onward, place, weight);
  float within;
  const size_t node = interval(cosine, within);
  // Light fully perpendicular and fully parallel pass by these; mixtures by the mixture.
  const float passed = filtered && !degree_.empty() ? filter->factor(1, light, onward) - 1 : 0.0f;
  Spectrum sum(0.0f);
  for (int k = 0; k < kWavelengths; ++k) {
    int row[2];
    float second;
    rows(w.nm[k], row[0], row[1], second);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 2; ++j) {
        const size_t at = slot(place[i], node) + size_t(row[j]), next = at + size_t(n_rows_);
        float v = lerp(table[at], table[next], within);
        if (passed != 0) v *= 1 + passed * lerp(degree_[at], degree_[next], within);
        sum[k] += weight[i] * (j ? second : 1 - second) * v;
      }
  }
  return sum;
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
