// SPDX-License-Identifier: GPL-3.0-or-later
// The world as a light: its radiance by direction, and an importance map to sample it by.
//
// The map is a latitude-longitude grid laid out like Blender's equirectangular textures (u falls with the azimuth, v
// rises with the height), piecewise constant, with a floor so that no direction is forgotten (Pharr, Jakob & Humphreys,
// pbrt, section 12.5.2). Receivers, whose scattering finds the even part of a sky by itself, sample what stands out above
// the mean (Karlik et al. 2019, "MIS Compensation"); photons sample all of it. A uniform world has no map: receivers
// sample it by the cosine.
#pragma once

#include "core/colour.h"
#include "lights/lights.h"

#include <vector>

namespace opal {

class DirectionMap {
 public:
  // Density in proportion to the values above `subtract`, rows from the bottom, plus a share `floor` of their mean.
  void build(const std::vector<float> &values, int width, int height, float subtract, float floor, int threads);
  bool empty() const { return row_cdf_.empty(); }
  Vec3 sample(Vec2 u, float &pdf) const;
  float pdf(const Vec3 &direction) const;

 private:
  int width_ = 0, height_ = 0;
  std::vector<float> row_cdf_;   // height + 1
  std::vector<float> cell_cdf_;  // (width + 1) a row, each row normalised
  std::vector<float> density_;   // of (u, v) in each cell
};

class WorldLight {
 public:
  // Runs the world's program over the map on the scene's threads.
  void build(const Scene &scene);

  bool present() const { return present_; }
  float brightness() const { return brightness_; }  // mean radiance over all directions

  // As seen by a receiver: by the map, or by the cosine to `normal` (zero: all directions alike).
  Vec3 sample(const Vec3 &normal, bool transmissive, Vec2 u, float &pdf) const;
  float pdf(const Vec3 &normal, bool transmissive, const Vec3 &direction) const;
  // For photons: where light comes from, in proportion to its radiance.
  Vec3 sample_emission(Vec2 u, float &pdf) const;

 private:
  bool present_ = false;
  float brightness_ = 0;
  DirectionMap seen_, emitted_;
};

// Radiance from direction d, linear Rec.709. ray_kind: for the Light Path node.
Vec3 world_radiance(const Scene &scene, const Vec3 &d, uint32_t ray_kind);

}  // namespace opal
