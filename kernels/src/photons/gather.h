// SPDX-License-Identifier: GPL-3.0-or-later
// The estimate of reflected radiance from photons near a point (Jensen 1996; fixed kernel of the pass, at most `most`
// photons, after Hachisuka & Jensen 2009 / Knaus & Zwicker 2011).
#pragma once

#include "integrator/surface.h"
#include "photons/photon_map.h"

namespace opal {

// Radiance towards surface.sp.wo at the path's wavelengths; `index` is the path's number among the pass's wavelengths.
Spectrum gather_photons(const PhotonMap &map, const Surface &surface, const Wavelengths &w, uint32_t index, int most);

}  // namespace opal
