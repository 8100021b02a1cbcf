// SPDX-License-Identifier: GPL-3.0-or-later
// The gem boundary: a dielectric whose index is a spectrum, polished or ground (GGX).
//
// One direction serves all wavelengths where it can: a reflection at a facet is the same for every colour, and only the
// share F(lambda) differs. A refracted direction belongs to the hero wavelength alone when the index disperses; on a ground
// boundary the other wavelengths could have gone there through other facets, and their pdf says how likely.
// Radiance crossing the boundary scales with (n(here)/n(there))^2 at each wavelength, flux does not (Veach 1997, 5.2).
// Set: one lobe of kind Gem (its normal is used), set.gem filled.
#pragma once

#include "bsdf/closure.h"

namespace opal {

bool sample_gem(const ClosureSet &set, const ShadingPoint &sp, Transport transport, float choice, Vec2 u, BsdfSample &out);
// What one wavelength does at its own place on a polished boundary, given that another is reflected or refracted elsewhere on
// it: its direction, the probability with which it would have chosen the same, and the correction of flux for an interpolated
// normal. False: it cannot, or its interpolated normal would not serve for either choice.
bool follow_polished(const GemBoundary &gem, int wavelength, const ShadingPoint &sp, bool transmission, Transport transport,
                     Vec3 &wi, float &share, float &correction);
// f |cos wi| of a ground boundary, 0 of a polished one.
Spectrum eval_gem(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, Transport transport, Spectrum &pdf);

}  // namespace opal
