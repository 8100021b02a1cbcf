// SPDX-License-Identifier: GPL-3.0-or-later
// The spectral film: equal bins between the render's first and last wavelength, each the mean spectral radiance in it.
#pragma once

#include "core/spectrum.h"
#include "opal.h"

namespace opal {

struct SpectralBin {
  uint32_t index;
  float value;
};

// What wavelength k of a path adds to the bin it falls in: radiance / (pdf * kWavelengths * bin width).
inline SpectralBin spectral_bin(const opal_render_settings &settings, const Wavelengths &w, int k, float radiance) {
  const float width = (settings.wavelength_last - settings.wavelength_first) / float(settings.spectral_bins);
  const int i = int((w.nm[k] - settings.wavelength_first) / width);
  return {uint32_t(std::clamp(i, 0, settings.spectral_bins - 1)), radiance / (w.pdf[k] * kWavelengths * width)};
}

}  // namespace opal
