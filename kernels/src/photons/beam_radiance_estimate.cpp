// SPDX-License-Identifier: GPL-3.0-or-later
// The beam radiance estimate (Jarosz, Zwicker & Jensen 2008, "The Beam Radiance Estimate for Volumetric Photon Mapping",
// equation 15): the whole ray at once, no march. Photons are discs that face the ray:
//
//   L = sum over photons of  T(ray to its foot)  f(theta)  flux  K(d)
//
// with d the photon's distance from the ray and K Epanechnikov's kernel 2/(pi r2) (1 - d2/r2), which integrates to 1
// over the disc. Photons were left at scattering events, so no coefficient appears.
#include "photons/volume_estimate.h"

#include "photons/photon_map.h"

namespace opal {

Spectrum beam_radiance_estimate(const VolumeMap &map, const VolumeQuery &q) {
  const float r2 = sqr(map.radius()), scale = 2 * kInvPi / r2;
  Spectrum sum(0.0f);
  map.discs(q.origin, q.direction, q.t_end, PassContext::set_of(q.index), [&](const VolumePhoton &photon, float t, float d2) {
    if (photon.media != q.media) return;
    const Spectrum scattered =
        q.way.at(t).scattered(q.w, unpack_direction(photon.direction), -q.direction, q.filter) * q.way.transmittance(t);
    const float kernel = scale * (1 - d2 / r2);
    for (int k = 0; k < kWavelengths; ++k)
      sum[k] += photon.flux[PassContext::position_of(q.index, uint32_t(k))] * scattered[k] * kernel;
  });
  return sum;
}

}  // namespace opal
