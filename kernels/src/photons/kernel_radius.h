// SPDX-License-Identifier: GPL-3.0-or-later
// The radius within which photons count, and how passes shrink it.
#pragma once

#include "opal.h"
#include "scene/scene.h"

namespace opal {

// Four pixels' width where the nearest thing that makes caustics stands, metres.
float pixel_footprint(const Scene &scene, const opal_render_settings &settings);

// Of photons on surfaces in pass 0, 1, ...: settings.radius or, if that is 0, the pixel footprint, shrunk.
float surface_radius(const Scene &scene, const opal_render_settings &settings, int pass);

// The factor on the first pass's radius by which kernels of 1, 2 or 3 dimensions are smaller in a later pass: their volume
// shrinks by (i + alpha) / (i + 1) from pass i to the next (Knaus & Zwicker 2011, equation 20). `shrink` is alpha for two
// dimensions. The error is least for 4/5, 2/3 and 4/7 in one, two and three, so the others follow from shrink in that way.
float radius_factor(int dimensions, float shrink, int pass);

}  // namespace opal
