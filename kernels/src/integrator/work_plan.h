// SPDX-License-Identifier: GPL-3.0-or-later
// Where the work of a pass goes: how many camera paths each part of the picture gets, and how many photons go with them.
//
// A pilot measures, block by block, the variance of one camera path and of one photon relative to the squared brightness there,
// and what each costs. Paths are then shared out by Neyman's rule (Neyman 1934, "On the Two Different Aspects of the
// Representative Method", section V: in proportion to standard deviation over the root of the cost), and photons against paths
// by the same rule, at the cost that the settings' own numbers would have had. The plan depends on scene, settings and seed
// alone and is the same for every pass, so passes stay independent and unbiased.
#pragma once

#include "core/vec.h"

#include <cstdint>
#include <vector>

namespace opal {

inline constexpr int kPlanBlock = 8;        // pixels along an edge of a block
inline constexpr int kPilotPixels = 4;      // of each block, that the pilot looks at: one in each quarter
inline constexpr uint32_t kPilotPaths = 8;  // camera paths through each

// What the pilot found in a block, as means over its pixels.
struct PilotBlock {
  Vec3 brightness;            // linear Rec.709
  float path_variance = 0;    // of one camera path, mean over the channels
  float photon_variance = 0;  // times the number of photons
  float rays = 0;             // of one camera path
};

class WorkPlan {
 public:
  WorkPlan() = default;
  // blocks: rows of blocks_x; samples, photons: the settings' numbers a pass; rays_of_photon: of one, on average.
  WorkPlan(const std::vector<PilotBlock> &blocks, int blocks_x, int samples, int photons, float rays_of_photon);

  bool empty() const { return density_.empty(); }
  int photons() const { return photons_; }
  // Camera paths a pass for the pixel (x, y) of the frame: at least one, between blocks interpolated.
  int samples(int x, int y, uint32_t seed) const;

 private:
  float density(int block_x, int block_y) const;

  int blocks_x_ = 0, blocks_y_ = 0, photons_ = 0;
  std::vector<float> density_;  // paths per pixel, at the blocks' centres
};

}  // namespace opal
