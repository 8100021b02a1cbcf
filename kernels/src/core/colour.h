// SPDX-License-Identifier: GPL-3.0-or-later
// Colour at the two ends: the tables handed in by the caller, wavelength sampling, and radiance -> linear Rec.709.
//
// D65 is the white: a light of RGB (1,1,1) emits D65 scaled so that its luminance is 1 (PHYSICS section 3).
#pragma once

#include "core/spectrum.h"
#include "opal.h"

#include <vector>

namespace opal {

struct ColourTables {
  SpectralTable
      rgb_response[3];  // per nm: linear Rec.709 of a unit of spectral radiance (matching functions x matrix / normalisation)
  SpectralTable basis[3];
  SpectralTable d65;                    // scaled to luminance 1; a spectrum of 1 has luminance 1 too
  SpectralTable smooth;                 // where wavelengths of smooth spectra are sampled, up to a factor
  float first_nm = 360, last_nm = 830;  // the sampled range
  // The density of sampled wavelengths: per nm at the table's nodes, linear between them; cdf at the nodes.
  SpectralTable cdf, pdf;

  // Prepares everything for wavelengths first..last. The response outside the range is left out, and the rest
  // renormalised so that D65 stays white. Wavelengths are then sampled as suits smooth spectra.
  void prepare(const opal_tables &tables, float first, float last);
  // Samples wavelengths where the scene's light is. `shares` (not negative) are densities of their own up to a factor;
  // each gets an equal part of what `smooth_share` leaves, so that a lamp of narrow lines is not left to chance.
  void weigh(const std::vector<SpectralTable> &shares, float smooth_share);
  // kWavelengths equally spaced in the cumulative distribution, the hero at u.
  Wavelengths sample(float u) const;
  // Linear Rec.709 of radiance 1 at one wavelength.
  Vec3 response(float nm) const;
};

}  // namespace opal
