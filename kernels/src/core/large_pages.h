// SPDX-License-Identifier: GPL-3.0-or-later
// Large arrays on large pages, where the system has them: photons by the million are mostly paid for in page faults.
#pragma once

#include <cstdint>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace opal {

// Room for n items, not yet touched, on large pages where that is worth while; a hint and no more.
template <class T>
void reserve_large(std::vector<T> &items, size_t n) {
  items.reserve(n);
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr uintptr_t kPage = uintptr_t(1) << 21;
  const uintptr_t first = (reinterpret_cast<uintptr_t>(items.data()) + kPage - 1) & ~(kPage - 1);
  const uintptr_t last = reinterpret_cast<uintptr_t>(items.data() + items.capacity()) & ~(kPage - 1);
  if (first < last) madvise(reinterpret_cast<void *>(first), last - first, MADV_HUGEPAGE);
#endif
}

}  // namespace opal
