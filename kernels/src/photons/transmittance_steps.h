// SPDX-License-Identifier: GPL-3.0-or-later
// Transmittance along a whole ray at once: ratio tracking (Novak, Selle & Jarosz 2014, "Residual Ratio Tracking for Estimating
// Attenuation in Participating Media") leaves a function of distance that is constant between collisions and whose mean is
// the transmittance everywhere. One majorant serves all wavelengths, so every value is between 0 and 1.
#pragma once

#include "media/tracking.h"

namespace opal {

// Calls step(from, to, transmittance) for the pieces of [0, t_end) in order, until nothing is left. Weak rests end by Russian
// roulette.
template <class Step>
void transmittance_steps(RayMedia &media, float t_end, RandomStream random, const Step &step) {
  constexpr float kWeak = 0.25f, kRaised = 0.5f;
  Spectrum through(1.0f);
  float from = 0;
  RayMedia::Interval interval;
  while (media.next(t_end, interval)) {
    const float majorant = interval.majorant.max();
    if (!(majorant > 0)) continue;
    for (float t = interval.begin;;) {
      t -= std::log1p(-random.next()) / majorant;
      if (!(t < interval.end)) break;
      const Spectrum extinction = media.at(t).extinction;
      if (!(extinction.max() > 0)) continue;
      step(from, t, through);
      from = t;
      for (int k = 0; k < kWavelengths; ++k) through[k] *= std::max(0.0f, 1 - extinction[k] / majorant);
      const float strongest = through.max();
      if (!(strongest > 0)) return;
      if (strongest < kWeak) {
        if (!(random.next() * kRaised < strongest)) return;
        through *= kRaised / strongest;
      }
    }
  }
  step(from, t_end, through);
}

}  // namespace opal
