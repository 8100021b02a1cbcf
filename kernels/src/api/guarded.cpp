// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/guarded.h"

namespace opal {
namespace {

thread_local std::string last_error;

int32_t cpu_level() {
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
      __builtin_cpu_supports("bmi2"))
    return 3;
  return 2;
#elif defined(_M_X64)
  return 2;
#else
  return 0;
#endif
}

}  // namespace

int32_t fail(opal_status status, std::string message) {
  last_error = std::move(message);
  return status;
}

}  // namespace opal

extern "C" {

const char *opal_last_error(void) { return opal::last_error.c_str(); }
int32_t opal_api_version(void) { return OPAL_API_VERSION; }
int32_t opal_cpu_level(void) { return opal::cpu_level(); }

}  // extern "C"
