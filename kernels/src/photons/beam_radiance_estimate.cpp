// SPDX-License-Identifier: GPL-3.0-or-later
// The beam radiance estimate (Jarosz, Zwicker & Jensen 2008, "The Beam Radiance Estimate for Volumetric Photon Mapping",
// equation 15): the whole ray at once, no march. Photons are discs that face the ray:
//
//   L = sum over photons of  T(ray to its foot)  f(theta)  flux  K(d)
//
// with d the photon's distance from the ray and K Epanechnikov's kernel 2/(pi r2) (1 - d2/r2), which integrates to 1
// over the disc. Photons were left at scattering events, so no coefficient appears. A face met at an angle cuts discs on its
// inner side as much as it leaves over of those beyond it: these are counted too, as far as they reach in.
#include "photons/volume_estimate.h"

#include "photons/photon_map.h"

namespace opal {

Spectrum beam_radiance_estimate(const VolumeMap &map, const VolumeQuery &q) {
  const float r2 = sqr(map.radius()), scale = 2 * kInvPi / r2;
  Spectrum sum(0.0f);
  const auto reach = [&](const Vec3 &normal) {  // along the ray, of a disc on the face
    const float cosine = std::abs(dot(q.direction, normal));
    return !(length_squared(normal) > 0)
               ? 0.0f
               : map.radius() * std::min(std::sqrt(1 - std::min(1.0f, sqr(cosine))) / std::max(cosine, 1e-3f), 4.0f);
  };
  const float before = reach(q.faces.begin), after = reach(q.faces.end);
  const auto visit = [&](const VolumePhoton &photon, float foot, float d2) {
    if (photon.media != q.media || q.beyond(photon.position)) return;
    const float t = clamp(foot, 0.0f, q.t_end);
    const Spectrum scattered =
        q.way.at(t).scattered(q.w, unpack_direction(photon.direction), -q.direction, q.filter) * q.way.transmittance(t);
    const float kernel = scale * (1 - d2 / r2);
    for (int k = 0; k < kWavelengths; ++k)
      sum[k] += photon.flux[PassContext::position_of(q.index, uint32_t(k))] * scattered[k] * kernel;
  };
  map.discs(q.origin - q.direction * before, q.direction, before + q.t_end + after, PassContext::set_of(q.index),
            [&](const VolumePhoton &photon, float t, float d2) { visit(photon, t - before, d2); });
  return sum;
}

}  // namespace opal
