// SPDX-License-Identifier: GPL-3.0-or-later
// Sine and cosine of a share of a full turn, for sampling: no library call, error below 3e-7.
#pragma once

#include "core/vec.h"

namespace opal {

// For an angle of x quarter turns, |x| <= 1/2: Taylor's series.
inline void sine_cosine_near_zero(float x, float &sine, float &cosine) {
  const float a = x * (kPi / 2), a2 = a * a;
  sine = a * (1 + a2 * (-1.0f / 6 + a2 * (1.0f / 120 + a2 * (-1.0f / 5040 + a2 * (1.0f / 362880)))));
  cosine = 1 + a2 * (-0.5f + a2 * (1.0f / 24 + a2 * (-1.0f / 720 + a2 * (1.0f / 40320))));
}

// For an angle of u full turns, u in [0,1].
inline void sine_cosine_of_turn(float u, float &sine, float &cosine) {
  const int quarter = int(4 * u + 0.5f);
  float s, c;
  sine_cosine_near_zero(4 * u - float(quarter), s, c);
  const bool swap = quarter & 1;
  sine = swap ? c : s;
  cosine = swap ? s : c;
  if (quarter & 2) sine = -sine;
  if ((quarter + 1) & 2) cosine = -cosine;
}

}  // namespace opal
