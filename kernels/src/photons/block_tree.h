// SPDX-License-Identifier: GPL-3.0-or-later
// A tree of boxes over many small items, built by sorting alone.
//
// Items lie in the order of a space-filling curve (Morton 1966), each of the pass's wavelength sets apart. Eight
// neighbours share a box, eight boxes a node, eight nodes a box of the level above: the tree is implicit, so building
// costs a radix sort and one sweep (compare Lauterbach et al. 2009, "Fast BVH Construction on GPUs"). Boxes hold the
// bare items; a query brings the radius by which they are widened.
#pragma once

#include "core/radix_sort.h"
#include "photons/curve_of_sets.h"

namespace opal {

class BlockTree {
 public:
  static constexpr int kWidth = 8;

  // Sorts items by their keys of the curve and puts the tree over them; box_of(item) may run on any thread. The same
  // result on any number of threads.
  template <class Item, class BoxOf>
  void build(LargeArray<Keyed<Item>> &items, const BoxOf &box_of, int threads) {
    radix_sort(items, CurveOfSets::kBits, threads);
    lay_out(items);
    for (uint32_t s = 0; s < kSets; ++s) {
      for (int level = 0; level < levels_[s]; ++level)
        for_slices(nodes_of(s, level), threads, [&](size_t, size_t from, size_t to) {
          for (size_t k = from * kWidth; k < to * kWidth; ++k) {
            Bounds box;
            if (k >= boxes_[s][level]) {
            } else if (level > 0) {
              box = nodes_[level_start_[s][level - 1] + k].all();
            } else {
              const size_t end = std::min(size_t(last(s)), first(s) + (k + 1) * kWidth);
              for (size_t i = first(s) + k * kWidth; i < end; ++i) box.extend(box_of(items[i].item));
            }
            nodes_[level_start_[s][level] + k / kWidth].put(int(k % kWidth), box);
          }
        });
      if (levels_[s] > 0) bounds_[s] = nodes_[level_start_[s][levels_[s] - 1]].all();
    }
  }

  bool empty() const { return starts_[kSets] == 0; }
  // Places first .. last-1 hold the items of a set.
  uint32_t first(uint32_t set) const { return starts_[set]; }
  uint32_t last(uint32_t set) const { return starts_[set + 1]; }
  const Bounds &bounds(uint32_t set) const { return bounds_[set]; }
  int64_t memory_bytes() const { return int64_t(nodes_.size() * sizeof(Node)); }

  // Calls visit(place) for every item of `set` whose box, widened by `radius`, the ray meets between 0 and t_max; the
  // eight of a block together. Order is fixed.
  template <class Visit>
  void along(const Vec3 &origin, const Vec3 &direction, float t_max, float radius, uint32_t set, const Visit &visit) const {
    const auto inverse = [](float d) { return 1 / (std::abs(d) > 1e-18f ? d : std::copysign(1e-18f, d)); };
    const Vec3 inv{inverse(direction.x), inverse(direction.y), inverse(direction.z)};
    traverse(set, visit, [&](const Node &node, int i) {
      float enter = 0, leave = t_max;
      for (int a = 0; a < 3; ++a) {
        const float t0 = (node.low[a][i] - radius - origin[a]) * inv[a], t1 = (node.high[a][i] + radius - origin[a]) * inv[a];
        enter = std::max(enter, std::min(t0, t1)), leave = std::min(leave, std::max(t0, t1));
      }
      return enter <= leave;
    });
  }

  // Calls visit(place) for the items whose box comes within sqrt(radius2()) of p; radius2 may shrink on the way.
  template <class Visit, class Radius2>
  void near(const Vec3 &p, uint32_t set, const Visit &visit, const Radius2 &radius2) const {
    traverse(set, visit, [&](const Node &node, int i) {
      float d2 = 0;
      for (int a = 0; a < 3; ++a) d2 += sqr(std::max(0.0f, std::max(node.low[a][i] - p[a], p[a] - node.high[a][i])));
      return d2 <= radius2();
    });
  }

 private:
  static constexpr int kSets = 8, kMostLevels = 12;

  // Boxes of eight children, axis by axis; children that do not exist have empty boxes.
  struct Node {
    float low[3][kWidth], high[3][kWidth];

    void put(int i, const Bounds &box) {
      for (int a = 0; a < 3; ++a) low[a][i] = box.low[a], high[a][i] = box.high[a];
    }
    Bounds all() const {
      Bounds box;
      for (int i = 0; i < kWidth; ++i)
        box.extend(Bounds{{low[0][i], low[1][i], low[2][i]}, {high[0][i], high[1][i], high[2][i]}});
      return box;
    }
  };

  // Where the sets begin in sorted items, and where each level's nodes are: boxes of leaves from the items, those of every
  // level from the one below.
  template <class Item>
  void lay_out(const LargeArray<Keyed<Item>> &items) {
    *this = {};
    size_t total = 0;
    for (uint32_t s = 0, k = 0; s < kSets; ++s) {
      const uint64_t end = uint64_t(s + 1) << (3 * CurveOfSets::kAxisBits);
      k = uint32_t(first_not_below(items, k, end));
      starts_[s + 1] = k;
      size_t boxes = (last(s) - first(s) + kWidth - 1) / kWidth;
      while (boxes > 0) {
        boxes_[s][levels_[s]] = boxes;
        level_start_[s][levels_[s]++] = total;
        total += (boxes + kWidth - 1) / kWidth;
        boxes = boxes > kWidth ? (boxes + kWidth - 1) / kWidth : 0;
      }
    }
    nodes_ = LargeArray<Node>(total);
  }
  template <class Item>
  static size_t first_not_below(const LargeArray<Keyed<Item>> &items, size_t from, uint64_t key) {
    size_t to = items.size();
    while (from < to) {
      const size_t middle = (from + to) / 2;
      if (items[middle].key < key) from = middle + 1;
      else to = middle;
    }
    return from;
  }
  size_t nodes_of(uint32_t set, int level) const { return (boxes_[set][level] + kWidth - 1) / kWidth; }

  template <class Visit, class Meets>
  void traverse(uint32_t set, const Visit &visit, const Meets &meets) const {
    if (first(set) == last(set)) return;
    struct Entry {
      int level;
      uint32_t node;
    } stack[kMostLevels * kWidth];
    int top = 0;
    stack[top++] = {levels_[set] - 1, 0};
    while (top > 0) {
      const Entry entry = stack[--top];
      const Node &node = nodes_[level_start_[set][entry.level] + entry.node];
      uint32_t met = 0;
      for (int i = 0; i < kWidth; ++i) met |= uint32_t(meets(node, i)) << i;
      // Children that do not exist have inverted boxes, which a slab test takes for everything.
      const size_t children = boxes_[set][entry.level] - size_t(entry.node) * kWidth;
      if (children < kWidth) met &= (1u << children) - 1;
      for (int i = kWidth; i-- > 0;) {
        if (!(met >> i & 1)) continue;
        const uint32_t child = entry.node * kWidth + uint32_t(i);
        if (entry.level > 0) {
          stack[top++] = {entry.level - 1, child};
          continue;
        }
        const uint32_t from = first(set) + child * kWidth, to = std::min(from + kWidth, last(set));
        for (uint32_t k = from; k < to; ++k) visit(k);
      }
    }
  }

  LargeArray<Node> nodes_;
  uint32_t starts_[kSets + 1] = {};
  Bounds bounds_[kSets];
  int levels_[kSets] = {};
  size_t level_start_[kSets][kMostLevels] = {};
  size_t boxes_[kSets][kMostLevels] = {};  // children of a level's nodes, in all
};

}  // namespace opal
