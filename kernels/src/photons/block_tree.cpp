// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/block_tree.h"

#include "core/large_pages.h"
#include "core/parallel.h"

#include <array>

namespace opal {
namespace {

constexpr int kAxisBits = 13;                // places along an axis that the curve tells apart: 8192
constexpr int kDigitBits = 11, kDigits = 4;  // 3 x 13 bits of place and 3 of set, eleven at a time
constexpr size_t kChunk = 1u << 16;
const std::atomic<bool> kNever{false};

size_t chunks_of(size_t n) { return (n + kChunk - 1) / kChunk; }

template <class Task>
void for_chunks(size_t n, int threads, const Task &task) {
  parallel_for(int64_t(chunks_of(n)), threads, kNever,
               [&](int64_t c) { task(size_t(c), size_t(c) * kChunk, std::min(n, size_t(c + 1) * kChunk)); });
}

// The bits of x three places apart.
uint64_t spread(uint32_t x) {
  uint64_t v = x;
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
}

struct Keyed {
  uint64_t key;
  uint32_t item;
};

// Stable, least significant digit first. Every chunk counts and then places its own, so threads do not matter.
void radix_sort(std::vector<Keyed> &items, int threads) {
  constexpr size_t kBuckets = size_t(1) << kDigitBits;
  std::vector<Keyed> other;
  reserve_large(other, items.size());
  other.resize(items.size());
  std::vector<std::array<uint32_t, kBuckets>> counts(chunks_of(items.size()));
  for (int digit = 0; digit < kDigits; ++digit) {
    const auto bucket = [&](const Keyed &k) { return size_t(k.key >> (digit * kDigitBits)) & (kBuckets - 1); };
    for_chunks(items.size(), threads, [&](size_t c, size_t from, size_t to) {
      counts[c].fill(0);
      for (size_t i = from; i < to; ++i) ++counts[c][bucket(items[i])];
    });
    uint32_t sum = 0;
    for (size_t b = 0; b < kBuckets; ++b)
      for (auto &count : counts) {
        const uint32_t n = count[b];
        count[b] = sum;
        sum += n;
      }
    for_chunks(items.size(), threads, [&](size_t c, size_t from, size_t to) {
      for (size_t i = from; i < to; ++i) other[counts[c][bucket(items[i])]++] = items[i];
    });
    items.swap(other);
  }
}

}  // namespace

std::vector<uint32_t> BlockTree::build(size_t n, const std::function<Bounds(size_t)> &box_of,
                                       const std::function<uint32_t(size_t)> &set_of, int threads) {
  *this = {};
  if (n == 0) return {};
  std::vector<Bounds> of_chunk(chunks_of(n));
  for_chunks(n, threads, [&](size_t c, size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      const Bounds box = box_of(i);
      of_chunk[c].extend(box.centre());
    }
  });
  Bounds all;
  for (const Bounds &b : of_chunk) all.extend(b);
  const Vec3 size = all.high - all.low;
  const auto scale = [](float extent) { return extent > 0 ? float((1 << kAxisBits) - 1) / extent : 0.0f; };
  const Vec3 scales{scale(size.x), scale(size.y), scale(size.z)};

  std::vector<Keyed> keyed;
  reserve_large(keyed, n);
  keyed.resize(n);
  for_chunks(n, threads, [&](size_t, size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      const Vec3 p = (box_of(i).centre() - all.low) * scales;
      const uint64_t curve = spread(uint32_t(p.x)) | spread(uint32_t(p.y)) << 1 | spread(uint32_t(p.z)) << 2;
      keyed[i] = {uint64_t(set_of(i)) << (3 * kAxisBits) | curve, uint32_t(i)};
    }
  });
  radix_sort(keyed, threads);

  std::vector<uint32_t> order(n);
  for (size_t k = 0; k < n; ++k) {
    order[k] = keyed[k].item;
    ++starts_[(keyed[k].key >> (3 * kAxisBits)) + 1];
  }
  for (int s = 0; s < kSets; ++s) starts_[s + 1] += starts_[s];

  // Where each level's nodes are, then the boxes: leaves from the items, every level from the one below.
  size_t total = 0;
  for (uint32_t s = 0; s < kSets; ++s) {
    size_t boxes = (last(s) - first(s) + kWidth - 1) / kWidth;
    while (boxes > 0) {
      const size_t nodes = (boxes + kWidth - 1) / kWidth;
      boxes_[s][levels_[s]] = boxes;
      level_start_[s][levels_[s]++] = total;
      total += nodes;
      boxes = nodes > 1 ? nodes : 0;
    }
  }
  reserve_large(nodes_, total);
  nodes_.resize(total);
  for (uint32_t s = 0; s < kSets; ++s) {
    const size_t items = last(s) - first(s);
    size_t boxes = (items + kWidth - 1) / kWidth;
    for (int level = 0; level < levels_[s]; ++level) {
      const size_t nodes = (boxes + kWidth - 1) / kWidth;
      for_chunks(nodes, threads, [&](size_t, size_t from, size_t to) {
        for (size_t k = from * kWidth; k < to * kWidth; ++k) {
          Bounds box;
          if (level > 0) {
            if (k < boxes) box = nodes_[level_start_[s][level - 1] + k].all();
          } else {
            for (size_t i = k * kWidth; i < std::min((k + 1) * kWidth, items); ++i) box.extend(box_of(order[first(s) + i]));
          }
          nodes_[level_start_[s][level] + k / kWidth].put(int(k % kWidth), box);
        }
      });
      boxes = nodes;
    }
    if (levels_[s] > 0) bounds_[s] = nodes_[level_start_[s][levels_[s] - 1]].all();
  }
  return order;
}

}  // namespace opal
