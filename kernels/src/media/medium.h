// SPDX-License-Identifier: GPL-3.0-or-later
// A participating medium, and the set of media that a path is in. Where media overlap their coefficients add.
#pragma once

#include "core/slots.h"
#include "core/spectrum.h"
#include "media/density.h"
#include "media/phase_function.h"
#include "opal.h"

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
  static constexpr int kCapacity = 32;
  static constexpr uint32_t kOfWorld = ~0u;  // in place of an instance
  struct Entry {
    uint32_t instance;
    int medium;
  };

  bool empty() const { return entries_.empty(); }
  int count() const { return entries_.count(); }
  const Entry &operator[](int i) const { return entries_[i]; }
  // How often a medium was entered within as many as are kept account of: it was passed over.
  int passed_over() const { return passed_over_; }

  void enter(uint32_t instance, int medium) {
    if (!entries_.full()) entries_.add(instance, medium);
    else ++passed_over_;
  }
  void leave(uint32_t instance, int medium) {
    for (int i = count() - 1; i >= 0; --i)
      if (entries_[i].instance == instance && entries_[i].medium == medium) {
        entries_.remove(i);
        return;
      }
  }
  // All that have an end.
  void leave_bodies() {
    for (int i = count() - 1; i >= 0; --i)
      if (entries_[i].instance != kOfWorld) entries_.remove(i);
  }

 private:
  Slots<Entry, kCapacity> entries_;
  int passed_over_ = 0;
};

}  // namespace opal
