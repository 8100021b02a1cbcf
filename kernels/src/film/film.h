// SPDX-License-Identifier: GPL-3.0-or-later
// The film: sums over passes of what the pixels of the region received.
//
// A pass is added as a whole, once it is complete. Values are rounded to multiples of 2^-32 and summed in double
// precision, so sums are exact up to 2^21 and do not depend on the order of passes: parts of a render that were made on
// several machines add up to the same bits as one render.
#pragma once

#include "core/vec.h"
#include "opal.h"

#include <cstdint>
#include <vector>

namespace opal {

// How many values a pixel of the pass has when read; spectral: as many as bins.
int pass_channels(int pass, int spectral_bins);

// One pass's pixels while it is rendered: single precision, every enabled output.
struct PassBuffer {
  void allocate(int width, int height, uint32_t passes, int spectral_bins);
  float *at(int pass, size_t pixel) { return values[pass].data() + pixel * size_t(channels[pass]); }
  bool has(int pass) const { return !values[pass].empty(); }

  std::vector<float> values[OPAL_PASS_COUNT];
  int channels[OPAL_PASS_COUNT] = {};
};

class Film {
 public:
  void allocate(int width, int height, uint32_t passes, int spectral_bins);
  // Adds a complete pass. `pass_number`: the depth of the lowest-numbered pass is the one kept, since depths do not mix.
  void add(const PassBuffer &buffer, int pass_number);
  // Means over the passes added; false when the pass is not kept.
  bool read(int pass, float *out) const;
  // The sums themselves (NOISE: of squared luminance); false when the pass is not kept.
  bool read_sums(int pass, double *out) const;
  int depth_pass() const { return depth_pass_; }
  // Mean over pixels of the luminance's standard error, relative to the mean luminance; negative before two passes.
  float noise() const;

  int width = 0, height = 0, spectral_bins = 0;
  uint32_t passes = 0;
  int n_passes = 0;
  int64_t memory_bytes() const;

 private:
  size_t n_pixels() const { return size_t(width) * size_t(height); }
  double standard_error(size_t pixel) const;

  std::vector<double> sums_[OPAL_PASS_COUNT];
  std::vector<double> luminance_squared_;  // sum over passes, for the noise estimate
  int depth_pass_ = -1;
};

}  // namespace opal
