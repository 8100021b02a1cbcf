// SPDX-License-Identifier: GPL-3.0-or-later
// Opening Embree in the running process or from a file.
#include "scene/embree_api.h"

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace opal {
namespace {

#if defined(_WIN32)
constexpr const char *kSoname = "embree4.dll";
void *open_library(const char *path) { return reinterpret_cast<void *>(LoadLibraryA(path)); }
void *find_symbol(void *library, const char *name) {
  return reinterpret_cast<void *>(GetProcAddress(static_cast<HMODULE>(library), name));
}
#else
#if defined(__APPLE__)
constexpr const char *kSoname = "libembree4.dylib";
#else
constexpr const char *kSoname = "libembree4.so.4";
#endif
void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
void *find_symbol(void *library, const char *name) { return dlsym(library, name); }
#endif

template <class Function>
void bind(Function &function, void *library, const char *name) {
  function = reinterpret_cast<Function>(find_symbol(library, name));
  if (!function) throw EmbreeError(std::string("Embree has no function ") + name + "; Opal needs Embree 4");
}

}  // namespace

void EmbreeApi::open(const char *path) {
  const bool given = path && *path;
  library = open_library(given ? path : kSoname);
  if (!library)
    throw EmbreeError(std::string("Embree was not found: looked for ") + (given ? path : kSoname) +
                      (given ? "" : " in the running process and the system's library folders"));
  bind(new_device, library, "rtcNewDevice");
  bind(release_device, library, "rtcReleaseDevice");
  bind(device_property, library, "rtcGetDeviceProperty");
  bind(device_error, library, "rtcGetDeviceError");
  bind(new_scene, library, "rtcNewScene");
  bind(release_scene, library, "rtcReleaseScene");
  bind(set_scene_flags, library, "rtcSetSceneFlags");
  bind(set_scene_quality, library, "rtcSetSceneBuildQuality");
  bind(commit_scene, library, "rtcCommitScene");
  bind(set_progress_monitor, library, "rtcSetSceneProgressMonitorFunction");
  bind(attach_by_id, library, "rtcAttachGeometryByID");
  bind(detach, library, "rtcDetachGeometry");
  bind(get_geometry, library, "rtcGetGeometry");
  bind(new_geometry, library, "rtcNewGeometry");
  bind(release_geometry, library, "rtcReleaseGeometry");
  bind(commit_geometry, library, "rtcCommitGeometry");
  bind(set_time_steps, library, "rtcSetGeometryTimeStepCount");
  bind(set_mask, library, "rtcSetGeometryMask");
  bind(set_shared_buffer, library, "rtcSetSharedGeometryBuffer");
  bind(set_instanced_scene, library, "rtcSetGeometryInstancedScene");
  bind(set_transform, library, "rtcSetGeometryTransform");
  bind(set_transform_quaternion, library, "rtcSetGeometryTransformQuaternion");
  bind(intersect1, library, "rtcIntersect1");
  bind(occluded1, library, "rtcOccluded1");
}

}  // namespace opal
