// SPDX-License-Identifier: GPL-3.0-or-later
// Prints how many nearest hits a second Embree alone finds on one thread: arguments are its library and a folder with
// corners, faces, origins and directions as raw arrays (float x 3, int32 x 3, float x 3, float x 3).
#include "scene/embree_api.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <limits>
#include <vector>

template <class T>
static std::vector<T> read(const std::string &path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<T> values(size_t(file.tellg()) / sizeof(T) + 16);  // Embree reads 16 bytes past the last corner
  const auto bytes = file.tellg();
  file.seekg(0);
  file.read(reinterpret_cast<char *>(values.data()), bytes);
  values.resize(size_t(bytes) / sizeof(T));
  return values;
}

int main(int, char **arguments) {
  using namespace opal;
  EmbreeApi embree;
  embree.open(arguments[1]);
  const std::string folder = std::string(arguments[2]) + "/";
  const auto corners = read<float>(folder + "corners"), origins = read<float>(folder + "origins"),
             directions = read<float>(folder + "directions");
  const auto faces = read<int>(folder + "faces");
  const RTCDevice device = embree.new_device("threads=1");
  const RTCScene scene = embree.new_scene(device);
  embree.set_scene_quality(scene, kRtcQualityMedium);
  embree.set_scene_flags(scene, kRtcSceneRobust);
  const RTCGeometry mesh = embree.new_geometry(device, kRtcGeometryTriangle);
  embree.set_shared_buffer(mesh, kRtcBufferVertex, 0, kRtcFormatFloat3, corners.data(), 0, 12, corners.size() / 3);
  embree.set_shared_buffer(mesh, kRtcBufferIndex, 0, kRtcFormatUint3, faces.data(), 0, 12, faces.size() / 3);
  embree.commit_geometry(mesh);
  embree.attach_by_id(scene, mesh, 0);
  embree.commit_scene(scene);
  const auto start = std::chrono::steady_clock::now();
  const size_t count = origins.size() / 3;
  size_t hits = 0;
  for (size_t i = 0; i < count; ++i) {
    RTCRayHit ray{};
    ray.org_x = origins[3 * i], ray.org_y = origins[3 * i + 1], ray.org_z = origins[3 * i + 2];
    ray.dir_x = directions[3 * i], ray.dir_y = directions[3 * i + 1], ray.dir_z = directions[3 * i + 2];
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
    ray.geom = ray.instance[0] = kRtcInvalid;
    embree.intersect1(scene, &ray, nullptr);
    hits += ray.geom != kRtcInvalid;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("%.0f\n", hits > 0 ? double(count) / seconds : 0.0);
}
