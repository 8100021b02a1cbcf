// SPDX-License-Identifier: GPL-3.0-or-later
// A grid of voxels: sparse bricks of 8 cells along each axis, with what a tracker needs to know of each brick.
//
// Voxel (i, j, k) is a sample at that place of index space; between samples the value is trilinear, and one voxel beyond the
// grid it is 0. Bricks keep one more layer of samples, so that a lookup touches a single brick; bricks of zeros are not kept.
#pragma once

#include "core/vec.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace opal {

class Grid {
 public:
  static constexpr int kCells = 8, kSamples = kCells + 1;

  // What was wrong with values: each was taken as 0.
  struct Bad {
    int64_t not_finite = 0, negative = 0;
  };
  struct Brick {
    float majorant = 0, mean = 0;      // of the largest channel
    std::unique_ptr<float[]> samples;  // kSamples^3 x channels, x fastest; null: zeros
  };

  // size: voxels along x, y, z; index_to_object: where voxel (0, 0, 0) and its neighbours lie.
  Grid(const int size[3], int channels, const Transform &index_to_object);

  // Writes a block of voxels, x slowest (values[x][y][z][channel]), as NumPy and OpenVDB have it.
  void set_block(const int origin[3], const int size[3], const float *values, Bad &bad);

  // Trilinear, at a place in lattice space (see lattice()).
  float value(const Vec3 &s) const;
  Vec3 color(const Vec3 &s) const;  // of three channels

  // Object space to lattice space: index space moved by one, so that everything that is not 0 lies above 0.
  const Transform &to_lattice() const { return to_lattice_; }
  // Bricks along each axis; brick b covers lattice coordinates 8 b .. 8 b + 8.
  int bricks(int axis) const { return bricks_[axis]; }
  const Brick &brick(int x, int y, int z) const {
    return table_[(size_t(z) * size_t(bricks_[1]) + size_t(y)) * size_t(bricks_[0]) + size_t(x)];
  }
  int channels() const { return channels_; }
  int size(int axis) const { return size_[axis]; }
  float majorant() const { return majorant_; }
  int64_t memory_bytes() const;

 private:
  const Brick *cell(const Vec3 &s, size_t &offset, float weight[8]) const;
  void update(Brick &brick);

  int size_[3], bricks_[3], channels_;
  Transform to_lattice_;
  float majorant_ = 0;
  int64_t kept_ = 0;
  std::vector<Brick> table_;
};

}  // namespace opal
