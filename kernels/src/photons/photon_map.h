// SPDX-License-Identifier: GPL-3.0-or-later
// The photons of one pass and the search for those near a point.
//
// A pass uses 64 wavelengths in 8 sets of 8; a photon and a camera path of the same set share every wavelength, so a
// lookup needs photons of its own set alone and never mixes wavelengths. The map is a hash grid (cells of twice the
// radius) over position and set.
#pragma once

#include "core/large_array.h"
#include "core/spectrum.h"
#include "core/vec.h"
#include "photons/chunks.h"

#include <cstdint>

namespace opal {

// A unit vector in 32 bits (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors").
uint32_t pack_direction(const Vec3 &d);
Vec3 unpack_direction(uint32_t packed);

struct Photon {
  Vec3 position;
  uint32_t direction;        // where it came from, packed
  uint32_t normal;           // geometric, on the side it came from, packed
  uint32_t set;              // of wavelengths, 0..7
  float flux[kWavelengths];  // W per nm-sample, by position in the set
};
static_assert(sizeof(Photon) <= 64);

class PhotonMap {
 public:
  // Takes the photons and sorts them into the grid. `radius` is the largest that will be asked for.
  void build(Chunks<Photon> &&photons, float radius, int threads);
  bool empty() const { return photons_.empty(); }
  size_t size() const { return photons_.size(); }
  float radius() const { return radius_; }

  // Calls visit(photon, squared distance) for every photon of `set` within the radius of p, in a fixed order.
  template <class Visit>
  void query(const Vec3 &p, uint32_t set, const Visit &visit) const {
    if (photons_.empty()) return;
    const float cell = 2 * radius_;
    const Vec3 g = (p - origin_) / cell;
    const int64_t x = int64_t(std::floor(g.x - 0.5f)), y = int64_t(std::floor(g.y - 0.5f)), z = int64_t(std::floor(g.z - 0.5f));
    uint32_t seen[8];
    int n_seen = 0;
    for (int i = 0; i < 8; ++i) {
      const uint32_t bucket = bucket_of(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2), set);
      bool again = false;  // two cells may share a bucket: visit it once
      for (int k = 0; k < n_seen; ++k) again |= seen[k] == bucket;
      if (again) continue;
      seen[n_seen++] = bucket;
      for (uint32_t k = starts_[bucket]; k < starts_[bucket + 1]; ++k) {
        const Photon &photon = photons_[k];
        const float d2 = length_squared(photon.position - p);
        if (d2 < radius_ * radius_ && photon.set == set) visit(photon, d2);
      }
    }
  }

 private:
  uint32_t bucket_of(int64_t x, int64_t y, int64_t z, uint32_t set) const;
  uint32_t bucket_of(const Photon &photon) const;

  LargeArray<Photon> photons_;
  LargeArray<uint32_t> starts_;  // first photon of each bucket, and one past the last
  float radius_ = 0;
  Vec3 origin_;
  uint32_t mask_ = 0;
};

}  // namespace opal
