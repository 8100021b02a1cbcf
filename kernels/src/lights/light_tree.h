// SPDX-License-Identifier: GPL-3.0-or-later
// Which light matters at a point: a bound on what a group of lights can bring, and a binary tree of such bounds.
//
// Conty Estevez & Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting". Near the receiver a group's
// bound says little, so groups that look large from it are split first, into at most kCutSize; one of these is taken in
// proportion to its bound, and from there down one child at a time (Pharr, Jakob & Humphreys, pbrt, 4th edition, section
// 12.6.3). The split depends on the receiver alone, so the probability of a light is the product along its path.
#pragma once

#include "core/vec.h"

#include <atomic>
#include <cstdint>
#include <vector>

namespace opal {

struct LightBounds {
  Bounds box;
  Vec3 axis{0, 0, 1};  // of the cone that holds every emitter's normal
  float theta_o = 0;   // half angle of that cone
  float theta_e = 0;   // how far beyond the normals light leaves
  float power = 0;     // irradiance at distance 1 on a facing plane, summed
  bool two_sided = false;
  uint64_t receivers = 0;                 // light linking: sets lit by any of them
  float sin_o = 0, cos_o = 1, cos_e = 1;  // of the angles above, by finish()

  void finish();
};
LightBounds merge(const LightBounds &a, const LightBounds &b);

// The receiver whose lights are weighed. normal: zero in media.
struct Receiver {
  Vec3 p, normal;
  bool transmissive = false;
  int32_t light_group = -1;
};
// The cosine at the receiver is never taken below this: shading normals lean, and nothing must be left out.
inline constexpr float kSmallestCosine = 0.05f;

// What the lights within the bounds may bring to the receiver, up to a common factor. 0 only if nothing reaches it.
float importance(const LightBounds &bounds, const Receiver &receiver);

inline constexpr int kCutSize = 16;

class LightTree {
 public:
  // Ends early when `cancel` turns true; the tree is of no use then.
  void build(std::vector<LightBounds> lights, const std::atomic<bool> &cancel);
  bool empty() const { return nodes_.empty(); }

  // The groups among which a receiver chooses first.
  struct Cut {
    uint32_t nodes[kCutSize];
    float importance[kCutSize];
    int count = 0;
    float total = 0;
  };
  void cut(const Receiver &receiver, Cut &out) const;
  // Light and its probability; false when none reaches the receiver.
  bool sample(const Cut &cut, const Receiver &receiver, float u, uint32_t &light, float &probability) const;
  float probability(const Cut &cut, const Receiver &receiver, uint32_t light) const;

 private:
  struct Node {
    LightBounds bounds;
    uint32_t parent = 0;
    uint32_t right = 0;  // the left child follows its parent; 0: a leaf
    uint32_t light = 0;
  };
  uint32_t build_node(std::vector<uint32_t> &order, size_t first, size_t last, uint32_t parent, int depth,
                      const std::vector<LightBounds> &lights, const std::atomic<bool> &cancel);

  std::vector<Node> nodes_;
  std::vector<uint32_t> leaf_of_;  // light -> node
};

}  // namespace opal
