// SPDX-License-Identifier: GPL-3.0-or-later
// The scene: what a caller described, plus what commit() built from it. Immutable while a render runs.
#pragma once

#include "core/colour.h"
#include "core/motion.h"
#include "core/vec.h"
#include "lights/lights.h"
#include "media/medium.h"
#include "opal.h"
#include "scene/embree_api.h"
#include "shader/shader.h"

#include <atomic>
#include <memory>
#include <stdexcept>
#include <optional>
#include <string>
#include <vector>

namespace opal {

// A stop was asked for while commit() built.
struct CommitCancelled : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Image {
  int width = 0, height = 0, channels = 4;
  int pixel_type = OPAL_PIXEL_U8, transfer = OPAL_TRANSFER_LINEAR;
  std::vector<uint8_t> bytes;
  std::vector<float> floats;
};

struct Attribute {
  int name = 0, domain = 0, components = 0;
  std::vector<float> values;
};

struct Mesh {
  std::vector<float> positions;         // 3 a vertex (+1 float of padding at the end, for Embree)
  std::vector<float> positions_start;   // where the shutter opens (`positions`: its middle); empty without motion
  std::vector<float> positions_end;     // where it closes; empty without motion
  std::vector<int32_t> triangles;       // 3 a triangle
  std::vector<float> corner_normals;    // 9 a triangle, or empty: flat
  std::vector<float> corner_tangents;   // 12 a triangle, or empty
  std::vector<int32_t> material_slots;  // 1 a triangle, or empty: 0
  std::vector<float> generated;         // 3 a vertex, or empty
  std::vector<Attribute> attributes;
  Bounds bounds;              // object space, all of the motion
  RTCScene embree = nullptr;  // one-triangle-mesh scene, instanced
  bool dirty = true;
  std::optional<bool> touches_itself;  // scene/touching.h; not known until asked

  int n_triangles() const { return int(triangles.size() / 3); }
  Vec3 vertex(int i) const { return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]}; }
  Vec3 vertex(int i, float time) const;
  bool moving() const { return !positions_end.empty(); }
};

struct Instance {
  uint32_t mesh = 0;
  Transform to_world, to_object;         // in the middle of the shutter
  std::shared_ptr<const Motion> motion;  // null: it stands still
  bool mirrored = false;                 // negative determinant
  bool touching = false;                 // its faces may coincide with those of a gem or a medium (scene/touching.h)
  uint32_t order = 0;                    // by falling size of the bounds: the smallest comes last
  uint32_t group = 0;                    // index into Scene::groups
  float random = 0, object_index = 0;
  float color[4] = {1, 1, 1, 1};

  Transform to_world_at(float time) const { return motion ? motion->at(time) : to_world; }
};

// What instances of one call share.
struct InstanceGroup {
  std::vector<int32_t> materials;
  uint32_t visibility = OPAL_RAY_ALL;
  bool holdout = false;
  int light_group = -1;
};

struct Material {
  Program surface;
  bool is_gem = false;
  opal_gem_desc gem{};
  int medium = -1;  // inside of the mesh
  uint32_t flags = 0;
  bool no_surface() const { return (flags & OPAL_MATERIAL_NO_SURFACE) != 0; }
};

struct EmissiveTriangle {
  uint32_t instance = 0, triangle = 0, material = 0;
  Vec3 p0, p1, p2;  // world space, in the middle of the shutter
  float area = 0;
  Vec3 emission;  // estimate, for importance
};

struct Lamp {
  opal_light_desc desc{};
  Transform to_world, to_local;
  Vec3 position, axis;  // axis: the direction it looks in
};

struct World {
  bool present = false;
  Program program;
  uint32_t visibility = OPAL_RAY_ALL;
  int map_width = 0;
  bool caustics = true;
};

struct Hit {
  float t = kInfinity, u = 0, v = 0;
  uint32_t instance = 0, triangle = 0;
  bool valid() const { return t < kInfinity; }
};

