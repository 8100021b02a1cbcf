// SPDX-License-Identifier: GPL-3.0-or-later
// Media that vary along a ray: local coefficients, free paths by delta tracking, transmittance by ratio tracking.
//
// Both follow the same majorants, interval by interval, so that the density with which either finds a chain of null collisions
// is known at every wavelength (Miller, Georgiev & Jarosz 2019, "A null-scattering path integral formulation of light
// transport"; the bookkeeping follows pbrt-v4, section 14.2). Collisions are drawn at the hero's majorant; what a walk carries
// for the other wavelengths is weighted, and multiple importance over them keeps chromatic media free of colour noise.
//
// To be used so: make a RayMedia for the ray, then either fly() or pass_through(); ask coefficients at any place with at().
#pragma once

#include "media/random_stream.h"
#include "media/segment.h"

namespace opal {

class RayMedia {
 public:
  RayMedia(const Scene &scene, const MediumSet &set, const Wavelengths &w, const Ray &ray);

  // An interval of the ray over which the majorant holds.
  struct Interval {
    float begin = 0, end = 0;
    Spectrum majorant{0.0f};
    float mean = 0;         // approximate extinction, mean over wavelengths: for weights, never for results
    bool emissive = false;  // something may glow in it
  };
  // Coefficients at distance t along the ray.
  MediumHere at(float t) const;
  // The next interval, cut at t_end; false when t_end has been reached or there is nothing more to come.
  bool next(float t_end, Interval &out);
  // Where the intervals have come to.
  float position() const { return position_; }

 private:
  struct Layer {  // one medium
    const Medium *medium = nullptr;
    const PhaseFunction *phase = nullptr;
    const Grid *density = nullptr, *emission = nullptr;
    const Grid *scattering_colors = nullptr, *absorption_colors = nullptr, *emission_colors = nullptr;
    Vec3 origin, direction;    // of the ray, in the object's space
    float floor = -kInfinity;  // height under which nothing is scattered
    Spectrum sigma_t, sigma_s, glow;
  };
  struct Part {  // one field of one medium
    MajorantSteps steps;
    Spectrum coefficient;    // times the field's majorant: a share of the whole majorant
    float mean_coefficient;  // mean of the coefficient over wavelengths
    float collisions = 0;    // least rate of tentative collisions where the field is not 0, to find emission
    bool emissive = false;
  };
  void add_part(const Layer &layer, const DensityField &field, const Grid *grid, const Spectrum &coefficient, bool emissive,
                float homogeneous_rate);

  static constexpr int kMostFields = 5;  // of a medium: density, glow, three grids of colours
  const Wavelengths &w_;
  Slots<Layer, MediumSet::kCapacity> layers_;
  Slots<Part, kMostFields * MediumSet::kCapacity> parts_;
  float position_ = 0;
};

// What a walk through media carries: f / p(hero); p / p(hero) of the walk at each wavelength; and the same density for the walk
// as a light connection would make it, which draws every collision as a null one.
struct Walk {
  Spectrum throughput{1.0f}, path_pdf{1.0f}, light_pdf{1.0f};
};

// Delta tracking from where `media` has come to, up to t_end. True: a real collision at t, with the coefficients there; the
// walk then carries throughput without the scattering coefficient (multiply by here.scattering) and path_pdf with the
// extinction. `glow(contribution, pdf)` is called for emission met on the way: radiance is contribution / pdf.average().
// `depth` gathers the approximate optical depth.
template <class Glow>
bool fly(RayMedia &media, float t_end, RandomStream &random, Walk &walk, float &depth, float &t, MediumHere &here,
         const Glow &glow);

// Ratio tracking over the whole ray up to t_end: an unbiased estimate of the transmittance in walk.throughput; path_pdf is what
// delta tracking would have had for coming through so.
void pass_through(RayMedia &media, float t_end, RandomStream &random, Walk &walk, float &depth);

// The transmittance at each wavelength over [0, t_end) of a ray, estimated once; media in closed form exactly.
Spectrum estimate_transmittance(const Scene &scene, const MediumSet &set, const Wavelengths &w, const Ray &ray, float t_end,
                                RandomStream &random);

// ---- Inline ----

// exp(-majorant d) relative to the hero's, without overflow.
inline Spectrum relative_transmittance(const Spectrum &majorant, float d) {
  Spectrum s;
  for (int i = 0; i < kWavelengths; ++i) {
    const float difference = majorant[0] - majorant[i];
    s[i] = difference == 0 ? 1.0f : std::exp(clamp(difference * d, -80.0f, 80.0f));
  }
  return s;
}

template <class Glow>
bool fly(RayMedia &media, float t_end, RandomStream &random, Walk &walk, float &depth, float &t, MediumHere &here,
         const Glow &glow) {
  RayMedia::Interval interval;
  while (media.next(t_end, interval)) {
    const float sigma = interval.majorant[0];
    for (float from = interval.begin;;) {
      const float d = sigma > 0 ? -std::log1p(-random.next()) / sigma : kInfinity;
      t = from + d;
      if (!(t < interval.end)) {
        if (std::isfinite(interval.end)) {
          const Spectrum rest = relative_transmittance(interval.majorant, interval.end - from);
          walk.throughput *= rest, walk.path_pdf *= rest, walk.light_pdf *= rest;
          depth += interval.mean * (interval.end - interval.begin);
        } else {  // the hero alone is not held up by what goes on without end
          for (int i = 0; i < kWavelengths; ++i)
            if (interval.majorant[i] > sigma) walk.throughput[i] = walk.path_pdf[i] = walk.light_pdf[i] = 0;
        }
        break;
      }
      const Spectrum through = relative_transmittance(interval.majorant, d);
      here = media.at(t);
      if (interval.emissive && !here.emission.is_zero())
        glow(walk.throughput * through * here.emission / sigma, walk.path_pdf * through * interval.majorant / sigma);
      if (random.next() * sigma < here.extinction[0]) {
        const float real = here.extinction[0];
        walk.throughput *= through / real;
        walk.light_pdf = walk.path_pdf *= through * here.extinction / real;
        depth += interval.mean * (t - interval.begin);
        return true;
      }
      Spectrum null = interval.majorant - here.extinction;
      for (int i = 0; i < kWavelengths; ++i) null[i] = std::max(0.0f, null[i]);
      if (!(null[0] > 0)) {  // rounding: the majorant is met exactly
        from = t;
        continue;
      }
      walk.throughput *= through * null / null[0];
      walk.path_pdf *= through * null / null[0];
      walk.light_pdf *= through * interval.majorant / null[0];
      from = t;
    }
  }
  return false;
}

}  // namespace opal
