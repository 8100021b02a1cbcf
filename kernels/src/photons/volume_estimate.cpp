// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/volume_estimate.h"

namespace opal {

Spectrum volume_radiance(const PassContext &pass, const VolumeQuery &query) {
  switch (pass.settings.volume_estimate) {
    case OPAL_VOLUME_POINTS: return points_in_spheres(pass.volume, pass.settings, query);
    case OPAL_VOLUME_BEAM_RADIANCE: return beam_radiance_estimate(pass.volume, query);
    default: return photon_beams_estimate(pass.volume, query);
  }
}

}  // namespace opal
