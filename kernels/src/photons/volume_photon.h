// SPDX-License-Identifier: GPL-3.0-or-later
// What photons leave in media: points where they were scattered, or the straight beams along which they flew.
//
// As on surfaces, a photon and a camera path of the same wavelength set share every wavelength; flux is stored by
// position in the set. `media` tells apart the media of overlapping and touching boundaries: light in the fog round a gem
// is never looked up for the milk inside.
#pragma once

#include "core/spectrum.h"
#include "media/medium.h"

#include <cstdint>

namespace opal {

// The same number for the same set of media, entered in whatever order.
uint32_t media_key(const MediumSet &media);

// A scattering event: flux is what is scattered there (collisions times albedo), in W.
struct VolumePhoton {
  Vec3 position;
  uint32_t direction;  // of flight, packed
  uint32_t media;      // media_key
  uint32_t set;        // of wavelengths, 0..7
  float flux[kWavelengths];
};
static_assert(sizeof(VolumePhoton) <= 64);

// A straight flight: flux(s) = flux exp(-extinction s) for 0 <= s <= length.
struct PhotonBeam {
  Vec3 origin, direction;
  float length;
  uint32_t media;
  uint32_t set;
  float flux[kWavelengths], extinction[kWavelengths];

  Vec3 at(float s) const { return origin + direction * s; }
};
static_assert(sizeof(PhotonBeam) <= 128);

// Where a ray and a beam come nearest: t along the ray, s along the beam.
struct Crossing {
  float t, s, distance, sine;
};
// False for parallel lines.
inline bool cross(const Vec3 &origin, const Vec3 &direction, const PhotonBeam &beam, Crossing &out) {
  const Vec3 across = cross(direction, beam.direction);
  const float sine2 = length_squared(across);
  if (!(sine2 > 1e-12f)) return false;
  const Vec3 between = beam.origin - origin;
  out.sine = std::sqrt(sine2);
  out.distance = std::abs(dot(between, across)) / out.sine;
  out.t = dot(cross(between, beam.direction), across) / sine2;
  out.s = dot(cross(between, direction), across) / sine2;
  return true;
}

}  // namespace opal
