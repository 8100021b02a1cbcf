// SPDX-License-Identifier: GPL-3.0-or-later
// See colour.h. Equations: PHYSICS section 3; hero wavelengths: Wilkie et al. 2014.
#include "core/colour.h"

namespace opal {
namespace {

// IEC 61966-2-1 (Rec.709 primaries, D65 white): XYZ to linear RGB.
constexpr double kXyzToRgb[3][3] = {{3.2404541621, -1.5371385128, -0.4985314096},
                                    {-0.9692660305, 1.8760108454, 0.0415560175},
                                    {0.0556434310, -0.2040259135, 1.0572251882}};

// The part of wavelengths that is spread evenly, so that no part of the range is starved in a spectral film.
constexpr float kEvenShare = 0.05f;

}  // namespace

void ColourTables::prepare(const opal_tables &tables, float first, float last) {
  // Whole nanometres, as the tables have them: a range between two nodes would have no probability at all.
  first_nm = std::floor(clamp(first, float(kTableFirst), float(kTableFirst + kTableSize - 2)));
  last_nm = std::ceil(clamp(last, first_nm + 1, float(kTableFirst + kTableSize - 1)));
  const auto inside = [&](int i) {
    // Trapezoid weight of sample i within [first, last]: the sum below equals the integral that sampling estimates.
    const double nm = kTableFirst + i;
    if (nm < first_nm || nm > last_nm) return 0.0;
    return nm == first_nm || nm == last_nm ? 0.5 : 1.0;
  };

  for (int i = 0; i < kTableSize; ++i) d65[i] = tables.d65[i];
  // D65 in the chosen range must come out as (1,1,1) whatever the range: each channel is renormalised.
  double rgb_of_d65[3] = {0, 0, 0}, luminance_of_one = 0;
  for (int i = 0; i < kTableSize; ++i) {
    for (int c = 0; c < 3; ++c) {
      double r = 0;
      for (int k = 0; k < 3; ++k) r += kXyzToRgb[c][k] * tables.observer[k * kTableSize + i];
      rgb_response[c][i] = float(r);
      rgb_of_d65[c] += r * tables.d65[i] * inside(i);
    }
    luminance_of_one += double(tables.observer[kTableSize + i]) * inside(i);
    for (int c = 0; c < 3; ++c) basis[c][i] = tables.basis[c * kTableSize + i];
  }
  // d65 is scaled to luminance 1, in units in which a spectrum of 1 everywhere has luminance 1 too; what remains per
  // channel is rounding and the cut range.
  const double scale = 1.0 / (0.2126729 * rgb_of_d65[0] + 0.7151522 * rgb_of_d65[1] + 0.0721750 * rgb_of_d65[2]);
  for (int i = 0; i < kTableSize; ++i) d65[i] = float(d65[i] * scale * luminance_of_one);
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < kTableSize; ++i)
      rgb_response[c][i] = float(rgb_response[c][i] / (rgb_of_d65[c] * scale * luminance_of_one));

  // Behind dispersion a path brings the light of its hero alone. Its variance, summed over the channels, is least where the
  // density follows the root of their summed squared responses to D65; but its valleys leave too much to single wavelengths
  // where eight share a path, and white is tinted more. Smoothed over 40 nm it is better for both than the visible-wavelength
  // density of pbrt-v4 (Radziszewski et al. 2009): 5.1 times the squared mean instead of 5.9, and eight wavelengths of white
  // are off by 1.4, 1.1 and 6.1 % in red, green and blue instead of 2.1, 0.9 and 7.3 %.
  SpectralTable best;
  for (int i = 0; i < kTableSize; ++i)
    best[i] = d65[i] * std::sqrt(sqr(rgb_response[0][i]) + sqr(rgb_response[1][i]) + sqr(rgb_response[2][i]));
  constexpr float kSmoothing = 40;
  float sum = 0;
  for (int i = 0; i < kTableSize; ++i) {
    smooth[i] = 0;
    for (int k = 0; k < kTableSize; ++k) smooth[i] += best[k] * std::exp(-0.5f * sqr(float(i - k) / kSmoothing));
    sum += smooth[i];
  }
  for (float &density : smooth) density += sum * (kEvenShare / (1 - kEvenShare) / kTableSize);
  weigh({}, 1.0f);
}

