// SPDX-License-Identifier: GPL-3.0-or-later
// Sorting of millions by an integer: stable, and the same on any number of threads.
#pragma once

#include "core/large_array.h"
#include "core/parallel.h"

#include <array>

namespace opal {

template <class Item>
struct Keyed {
  uint64_t key;
  Item item;
};

constexpr size_t kSliceOfMany = size_t(1) << 16;

// Runs task(slice, from, to) over [0, n) in slices of kSliceOfMany.
template <class Task>
void for_slices(size_t n, int threads, const Task &task) {
  const std::atomic<bool> never{false};
  parallel_for(int64_t((n + kSliceOfMany - 1) / kSliceOfMany), threads, never, [&](int64_t slice) {
    const size_t from = size_t(slice) * kSliceOfMany;
    task(size_t(slice), from, std::min(n, from + kSliceOfMany));
  });
}

// Sorts by the low `bits` bits of the keys, the others being zero, least significant digit first. Every slice counts and
// then places its own.
template <class Item>
void radix_sort(LargeArray<Keyed<Item>> &items, int bits, int threads) {
  constexpr int kDigitBits = 11;
  constexpr size_t kBuckets = size_t(1) << kDigitBits;
  LargeArray<Keyed<Item>> other(items.size());
  std::vector<std::array<uint32_t, kBuckets>> counts((items.size() + kSliceOfMany - 1) / kSliceOfMany);
  for (int shift = 0; shift < bits; shift += kDigitBits) {
    const auto bucket = [shift](const Keyed<Item> &k) { return size_t(k.key >> shift) & (kBuckets - 1); };
    for_slices(items.size(), threads, [&](size_t slice, size_t from, size_t to) {
      counts[slice].fill(0);
      for (size_t i = from; i < to; ++i) ++counts[slice][bucket(items[i])];
    });
    uint32_t sum = 0;
    for (size_t b = 0; b < kBuckets; ++b)
      for (auto &count : counts) sum += std::exchange(count[b], sum);
    for_slices(items.size(), threads, [&](size_t slice, size_t from, size_t to) {
      for (size_t i = from; i < to; ++i) other[counts[slice][bucket(items[i])]++] = items[i];
    });
    std::swap(items, other);
  }
}

}  // namespace opal
