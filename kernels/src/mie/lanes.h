// SPDX-License-Identifier: GPL-3.0-or-later
// A few doubles that are computed together: a vector register where the compiler has vector types, else one double.
#pragma once

#include <cstring>

namespace opal::mie {

#if defined(__GNUC__) && defined(__AVX__)
typedef double Lane __attribute__((vector_size(32)));
#elif defined(__GNUC__)
typedef double Lane __attribute__((vector_size(16)));
#else
typedef double Lane;
#endif

inline constexpr int kLanes = int(sizeof(Lane) / sizeof(double));

inline Lane load(const double *from) {
  Lane lane;
  std::memcpy(&lane, from, sizeof lane);
  return lane;
}

inline void store(double *to, const Lane &lane) { std::memcpy(to, &lane, sizeof lane); }

}  // namespace opal::mie
