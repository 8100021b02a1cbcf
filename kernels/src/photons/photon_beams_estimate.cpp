// SPDX-License-Identifier: GPL-3.0-or-later
// The beam-beam estimate with a 1-D kernel (Jarosz, Nowrouzezahrai, Sadeghi & Jensen 2011, "A Comprehensive Theory of
// Volumetric Radiance Estimation Using Photon Points and Beams", section 5.3; long beams, transmittance in closed form):
//
//   L = sum over beams of  flux  sigma_s  f(theta)  T(ray to t)  T(beam to s)  K(u) / sin(theta)
//
// with u the distance between the lines and K Epanechnikov's kernel 3/(4r) (1 - u2/r2), which integrates to 1 over
// -r..r. Nothing is clamped: the peak of 1/sin is integrable.
#include "photons/volume_estimate.h"

namespace opal {

Spectrum photon_beams_estimate(const VolumeMap &map, const VolumeQuery &q) {
  const float r = map.radius(), scale = 0.75f / r;
  Spectrum sum(0.0f);
  map.crossings(q.origin, q.direction, q.t_end, PassContext::set_of(q.index), [&](const PhotonBeam &beam, const Crossing &c) {
    if (beam.media != q.media) return;
    const float kernel = scale * (1 - sqr(c.distance / r)) / c.sine;
    const MediumHere &here = q.way.at(c.t);
    if (!here.scatters()) return;
    const Spectrum scattered =
        here.scattering * here.scattered(q.w, beam.direction, -q.direction, q.filter) * q.way.transmittance(c.t);
    Spectrum flux, depth;
    for (int k = 0; k < kWavelengths; ++k) {
      const uint32_t at = PassContext::position_of(q.index, uint32_t(k));
      flux[k] = beam.flux[at], depth[k] = beam.extinction[at] * -c.s;
    }
    sum += flux * exp(depth) * scattered * kernel;
  });
  return sum;
}

}  // namespace opal
