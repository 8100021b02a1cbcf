// SPDX-License-Identifier: GPL-3.0-or-later
// A participating medium, and the set of media that a path is in. Where media overlap their coefficients add.
#pragma once

#include "core/spectrum.h"
#include "media/density.h"
#include "media/phase_function.h"
#include "opal.h"

#include <array>

namespace opal {

// Spectra name entries of Scene::spectra; -1 is none (0 everywhere). Units: 1/m; emission W/(m3 sr) as radiance per metre.
//
// At a place p the coefficients are the spectra times the density field at p, plus what grids of colours say there (linear
// Rec.709, in the spectra's units). The emission follows a field of its own.
struct Medium {
  int extinction = -1;  // sigma_t
  int scattering = -1;  // sigma_s
  int emission = -1;
  int phase = -1;  // index into Scene::phases, -1: isotropic
  DensityField density, emission_density;
  int scattering_grid = -1, absorption_grid = -1, emission_grid = -1;  // three channels
  uint8_t layer = OPAL_MEDIUM_LAYER_MEDIA;                             // for compositing
  int also = -1;  // another medium of the same body: one more phase function, with coefficients of its own

  bool varies() const {
    return density.kind != DensityKind::Homogeneous || emission_density.kind != DensityKind::Homogeneous ||
           scattering_grid >= 0 || absorption_grid >= 0 || emission_grid >= 0;
  }
};

// The media a path is inside of, each entered through the boundary of one instance; what a medium brings along with itself
// (`also`) is added by media_that_fill.
class MediumSet {
 public:
  static constexpr int kCapacity = 8;
  struct Entry {
    uint32_t instance = 0;
    int medium = 0;
  };

  bool empty() const { return count_ == 0; }
  int count() const { return count_; }
  const Entry &operator[](int i) const { return entries_[size_t(i)]; }

  void enter(uint32_t instance, int medium) {
    if (count_ < kCapacity) entries_[size_t(count_++)] = {instance, medium};
  }
  void leave(uint32_t instance, int medium) {
    for (int i = count_ - 1; i >= 0; --i) {
      if (entries_[size_t(i)].instance != instance || entries_[size_t(i)].medium != medium) continue;
      for (int k = i; k + 1 < count_; ++k) entries_[size_t(k)] = entries_[size_t(k) + 1];
      --count_;
      return;
    }
  }

 private:
  std::array<Entry, kCapacity> entries_;
  int count_ = 0;
};

}  // namespace opal
