// SPDX-License-Identifier: GPL-3.0-or-later
// Items as the chunks of a pass left them. Maps are built from them where they lie: a copy of millions of photons into one
// array would cost as much as sorting them.
#pragma once

#include "core/parallel.h"
#include "core/vec.h"

#include <vector>

namespace opal {

template <class T>
using Chunks = std::vector<std::vector<T>>;

// Where each chunk's items begin when they are numbered through, and how many there are in all.
template <class T>
std::vector<size_t> starts_of(const Chunks<T> &chunks) {
  std::vector<size_t> starts(chunks.size() + 1, 0);
  for (size_t c = 0; c < chunks.size(); ++c) starts[c + 1] = starts[c] + chunks[c].size();
  return starts;
}

// Runs task(c) for every chunk.
template <class T, class Task>
void for_chunks(const Chunks<T> &chunks, int threads, const Task &task) {
  const std::atomic<bool> never{false};
  parallel_for(int64_t(chunks.size()), threads, never, [&](int64_t c) { task(size_t(c)); });
}

// The box round the places of all items.
template <class T>
Bounds bounds_of_positions(const Chunks<T> &chunks, int threads) {
  std::vector<Bounds> of_chunk(chunks.size());
  for_chunks(chunks, threads, [&](size_t c) {
    for (const T &item : chunks[c]) of_chunk[c].extend(item.position);
  });
  Bounds all;
  for (const Bounds &b : of_chunk) all.extend(b);
  return all;
}

}  // namespace opal