struct Scene {
  ~Scene();

  ColourTables colour;
  EmbreeApi embree;
  RTCDevice device = nullptr;
  RTCScene top = nullptr;
  int threads = 0;

  std::vector<Image> images;
  std::vector<SpectralTable> spectra;
  std::vector<PhaseFunction> phases;
  std::vector<std::unique_ptr<Grid>> grids;
  std::vector<Medium> media;
  int world_medium = -1;
  std::vector<Material> materials;
  std::vector<std::unique_ptr<Mesh>> meshes;
  std::vector<Instance> instances;
  std::vector<InstanceGroup> groups;
  std::vector<Lamp> lamps;
  World world;
  opal_camera_desc camera{};
  bool has_camera = false;

  // Built by commit().
  Bounds bounds;                   // of everything finite
  float world_floor = -kInfinity;  // the world's medium, if it thins with height, scatters nothing below: there is ground
  std::vector<EmissiveTriangle> emissive;  // sorted by (instance, triangle)
  std::vector<EmissionTarget> casters;     // spheres round what can make caustics
  std::shared_ptr<LightTables> lights;
  double build_seconds = 0;
  int64_t mesh_builds = 0, top_builds = 0, light_builds = 0;  // since the scene was created
  bool any_transparent_shadow = false;                        // a material that shadow rays must look through
  bool any_touching = false;                                  // faces of gems or media may coincide with others
  bool any_medium = false;                                    // rays must keep track of what they are in
  bool any_glowing_medium = false;                            // a medium gives off light
  bool geometry_dirty = true, instances_dirty = true, lights_dirty = true;
  bool world_dirty = true;  // its map; part of the lights

  Hit intersect(const Ray &ray, uint32_t visibility) const;
  bool occluded(const Ray &ray, uint32_t visibility) const;  // opaque things only matter to the caller
  const Material &material_at(const Hit &hit) const;
  uint32_t material_index(uint32_t instance, uint32_t triangle) const;
  // Fills everything but ray_kind and depth.
  ShadingPoint shading_point(const Ray &ray, const Hit &hit) const;
  // `emissive[index]` as it lies then.
  EmissiveTriangle emissive_at(uint32_t index, float time) const;
  // Index into `emissive` or -1.
  int find_emissive(uint32_t instance, uint32_t triangle) const;
  int64_t memory_bytes() const;

  // Building (scene/build.cpp). Throws std::bad_alloc, EmbreeError or CommitCancelled; the next builds the rest.
  void commit();
  // Ends the commit that runs, or else the next; from any thread.
  void cancel_commit() { commit_cancelled = true; }
  void stop_if_cancelled() const {
    if (commit_cancelled.load(std::memory_order_relaxed)) throw CommitCancelled("Cancelled");
  }
  std::atomic<bool> commit_cancelled{false};
  // Restricts the wavelengths that paths sample; light tables do not depend on it.
  void set_wavelengths(float first, float last);

  // The caller's tables, kept because the range may change.
  std::vector<float> observer_table, d65_table, basis_table;
  opal_tables tables() const { return {observer_table.data(), d65_table.data(), basis_table.data()}; }
};

// Of an instance whose mesh has these bounds, with its motion.
Bounds world_bounds(const Bounds &local, const Instance &instance);

// Where a ray that leaves sp.p in `direction` may start: off the surface by the rounding error of the point, which is
// bounded axis by axis (Pharr, Jakob & Humphreys, "Managing rounding error"), so there is no absolute epsilon.
Vec3 offset_origin(const ShadingPoint &sp, const Vec3 &direction);

// Defined by lights/light_tables.cpp: everything sample_light & co need. Called by commit() when lights_dirty.
std::shared_ptr<LightTables> build_light_tables(const Scene &scene);
// Lets `colour` sample wavelengths where the scene's lights have their power.
void weigh_wavelengths(const Scene &scene, ColourTables &colour);

}  // namespace opal
