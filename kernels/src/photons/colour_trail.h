// SPDX-License-Identifier: GPL-3.0-or-later
// The way of a path through polished gems since dispersion parted its wavelengths, kept so that they can follow.
//
// A refraction sends every wavelength its own way, and a photon or camera path goes on as its hero alone. Where a photon leaves
// light on the film, and where a camera path meets light behind the gems, other wavelengths are sent after it: from where they
// parted, choosing reflection or refraction where the hero chose it, through the same gems by the same sides, and they leave or
// find light where they arrive. One that meets something of another kind is given up; as the hero of its own path it would part
// from this one at the same place, so that the wavelengths which belong together are the same whoever leads, and the balance
// heuristic over them counts everything once (Wilkie et al. 2014, section 4, applied to a path that wavelengths share by its
// events instead of its points). What dispersion mixes again on a pixel is so sampled by several wavelengths a path; paths that
// leave or find nothing only note where they went.
#pragma once

#include "bsdf/closure.h"
#include "scene/interior.h"
#include "scene/scene.h"

#include <vector>

namespace opal {

class ColourTrail {
 public:
  explicit ColourTrail(Transport transport) : transport_(transport) {}
  bool open() const { return open_; }
  void close() { open_ = false; }
  // At the refraction that parts the wavelengths, which the hero chose with probability `share`: what they had until then,
  // relative to the hero's probability, and with how much in all wavelengths the roulette spares all it can.
  void start(const Ray &arrived, const ShadingPoint &sp, const GemBoundary &gem, bool transmission, float share,
             const Spectrum &flux, const Spectrum &path_pdf, float whole);
  // A later boundary, reached by a ray of this kind through what absorbs by this table, or -1.
  void add(const Hit &hit, uint32_t material, const ShadingPoint &sp, const GemBoundary &gem, bool transmission, float share,
           int32_t absorption, uint32_t ray_kind);
  // The hero has survived the roulette with this probability. Each wavelength would by the same rule: the most there is, or
  // less if it carries less as a hero than the whole. Radiance counts without its scaling by the index.
  void survived(float probability, float most) { steps_.back().survived = probability, steps_.back().most = most; }

  // Whether what a hit shows ends the trail: anything but a gem's boundary or a medium's. Nothing at all ends that of radiance,
  // which meets the surroundings then.
  bool ends(const Scene &scene, const Hit &hit) const;
  // Follows wavelength k to where the hero is now. False: it does not get there. Its flux (or throughput) and probability are
  // relative to the hero's probability, as the hero's own are.
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
    bool backfacing, smooth, transmission;  // smooth: by its interpolated normal
    int32_t absorption;                     // of what the way to it leads through
    float hero_share;
    GemBoundary gem;
    float survived = 0, most = 1;  // 0 without roulette
  };

  Transport transport_;
  bool open_ = false;
  Ray arrived_;
  ShadingPoint first_;
  Spectrum flux_, path_pdf_;
  float whole_ = 0;          // of one wavelength
  std::vector<Step> steps_;  // the first is where it starts
};

}  // namespace opal
