// SPDX-License-Identifier: GPL-3.0-or-later
// Density fields: how dense a medium is at a place of its object's space, between 0 and a majorant that is known along every
// ray before it is followed.
#pragma once

#include "core/vec.h"
#include "media/grid.h"

namespace opal {

enum class DensityKind : uint8_t { Homogeneous, Noise, Grid, Height };

struct DensityField {
  DensityKind kind = DensityKind::Homogeneous;
  int grid = -1;  // index into Scene::grids
  // Noise: saturate(1/2 + contrast (n - 1/2)) of fractal gradient noise n in [0, 1]; its mean is 1/2 by symmetry.
  float noise_scale = 1, noise_detail = 0, noise_contrast = 1;
  Vec3 noise_offset;
  // Height: exp(-(z - base) / scale) above the base, 1 below.
  float scale_height = 1, base_height = 0;

  // At a place in object space; `of` is this field's grid, if it has one.
  float at(const Vec3 &p, const Grid *of) const;
};

// Steps along a ray through a field: intervals with the field's majorant and its approximate mean in each.
//
// Grids are stepped brick by brick (Amanatides & Woo 1987, "A Fast Voxel Traversal Algorithm"), empty ones without stopping;
// the exponential of height in steps of half its scale.
class MajorantSteps {
 public:
  MajorantSteps() = default;
  // origin, direction: the ray in object space, in the parameter of the world's ray.
  MajorantSteps(const DensityField &field, const Grid *grid, const Vec3 &origin, const Vec3 &direction);

  float end() const { return end_; }  // of the present interval
  float majorant() const { return majorant_; }
  float mean() const { return mean_; }
  // The length of a brick along the ray; infinite without a grid.
  float stride() const { return stride_; }
  // On to the next interval, which has another majorant.
  void advance();

 private:
  void advance_grid();
  void advance_height();
  void leave_grid();
  void show_brick();
  bool step_brick();

  DensityKind kind_ = DensityKind::Homogeneous;
  const Grid *grid_ = nullptr;
  float end_ = kInfinity, majorant_ = 1, mean_ = 1, stride_ = kInfinity;
  // Grid: the present brick, and where the ray leaves it along each axis.
  int at_[3] = {}, step_[3] = {};
  float next_[3] = {}, delta_[3] = {};
  float exit_ = 0;
  bool waiting_ = false;  // the present brick has not been shown yet: empty space lies before it
  // Height.
  float z_ = 0, slope_ = 0, scale_ = 1, base_ = 0;
};

}  // namespace opal
