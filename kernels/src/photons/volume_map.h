// SPDX-License-Identifier: GPL-3.0-or-later
// The volume map of one pass: points or beams, apart from the photons on surfaces, with a tree for each query.
#pragma once

#include "photons/block_tree.h"
#include "photons/chunks.h"
#include "photons/volume_photon.h"

namespace opal {

class VolumeMap {
 public:
  // Takes the photons (or the beams). `radius` 0 takes that which holds about `gather` of the nearest photons, times
  // `shrunk`, the factor by which passes have shrunk it.
  void build(Chunks<VolumePhoton> &&photons, float radius, float shrunk, int gather, int threads);
  void build(Chunks<PhotonBeam> &&beams, float radius, int threads);

  bool empty() const { return size() == 0; }
  bool holds_beams() const { return n_beams_ > 0; }
  size_t size() const { return photons_.size() + n_beams_; }
  float radius() const { return radius_; }
  int64_t memory_bytes() const;

  // Calls visit(photon, squared distance) for photons of `set` near p; `radius2` is asked again and again and may shrink.
  template <class Visit, class Radius2>
  void near(const Vec3 &p, uint32_t set, const Visit &visit, const Radius2 &radius2) const {
    tree_.near(
        p, set,
        [&](uint32_t k) {
          const float d2 = length_squared(photons_[k].position - p);
          if (d2 < radius2()) visit(photons_[k], d2);
        },
        radius2);
  }

  // Calls visit(photon, distance along the ray, squared distance from it) for photons within the radius of the ray.
  template <class Visit>
  void discs(const Vec3 &origin, const Vec3 &direction, float t_max, uint32_t set, const Visit &visit) const {
    tree_.along(origin, direction, t_max, radius_, set, [&](uint32_t k) {
      const VolumePhoton &photon = photons_[k];
      const Vec3 to = photon.position - origin;
      const float t = dot(to, direction), d2 = length_squared(to - direction * t);
      if (t > 0 && t < t_max && d2 < radius_ * radius_) visit(photon, t, d2);
    });
  }

  // Calls visit(beam, crossing) for beams that come within the radius of the ray, once each.
  template <class Visit>
  void crossings(const Vec3 &origin, const Vec3 &direction, float t_max, uint32_t set, const Visit &visit) const {
    tree_.along(origin, direction, t_max, radius_, set, [&](uint32_t k) {
      const Piece &piece = pieces_[k];
      const PhotonBeam &beam = *piece.beam;
      Crossing c;
      if (!cross(origin, direction, beam, c) || !(c.distance < radius_)) return;
      if (c.t > 0 && c.t < t_max && c.s >= piece.start() && c.s < piece.end()) visit(beam, c);
    });
  }

  // The part of a ray, 0 .. t_max, that passes within the radius of the box round all photons of a set; false: none.
  bool clip(const Vec3 &origin, const Vec3 &direction, uint32_t set, float &t_min, float &t_max) const;

 private:
  // Beams are longer than boxes should be: the tree holds pieces of them.
  struct Piece {
    const PhotonBeam *beam;
    uint32_t number, count;
    float start() const { return beam->length * (float(number) / float(count)); }
    float end() const { return number + 1 == count ? beam->length : beam->length * (float(number + 1) / float(count)); }
    Bounds box() const {
      Bounds box;
      box.extend(beam->at(start()));
      box.extend(beam->at(end()));
      return box;
    }
  };
  float typical_distance(int gather) const;

  BlockTree tree_;
  LargeArray<VolumePhoton> photons_;  // in the tree's order
  LargeArray<Piece> pieces_;          // in the tree's order
  Chunks<PhotonBeam> beams_;          // in the order of emission
  size_t n_beams_ = 0;
  float radius_ = 0;
};

}  // namespace opal
