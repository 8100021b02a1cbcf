// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/gather.h"

#include "integrator/pass.h"

namespace opal {
namespace {

constexpr int kMostPhotons = 512;

struct Found {
  float distance2;
  const Photon *photon;
  bool operator<(const Found &b) const { return distance2 < b.distance2; }
};

}  // namespace

Spectrum gather_photons(const PhotonMap &map, const Surface &surface, const Wavelengths &w, uint32_t index, int most) {
  const ShadingPoint &sp = surface.sp;
  most = std::clamp(most, 2, kMostPhotons);
  Found found[kMostPhotons];
  int count = 0;
  bool full = false;  // more photons than wanted: the heap holds the nearest
  map.query(sp.p, PassContext::set_of(index), [&](const Photon &photon, float d2) {
    // A photon on the other side, or far off the tangent plane, lies on another surface.
    const Vec3 normal = unpack_direction(photon.normal);
    if (dot(normal, sp.ng) < 0.5f && !surface.transmissive) return;
    if (sqr(dot(photon.position - sp.p, sp.ng)) > 0.25f * map.radius() * map.radius()) return;
    if (count < most) {
      found[count++] = {d2, &photon};
      if (count == most) std::make_heap(found, found + count), full = true;
    } else if (d2 < found[0].distance2) {
      std::pop_heap(found, found + count);
      found[count - 1] = {d2, &photon};
      std::push_heap(found, found + count);
    }
  });
  Spectrum sum(0.0f);
  if (count == 0) return sum;
  // With the n nearest, the farthest sets the disc and does not count itself (an unbiased density estimate).
  const float radius2 = full ? found[0].distance2 : map.radius() * map.radius();
  for (int i = full ? 1 : 0; i < count; ++i) {
    const Photon &photon = *found[i].photon;
    const Vec3 wi = unpack_direction(photon.direction);
    const float cosine = std::abs(dot(wi, sp.ns));
    if (!(cosine > 1e-6f)) continue;
    const Spectrum f = bsdf_eval_rough(surface.closures, sp, wi, w, Transport::Radiance) / cosine;
    for (int k = 0; k < kWavelengths; ++k) sum[k] += f[k] * photon.flux[PassContext::position_of(index, uint32_t(k))];
  }
  return sum / (kPi * radius2);
}

}  // namespace opal
