// SPDX-License-Identifier: GPL-3.0-or-later
// The radiance that photons in media send along a camera ray, estimated in three ways that agree in the limit.
//
//   POINTS         photons in spheres at places marched along the ray (Jensen & Christensen 1998), with transmittance
//   BEAM_RADIANCE  every photon as a disc that the ray pierces (Jarosz, Zwicker & Jensen 2008)
//   BEAMS          every flight of a photon as a beam that the ray crosses (Jarosz, Nowrouzezahrai, Sadeghi & Jensen 2011)
//
// Blur goes with the kernel's radius squared; passes shrink the radius, so it vanishes.
#pragma once

#include "integrator/pass.h"
#include "photons/camera_way.h"

namespace opal {

// What bounds the media where a ray enters and leaves them: normals that point inwards, 0 where the ray begins or ends within.
// A kernel that reaches across holds fewer photons than one inside; knowing where it is cut, estimates make up for that.
struct MediumFaces {
  Vec3 begin, end;
};

// A camera ray's way through media, 0 .. t_end (possibly infinite).
struct VolumeQuery {
  const Vec3 &origin, &direction;
  float t_end;
  const CameraWay &way;
  uint32_t media;           // media_key
  const Polariser *filter;  // before the camera, or null
  const Wavelengths &w;
  uint32_t index;  // of the path among the pass's wavelengths
  float jitter;    // 0..1
  MediumFaces faces;

  // Whether a place lies beyond the planes of the faces.
  bool beyond(const Vec3 &p) const {
    const Vec3 from_begin = p - origin;
    return dot(from_begin, faces.begin) < 0 || (std::isfinite(t_end) && dot(from_begin - direction * t_end, faces.end) < 0);
  }
};

// Radiance at the path's wavelengths that arrives at the ray's origin, transmittance included.
Spectrum volume_radiance(const PassContext &pass, const VolumeQuery &query);

// One function an estimate.
Spectrum points_in_spheres(const VolumeMap &map, const opal_render_settings &settings, const VolumeQuery &query);
Spectrum beam_radiance_estimate(const VolumeMap &map, const VolumeQuery &query);
Spectrum photon_beams_estimate(const VolumeMap &map, const VolumeQuery &query);

}  // namespace opal
