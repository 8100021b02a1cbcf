// SPDX-License-Identifier: GPL-3.0-or-later
// The few functions and structures of Embree 4 that Opal uses, declared after its API documentation
// (github.com/RenderKit/embree, include/embree4) and opened at run time: Blender carries the library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace opal {

struct EmbreeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

using RTCDevice = struct RTCDeviceTy *;
using RTCScene = struct RTCSceneTy *;
using RTCGeometry = struct RTCGeometryTy *;

enum : int { kRtcGeometryTriangle = 0, kRtcGeometryInstance = 121 };
enum : int { kRtcBufferIndex = 0, kRtcBufferVertex = 1 };
enum : int { kRtcFormatUint3 = 0x5003, kRtcFormatFloat3 = 0x9003, kRtcFormatFloat3x4RowMajor = 0x9134 };
enum : int { kRtcQualityLow = 0, kRtcQualityMedium = 1, kRtcQualityHigh = 2 };
enum : int { kRtcSceneDynamic = 1, kRtcSceneRobust = 4 };
enum : int { kRtcPropertyVersion = 0, kRtcPropertyRayMask = 64 };
enum : int { kRtcErrorOutOfMemory = 4, kRtcErrorCancelled = 6 };
inline constexpr unsigned kRtcInvalid = ~0u;

struct alignas(16) RTCRayHit {
  float org_x, org_y, org_z, tnear;
  float dir_x, dir_y, dir_z, time;
  float tfar;
  unsigned mask, id, flags;
  alignas(16) float ng_x;
  float ng_y, ng_z, u, v;
  unsigned prim, geom;
  unsigned instance[2];  // instID, and instPrimID in builds that have instance arrays
  unsigned padding[7];
};

// The occlusion query takes the ray part alone.
struct alignas(16) RTCRay {
  float org_x, org_y, org_z, tnear;
  float dir_x, dir_y, dir_z, time;
  float tfar;
  unsigned mask, id, flags;
};

// A query's context; only its instance numbers are Embree's, and a caller may keep its own data behind it.
struct RTCRayQueryContext {
  unsigned instance[4] = {kRtcInvalid, kRtcInvalid, kRtcInvalid, kRtcInvalid};  // as in RTCRayHit, with room to spare
};
struct RTCHit {
  float ng_x, ng_y, ng_z, u, v;
  unsigned prim, geom;
  unsigned instance[2];
};
struct RTCFilterArguments {
  int *valid;
  void *geometry_data;
  RTCRayQueryContext *context;
  RTCRay *ray;
  RTCHit *hit;
  unsigned n;  // 1
};
struct RTCIntersectArguments {
  int flags = 0;
  unsigned feature_mask = ~0u;
  RTCRayQueryContext *context = nullptr;
  void (*filter)(const RTCFilterArguments *) = nullptr;
  void *intersect = nullptr;
  void *padding[2] = {};
};
enum : int { kRtcInvokeArgumentFilter = 2 };

// A transform as Embree interpolates it where it turns (core/motion.h).
struct alignas(16) RTCQuaternionDecomposition {
  float scale_x, scale_y, scale_z;
  float skew_xy, skew_xz, skew_yz;
  float shift_x, shift_y, shift_z;
  float quaternion_r, quaternion_i, quaternion_j, quaternion_k;
  float translation_x, translation_y, translation_z;
};

struct EmbreeApi {
  void *library = nullptr;
  RTCDevice (*new_device)(const char *config) = nullptr;
  void (*release_device)(RTCDevice) = nullptr;
  ptrdiff_t (*device_property)(RTCDevice, int) = nullptr;
  int (*device_error)(RTCDevice) = nullptr;
  RTCScene (*new_scene)(RTCDevice) = nullptr;
  void (*release_scene)(RTCScene) = nullptr;
  void (*set_scene_flags)(RTCScene, int) = nullptr;
  void (*set_scene_quality)(RTCScene, int) = nullptr;
  void (*commit_scene)(RTCScene) = nullptr;
  // Called by any of the building threads with the part that is done; false ends the build.
  void (*set_progress_monitor)(RTCScene, bool (*)(void *user, double done), void *user) = nullptr;
  void (*attach_by_id)(RTCScene, RTCGeometry, unsigned) = nullptr;
  void (*detach)(RTCScene, unsigned) = nullptr;
  RTCGeometry (*get_geometry)(RTCScene, unsigned) = nullptr;
  RTCGeometry (*new_geometry)(RTCDevice, int) = nullptr;
  void (*release_geometry)(RTCGeometry) = nullptr;
  void (*commit_geometry)(RTCGeometry) = nullptr;
  void (*set_time_steps)(RTCGeometry, unsigned) = nullptr;
  void (*set_mask)(RTCGeometry, unsigned) = nullptr;
  void (*set_shared_buffer)(RTCGeometry, int type, unsigned slot, int format, const void *, size_t offset, size_t stride,
                            size_t count) = nullptr;
  void (*set_instanced_scene)(RTCGeometry, RTCScene) = nullptr;
  void (*set_transform)(RTCGeometry, unsigned step, int format, const void *) = nullptr;
  void (*set_transform_quaternion)(RTCGeometry, unsigned step, const RTCQuaternionDecomposition *) = nullptr;
  void (*intersect1)(RTCScene, RTCRayHit *, void *arguments) = nullptr;
  void (*occluded1)(RTCScene, RTCRay *, void *arguments) = nullptr;
  int version = 0;        // major * 10000 + minor * 100 + patch
  bool ray_mask = false;  // the build tests masks itself

  // path: a file or soname; NULL or empty searches the running process. Throws EmbreeError with a sentence that says
  // what was looked for and where.
  void open(const char *path);
};

}  // namespace opal
