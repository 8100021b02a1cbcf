// SPDX-License-Identifier: GPL-3.0-or-later
// The way of a photon through polished gems since dispersion parted its wavelengths, kept so that they can follow.
//
// A refraction sends every wavelength its own way, and the photon goes on as its hero alone. Where it leaves light on the film,
// each other wavelength is sent after it: from where they parted, choosing reflection or refraction where the hero chose it,
// through the same gems by the same sides, and it leaves its light where it arrives. One that meets something of another kind
// is given up; as the hero of its own photon it would part from this one at the same place, so that the wavelengths which
// belong together are the same whoever leads, and the balance heuristic over them counts everything once (Wilkie et al. 2014,
// section 4, applied to a path that wavelengths share by its events instead of its points). What dispersion mixes again on a
// pixel is so sampled by up to eight wavelengths a photon; photons that leave nothing only note where they went.
#pragma once

#include "bsdf/closure.h"
#include "scene/interior.h"
#include "scene/scene.h"

#include <vector>

namespace opal {

constexpr float kMostSurvive = 0.98f;  // of photons, by the roulette of the tracer

class ColourTrail {
 public:
  bool open() const { return open_; }
  void close() { open_ = false; }
  // At the refraction that parts the wavelengths, which the hero chose with probability `share`: what they had until then,
  // relative to the hero's probability, and the flux that the photon set out with.
  void start(const Ray &arrived, const ShadingPoint &sp, const GemBoundary &gem, bool transmission, float share,
             const Spectrum &flux, const Spectrum &path_pdf, float set_out);
  // A later boundary, reached by a ray of this kind through what absorbs by this table, or -1.
  void add(const Hit &hit, uint32_t material, const ShadingPoint &sp, const GemBoundary &gem, bool transmission, float share,
           int32_t absorption, uint32_t ray_kind);
  // The hero has survived the roulette with this probability. Each wavelength would by the same rule: kMostSurvive, or less if
  // it carries less as a hero than what the photon set out with.
  void survived(float probability) { steps_.back().survived = probability; }

  // Follows wavelength k to where the hero is now. False: it does not get there. Its flux and probability are relative to
  // the hero's probability, as the hero's own are.
  struct End {
    Ray ray;
    Hit hit;
    float flux, path_pdf;
  };
  bool follow(const Scene &scene, const Wavelengths &w, int32_t absorption, uint32_t ray_kind, int k, End &end,
              int64_t &rays) const;

 private:
  struct Step {
    uint32_t instance, material, ray_kind;
    bool backfacing, transmission;
    int32_t absorption;  // of what the way to it leads through
    float hero_share;
    GemBoundary gem;
    float survived = 0;  // 0 without roulette
  };

  bool open_ = false;
  Ray arrived_;
  ShadingPoint first_;
  Spectrum flux_, path_pdf_;
  float whole_ = 0;          // flux of one wavelength with which the roulette spares all it can
  std::vector<Step> steps_;  // the first is where it starts
};

}  // namespace opal
