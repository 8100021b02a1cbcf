// SPDX-License-Identifier: GPL-3.0-or-later
// Large arrays that cost no more than what is written to them: photons by the million are mostly paid for in page faults.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace opal {

// n items that start with whatever was there: each thread touches first what it fills, where a vector would have one of
// them write zeros over all. On large pages where the system has them.
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  LargeArray() = default;
  explicit LargeArray(size_t n) : size_(n) {
    if (n == 0) return;
    const size_t bytes = n * sizeof(T);
    const auto alignment = std::align_val_t(bytes >= kPage ? kPage : kLine);
    data_ = {static_cast<T *>(::operator new(bytes, alignment)), Free{alignment}};
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (bytes >= kPage) madvise(data_.get(), bytes & ~(kPage - 1), MADV_HUGEPAGE);  // a hint and no more
#endif
  }
  LargeArray(LargeArray &&other) noexcept { *this = std::move(other); }
  LargeArray &operator=(LargeArray &&other) noexcept {
    data_ = std::move(other.data_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T &operator[](size_t i) { return data_.get()[i]; }
  const T &operator[](size_t i) const { return data_.get()[i]; }

 private:
  static constexpr size_t kPage = size_t(1) << 21, kLine = 64;
  struct Free {
    std::align_val_t alignment{kLine};
    void operator()(T *data) const { ::operator delete(data, alignment); }
  };

  std::unique_ptr<T, Free> data_;
  size_t size_ = 0;
};

}  // namespace opal
