// SPDX-License-Identifier: GPL-3.0-or-later
// Room for up to N values, of which only those that were added exist: an array would make all of them, and most places on a
// ray lie in one medium where there is room for 32.
#pragma once

#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

namespace opal {

template <class T, int N>
class Slots {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  static constexpr int kCapacity = N;

  Slots() {}
  Slots(const Slots &other) { *this = other; }
  Slots &operator=(const Slots &other) {
    if (this == &other) return *this;
    n_ = other.n_;
    std::memcpy(static_cast<void *>(at_), other.at_, size_t(n_) * sizeof(T));
    return *this;
  }

  int count() const { return n_; }
  bool empty() const { return n_ == 0; }
  bool full() const { return n_ == N; }
  T &operator[](int i) { return at_[i]; }
  const T &operator[](int i) const { return at_[i]; }
  T *begin() { return at_; }
  T *end() { return at_ + n_; }
  const T *begin() const { return at_; }
  const T *end() const { return at_ + n_; }

  // There has to be room.
  template <class... Arguments>
  T &add(Arguments &&...arguments) {
    return *new (&at_[n_++]) T{std::forward<Arguments>(arguments)...};
  }
  void remove(int i) {
    for (--n_; i < n_; ++i) at_[i] = at_[i + 1];
  }
  void clear() { n_ = 0; }

 private:
  union {
    T at_[N];
  };
  int n_ = 0;
};

}  // namespace opal
