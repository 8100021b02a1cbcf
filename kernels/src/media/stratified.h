// SPDX-License-Identifier: GPL-3.0-or-later
// Media along a ray in closed form: their density is the same everywhere or falls exponentially with height, as haze and rain
// to the horizon do. Optical depth, transmittance and free paths need no tracking and so bring no noise.
//
// A density of min(1, exp(-(z - base) / H)) has along a ray, with x = (z - base) / H = a + s t, the depth (G(x) - G(a)) / s
// where G(x) is x below the base and 1 - exp(-x) above.
#pragma once

#include "media/segment.h"

namespace opal {

// The density of one medium along one ray, and its integral from the ray's origin on (m).
class HeightProfile {
 public:
  HeightProfile() = default;  // 1 everywhere
  HeightProfile(const DensityField &field, const Vec3 &origin, const Vec3 &direction);

  bool even() const { return !(scale_ > 0); }
  float density(float t) const;
  float depth(float t) const;
  // Where the depth is reached; infinite: nowhere.
  float reach(float depth) const;

 private:
  float depth_above(float x, float t) const;          // from height x >= 0 on, staying above the base
  float reach_above(float x, float depth) const;      // the inverse
  float crossing() const { return -start_ / rise_; }  // distance to the base's height

  float scale_ = 0;             // scale height; 0: the density is 1 everywhere
  float start_ = 0, rise_ = 0;  // height over the base at the origin, and its change a metre, in scale heights
};

class StratifiedMedia {
 public:
  // Whether all media of a set are of this kind.
  static bool holds(const Scene &scene, const MediumSet &set);
  // In a set for which that holds.
  StratifiedMedia(const Scene &scene, const MediumSet &set, const Wavelengths &w, const Ray &ray);

  bool homogeneous() const { return homogeneous_; }
  // Coefficients where the density is 1; emission only in homogeneous media.
  const MediumHere &full() const { return full_; }
  // Coefficients at distance t: full() in homogeneous media, else kept in `scratch`.
  const MediumHere &at(float t, MediumHere &scratch) const;

  // Optical depth from the origin to t, which may be infinite.
  Spectrum depth(float t) const;
  Spectrum transmittance(float t) const;
  // The extinction's mean over wavelengths, its depth, and where that is reached.
  float mean_extinction(float t) const;
  float mean_depth(float t) const;
  float reach_mean(float depth) const { return reach(depth, false); }
  // Where the hero's depth is reached; infinite: nowhere.
  float reach_hero(float depth) const { return reach(depth, true); }

 private:
  struct Part {
    HeightProfile profile;
    OneMedium medium;
    float mean = 0;
    float first = 0, last = kInfinity;  // between these distances it scatters
  };
  float reach(float depth, bool hero) const;

  MediumHere full_;
  Slots<Part, MediumSet::kCapacity> parts_;  // by medium
  bool homogeneous_ = true;
};

}  // namespace opal
