// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film.h"

namespace opal {
namespace {

double quantize(float value) {
  constexpr double kSteps = 4294967296.0;
  return std::isfinite(value) ? std::nearbyint(double(value) * kSteps) / kSteps : 0.0;
}

double luminance_of(const double *rgb) { return 0.2126729 * rgb[0] + 0.7151522 * rgb[1] + 0.0721750 * rgb[2]; }

bool is_kept(uint32_t passes, int pass, int spectral_bins) {
  if (pass == OPAL_PASS_NOISE) return false;  // derived from Combined
  if (pass == OPAL_PASS_SPECTRAL && spectral_bins <= 0) return false;
  return pass == OPAL_PASS_COMBINED || (passes >> pass & 1u);
}

}  // namespace

int pass_channels(int pass, int spectral_bins) {
  switch (pass) {
    case OPAL_PASS_COMBINED:
    case OPAL_PASS_LAYER_BASE:
    case OPAL_PASS_LAYER_BEHIND:
    case OPAL_PASS_LAYER_CAUSTICS:
    case OPAL_PASS_LAYER_GEMS:
    case OPAL_PASS_LAYER_MEDIA:
    case OPAL_PASS_LAYER_RAINBOW:
    case OPAL_PASS_LAYER_DIMMED: return 4;
    case OPAL_PASS_DEPTH:
    case OPAL_PASS_NOISE: return 1;
    case OPAL_PASS_SPECTRAL: return spectral_bins;
    default: return 3;
  }
}

void PassBuffer::allocate(int width, int height, uint32_t passes, int spectral_bins) {
  for (int p = 0; p < OPAL_PASS_COUNT; ++p) {
    channels[p] = pass_channels(p, spectral_bins);
    if (is_kept(passes, p, spectral_bins)) values[p].assign(size_t(width) * size_t(height) * size_t(channels[p]), 0.0f);
  }
}

void Film::allocate(int width_, int height_, uint32_t passes_, int bins) {
  width = width_, height = height_, passes = passes_, spectral_bins = bins;
  for (int p = 0; p < OPAL_PASS_COUNT; ++p)
    if (is_kept(passes, p, bins)) sums_[p].assign(n_pixels() * size_t(pass_channels(p, bins)), 0.0);
  luminance_squared_.assign(n_pixels(), 0.0);
}

void Film::add(const PassBuffer &buffer, int pass_number) {
  for (int p = 0; p < OPAL_PASS_COUNT; ++p) {
    if (!buffer.has(p) || sums_[p].empty()) continue;
    if (p == OPAL_PASS_DEPTH) {
      if (depth_pass_ >= 0 && depth_pass_ < pass_number) continue;
      depth_pass_ = pass_number;
      for (size_t i = 0; i < sums_[p].size(); ++i) sums_[p][i] = double(buffer.values[p][i]);
      continue;
    }
    for (size_t i = 0; i < sums_[p].size(); ++i) sums_[p][i] += quantize(buffer.values[p][i]);
  }
  const std::vector<float> &combined = buffer.values[OPAL_PASS_COMBINED];
  for (size_t i = 0; i < n_pixels(); ++i) {
    const double rgb[3] = {combined[4 * i], combined[4 * i + 1], combined[4 * i + 2]};
    const double y = luminance_of(rgb);
    luminance_squared_[i] += quantize(float(y * y));
  }
  ++n_passes;
}

double Film::standard_error(size_t pixel) const {
  const double n = n_passes;
  const double mean = luminance_of(&sums_[OPAL_PASS_COMBINED][pixel * 4]) / n;
  const double variance = std::max(0.0, luminance_squared_[pixel] / n - mean * mean) / (n - 1);
  return std::sqrt(variance);
}

bool Film::read(int pass, float *out) const {
  if (pass == OPAL_PASS_NOISE) {
    for (size_t i = 0; i < n_pixels(); ++i) out[i] = n_passes > 1 ? float(standard_error(i)) : 0.0f;
    return true;
  }
  if (pass < 0 || pass >= OPAL_PASS_COUNT || sums_[pass].empty()) return false;
  const double scale = pass == OPAL_PASS_DEPTH ? 1.0 : n_passes > 0 ? 1.0 / n_passes : 0.0;
  for (size_t i = 0; i < sums_[pass].size(); ++i) out[i] = float(sums_[pass][i] * scale);
  return true;
}

bool Film::read_sums(int pass, double *out) const {
  if (pass < 0 || pass >= OPAL_PASS_COUNT) return false;
  const std::vector<double> &sums = pass == OPAL_PASS_NOISE ? luminance_squared_ : sums_[pass];
  std::copy(sums.begin(), sums.end(), out);
  return !sums.empty();
}

float Film::noise() const {
  if (n_passes < 2) return -1;
  double error = 0, mean = 0;
  for (size_t i = 0; i < n_pixels(); ++i) {
    error += standard_error(i);
    mean += std::max(0.0, luminance_of(&sums_[OPAL_PASS_COMBINED][i * 4]) / n_passes);
  }
  return mean > 0 ? float(error / mean) : 0.0f;
}

int64_t Film::memory_bytes() const {
  size_t n = luminance_squared_.size();
  for (const auto &sums : sums_) n += sums.size();
  return int64_t(n * sizeof(double));
}

}  // namespace opal
