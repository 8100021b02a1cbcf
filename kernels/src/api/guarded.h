// SPDX-License-Identifier: GPL-3.0-or-later
// What every function of the C interface does: arguments are checked, exceptions end here and leave a sentence.
#pragma once

#include "integrator/render.h"
#include "opal.h"
#include "scene/scene.h"

#include <new>
#include <string>

struct opal_scene : opal::Scene {};
struct opal_render : opal::Render {
  using opal::Render::Render;
};

namespace opal {

// Notes the thread's last error; returns `status`.
int32_t fail(opal_status status, std::string message);

struct BadArgument : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct OutOfMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};
inline void require(bool condition, const char *message) {
  if (!condition) throw BadArgument(message);
}

template <class Function>
int32_t guarded(const Function &function) noexcept {
  try {
    return function();
  } catch (const BadArgument &e) {
    return fail(OPAL_ERROR_ARGUMENT, e.what());
  } catch (const OutOfMemory &e) {
    return fail(OPAL_ERROR_MEMORY, e.what());
  } catch (const CommitCancelled &e) {
    return fail(OPAL_ERROR_CANCELLED, e.what());
  } catch (const EmbreeError &e) {
    return fail(OPAL_ERROR_EMBREE, e.what());
  } catch (const std::bad_alloc &) {
    return fail(OPAL_ERROR_MEMORY, "Out of memory");
  } catch (const std::length_error &) {
    return fail(OPAL_ERROR_MEMORY, "Out of memory");
  } catch (const std::exception &e) {
    return fail(OPAL_ERROR_INTERNAL, e.what());
  } catch (...) {
    return fail(OPAL_ERROR_INTERNAL, "Unknown error");
  }
}

template <class T>
std::vector<T> copy(const T *values, size_t n) {
  return values ? std::vector<T>(values, values + n) : std::vector<T>();
}

inline Transform transform_from(const float *m) {
  Transform t;
  std::copy(m, m + 12, t.m);
  return t;
}
inline bool all_finite(const float *values, size_t n) {
  for (size_t i = 0; i < n; ++i)
    if (!std::isfinite(values[i])) return false;
  return true;
}

}  // namespace opal