void ColourTables::weigh(const std::vector<SpectralTable> &shares, float smooth_share) {
  using Density = std::array<double, kTableSize>;
  // The probability of each interval between nodes, by the trapezoid rule, which is exact for what is linear between them.
  const auto mass = [&](const Density &d, int i) {
    const double nm = kTableFirst + i + 0.5;
    return nm > first_nm && nm < last_nm ? 0.5 * (d[size_t(i)] + d[size_t(i) + 1]) : 0.0;
  };
  const auto total = [&](const Density &d) {
    double sum = 0;
    for (int i = 0; i + 1 < kTableSize; ++i) sum += mass(d, i);
    return sum;
  };
  Density mixed{};
  const auto widened = [](const SpectralTable &table) {
    Density d{};
    for (size_t i = 0; i < d.size(); ++i) d[i] = double(table[i]);
    return d;
  };
  std::vector<Density> own;
  for (const SpectralTable &share : shares)
    if (const Density d = widened(share); total(d) > 0) own.push_back(d);
  const double of_smooth = own.empty() ? 1.0 : double(smooth_share);
  const auto add = [&](const Density &d, double part) {
    const double scale = part / total(d);
    for (size_t i = 0; i < d.size(); ++i) mixed[i] += d[i] * scale;
  };
  add(widened(smooth), of_smooth);
  for (const Density &d : own) add(d, (1 - of_smooth) / double(own.size()));

  const double sum = total(mixed);
  double running = 0;
  for (int i = 0; i < kTableSize; ++i) {
    pdf[size_t(i)] = float(mixed[size_t(i)] / sum);
    cdf[size_t(i)] = float(running / sum);
    if (i + 1 < kTableSize) running += mass(mixed, i);
  }
}

Wavelengths ColourTables::sample(float u) const {
  Wavelengths w;
  for (int k = 0; k < kWavelengths; ++k) {
    float x = u + float(k) / kWavelengths;
    x -= std::floor(x);
    // The last interval whose cumulative value is not above x, among those with any probability.
    int i = int(std::upper_bound(cdf.begin(), cdf.end(), x) - cdf.begin()) - 1;
    i = std::clamp(i, 0, kTableSize - 2);
    while (i > 0 && cdf[i + 1] <= cdf[i]) --i;
    while (i < kTableSize - 2 && cdf[i + 1] <= cdf[i]) ++i;
    // Inverse of the quadratic that a linear density integrates to, in the form that does not cancel.
    const float y = clamp((x - cdf[i]) / (cdf[i + 1] - cdf[i]), 0.0f, 1.0f), a = pdf[i], b = pdf[i + 1];
    const float f = clamp(y * (a + b) / (a + std::sqrt(std::max(a * a + y * (b * b - a * a), 0.0f))), 0.0f, 1.0f);
    w.nm[k] = float(kTableFirst + i) + f;
    w.pdf[k] = lerp(a, b, f);
    const float scale = 1 / (w.pdf[k] * kWavelengths);
    for (int c = 0; c < 3; ++c) {
      w.basis[c][k] = lerp(basis[c][i], basis[c][i + 1], f);
      w.to_rgb[c][k] = lerp(rgb_response[c][i], rgb_response[c][i + 1], f) * scale;
    }
    w.d65[k] = lerp(d65[i], d65[i + 1], f);
  }
  return w;
}

Vec3 ColourTables::response(float nm) const {
  return {lookup(rgb_response[0], nm), lookup(rgb_response[1], nm), lookup(rgb_response[2], nm)};
}

}  // namespace opal
