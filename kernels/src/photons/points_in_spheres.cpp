// SPDX-License-Identifier: GPL-3.0-or-later
// Jensen & Christensen's march (1998, "Efficient Simulation of Light Transport in Scenes with Participating Media using
// Photon Maps"), with the transmittance. A step from a to b adds
//
//   S(t) (exp(-sigma_t a) - exp(-sigma_t b)) / sigma_t,      S = sum f flux / (4/3 pi r3)
//
// over the n photons nearest the place t, within the map's radius; what boundaries cut off the sphere, taken as flat, is not
// counted in its volume. t is jittered within the step with the density of the
// transmittance, so that the step count decides on noise alone. Steps are halved where the source differs from their
// neighbour's by more than the tolerance; the photons asked about that are those of another wavelength set, because an
// estimate that chose its own places by its own photons would be biased.
#include "photons/volume_estimate.h"

#include "photons/photon_map.h"

#include <algorithm>

namespace opal {
namespace {

constexpr int kMostPhotons = 512, kMostSteps = 256, kMostHalvings = 4;

struct Found {
  float distance2;
  const VolumePhoton *photon;
  bool operator<(const Found &b) const { return distance2 < b.distance2; }
};

class March {
 public:
  March(const VolumeMap &map, const opal_render_settings &settings, const VolumeQuery &query)
      : map_(map),
        q_(query),
        set_(PassContext::set_of(query.index)),
        tolerance_(settings.march_tolerance),
        most_(std::clamp(settings.gather, 2, kMostPhotons)) {}

  Spectrum along(float from, float to, int steps) {
    const float dt = (to - from) / float(steps);
    float before = -1;
    for (int i = 0; i < steps; ++i) {
      const float a = from + float(i) * dt, b = i + 1 == steps ? to : from + float(i + 1) * dt;
      const float here = tolerance_ > 0 ? pilot(a, b) : 0;
      march(a, b, here, i > 0 ? before : here, kMostHalvings);
      before = here;
    }
    return sum_;
  }

 private:
  // `here`, `before`: pilots of this step and of the one nearer to the eye.
  void march(float a, float b, float here, float before, int halvings) {
    if (halvings > 0 && std::abs(here - before) > tolerance_ * std::max(here, before)) {
      const float middle = 0.5f * (a + b), near = pilot(a, middle), far = pilot(middle, b);
      march(a, middle, near, before, halvings - 1);
      march(middle, b, far, near, halvings - 1);
      return;
    }
    const float sigma = q_.way.falloff();
    const float share = -std::expm1(-sigma * (b - a));  // of the light from a on that is lost before b
    const float t = share > 1e-6f ? a - std::log1p(-q_.jitter * share) / sigma : lerp(a, b, q_.jitter);
    const float step = share > 1e-6f ? share / (sigma * std::exp(-sigma * (t - a))) : b - a;  // 1 / density of t
    sum_ += q_.way.transmittance(t) * source(t, set_) * step;
  }

  // An estimate for the step as a whole that is independent of those which are added.
  float pilot(float a, float b) const { return source(0.5f * (a + b), (set_ + 1) % kWavelengthSets).sum(); }

  // Light scattered towards the eye at distance t, per metre.
  Spectrum source(float t, uint32_t set) const {
    Found found[kMostPhotons];
    int count = 0;
    bool full = false;
    float radius2 = sqr(map_.radius());
    map_.near(
        q_.origin + q_.direction * t, set,
        [&](const VolumePhoton &photon, float d2) {
          if (photon.media != q_.media || q_.beyond(photon.position)) return;
          if (full) std::pop_heap(found, found + count--);
          found[count++] = {d2, &photon};
          if (full) std::push_heap(found, found + count);
          else if (count == most_) std::make_heap(found, found + count), full = true;
          if (full) radius2 = found[0].distance2;
        },
        [&] { return radius2; });
    Spectrum sum(0.0f);
    if (count == 0) return sum;
    const MediumHere &here = q_.way.at(t);
    // With the n nearest, the farthest sets the sphere and does not count itself (an unbiased density estimate).
    for (int i = full ? 1 : 0; i < count; ++i) {
      const VolumePhoton &photon = *found[i].photon;
      const Spectrum phase = here.scattered(q_.w, unpack_direction(photon.direction), -q_.direction, q_.filter);
      for (int k = 0; k < kWavelengths; ++k) sum[k] += photon.flux[PassContext::position_of(q_.index, uint32_t(k))] * phase[k];
    }
    return sum / volume_within(t, std::sqrt(radius2));
  }

  // Of a sphere round the place t, on the inner side of the faces.
  float volume_within(float t, float radius) const {
    const auto beyond = [&](float height) {  // the cap cut off at this height above the centre
      return height < radius ? kPi / 3 * sqr(radius - height) * (2 * radius + height) : 0.0f;
    };
    const float whole = 4.0f / 3.0f * kPi * radius * radius * radius;
    float cut = 0;
    if (length_squared(q_.faces.begin) > 0) cut += beyond(t * dot(q_.direction, q_.faces.begin));
    if (length_squared(q_.faces.end) > 0) cut += beyond(-(q_.t_end - t) * dot(q_.direction, q_.faces.end));
    return std::max(whole - cut, 0.1f * whole);
  }

  const VolumeMap &map_;
  const VolumeQuery &q_;
  const uint32_t set_;
  const float tolerance_;
  const int most_;
  Spectrum sum_{0.0f};
};

}  // namespace

Spectrum points_in_spheres(const VolumeMap &map, const opal_render_settings &settings, const VolumeQuery &q) {
  float from = 0, to = q.t_end;
  if (!map.clip(q.origin, q.direction, PassContext::set_of(q.index), from, to)) return Spectrum(0.0f);
  return March(map, settings, q).along(from, to, std::clamp(settings.march_steps, 1, kMostSteps));
}

}  // namespace opal
