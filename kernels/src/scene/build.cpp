// SPDX-License-Identifier: GPL-3.0-or-later
// commit(): acceleration structures, the list of emissive triangles, the spheres round what makes caustics.
//
// Meshes become Embree scenes of their own, instances refer to them: a hundred thousand copies cost a transform each,
// an edited colour rebuilds nothing and a moved object the top level alone.
#include "core/stopwatch.h"
#include "scene/touching.h"

#include <algorithm>

namespace opal {
namespace {

constexpr size_t kMaxCasters = 64;
// Instances or triangles that are built before it is asked again whether to stop.
constexpr size_t kBetweenChecks = 4096;

void check(const EmbreeApi &embree, RTCDevice device, const char *what) {
  if (const int error = embree.device_error(device)) {
    if (error == kRtcErrorOutOfMemory) throw std::bad_alloc();
    if (error == kRtcErrorCancelled) throw CommitCancelled("Cancelled");
    throw EmbreeError(std::string("Embree failed with error ") + std::to_string(error) + " while " + what);
  }
}

// Builds Embree's tree, and asks while it does whether to stop.
void commit_embree(const Scene &scene, RTCScene tree, const char *what) {
  const auto goes_on = [](void *user, double) { return !static_cast<const Scene *>(user)->commit_cancelled.load(); };
  scene.embree.set_progress_monitor(tree, goes_on, const_cast<Scene *>(&scene));
  scene.embree.commit_scene(tree);
  check(scene.embree, scene.device, what);
}

void build_mesh(const Scene &scene, Mesh &mesh) {
  const EmbreeApi &embree = scene.embree;
  const RTCDevice device = scene.device;
  if (mesh.embree) embree.release_scene(mesh.embree);
  mesh.embree = embree.new_scene(device);
  embree.set_scene_flags(mesh.embree, kRtcSceneRobust);
  if (mesh.n_triangles() > 0) {
    RTCGeometry geometry = embree.new_geometry(device, kRtcGeometryTriangle);
    const size_t n_vertices = mesh.positions.size() / 3;
    unsigned step = 0;
    const auto add_vertices = [&](const std::vector<float> &positions) {
      embree.set_shared_buffer(geometry, kRtcBufferVertex, step++, kRtcFormatFloat3, positions.data(), 0, 12, n_vertices);
    };
    if (mesh.moving()) {
      embree.set_time_steps(geometry, Motion::kKeys);
      for (const auto *positions : {&mesh.positions_start, &mesh.positions, &mesh.positions_end}) add_vertices(*positions);
    } else {
      add_vertices(mesh.positions);
    }
    embree.set_shared_buffer(geometry, kRtcBufferIndex, 0, kRtcFormatUint3, mesh.triangles.data(), 0, 12,
                             size_t(mesh.n_triangles()));
    embree.set_mask(geometry, ~0u);
    embree.commit_geometry(geometry);
    embree.attach_by_id(mesh.embree, geometry, 0);
    embree.release_geometry(geometry);
  }
  commit_embree(scene, mesh.embree, "building a mesh");
  mesh.touches_itself.reset();
  mesh.dirty = false;
}

RTCQuaternionDecomposition for_embree(const DecomposedTransform &d) {
  const auto &[rotation, translation, scale, skew] = d;
  return {scale.x,    scale.y,    scale.z,    skew.x,        skew.y,        skew.z,       0, 0, 0, rotation.r,
          rotation.i, rotation.j, rotation.k, translation.x, translation.y, translation.z};
}

void build_top(Scene &scene) {
  const EmbreeApi &embree = scene.embree;
  if (scene.top) embree.release_scene(scene.top);
  scene.top = embree.new_scene(scene.device);
  embree.set_scene_flags(scene.top, kRtcSceneRobust);
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    if (i % kBetweenChecks == 0) scene.stop_if_cancelled();
    const Instance &instance = scene.instances[i];
    const Mesh &mesh = *scene.meshes[instance.mesh];
    // A singular transform flattens the object to nothing that a ray could hit from both sides of Embree's inverse.
    if (mesh.n_triangles() == 0 || instance.to_world.determinant() == 0) continue;
    RTCGeometry geometry = embree.new_geometry(scene.device, kRtcGeometryInstance);
    embree.set_instanced_scene(geometry, mesh.embree);
    if (instance.motion) {
      embree.set_time_steps(geometry, Motion::kKeys);
      for (unsigned step = 0; step < Motion::kKeys; ++step) {
        const RTCQuaternionDecomposition key = for_embree(instance.motion->keys[step]);
        embree.set_transform_quaternion(geometry, step, &key);
      }
    } else {
      embree.set_transform(geometry, 0, kRtcFormatFloat3x4RowMajor, instance.to_world.m);
    }
    embree.set_mask(geometry, scene.groups[instance.group].visibility);
    embree.commit_geometry(geometry);
    embree.attach_by_id(scene.top, geometry, unsigned(i));
    embree.release_geometry(geometry);
  }
  commit_embree(scene, scene.top, "building the scene");
}

// The sphere round an instance: about the centre of its bounds, or of what that centre passes, and as small as its vertices
// allow, whose distance from that centre no turn changes and is largest at a key.
EmissionTarget bounding_sphere(const Mesh &mesh, const Instance &instance) {
  const Vec3 centre_local = mesh.bounds.centre();
  EmissionTarget s;
  const size_t n = mesh.positions.size() / 3;
  const auto grow = [&](const Transform &m, const std::vector<float> &positions) {
    float r2 = 0;
    for (size_t i = 0; i < positions.size() / 3; ++i)
      r2 = std::max(
          r2, length_squared(m.vector(Vec3{positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]} - centre_local)));
    s.radius = std::max(s.radius, std::sqrt(r2));
  };
  const Bounds passed = instance.motion ? instance.motion->path(centre_local) : Bounds{};
  s.centre = instance.motion ? passed.centre() : instance.to_world.point(centre_local);
  if (n <= 100000) {
    for (const auto *positions : {&mesh.positions_start, &mesh.positions, &mesh.positions_end}) {
      if (!instance.motion) grow(instance.to_world, *positions);
      else
        for (int key = 0; key < Motion::kKeys; ++key) grow(instance.motion->at(Motion::time_of(key)), *positions);
    }
    s.radius += passed.radius();
  } else {
    s.radius = world_bounds(mesh.bounds, instance).radius() + length(s.centre - world_bounds(mesh.bounds, instance).centre());
  }
  s.radius *= 1.0001f;
  return s;
}

// Merges spheres by splitting their centres at the median of the widest axis until few enough groups are left.
void merge_targets(std::vector<EmissionTarget> &targets, size_t first, size_t last, size_t groups,
                   std::vector<EmissionTarget> &out) {
  if (first == last) return;
  if (groups <= 1 || last - first == 1) {
    Bounds b;
    for (size_t i = first; i < last; ++i) {
      const Vec3 r{targets[i].radius, targets[i].radius, targets[i].radius};
      b.extend(targets[i].centre - r), b.extend(targets[i].centre + r);
    }
    EmissionTarget merged{b.centre(), 0};
    for (size_t i = first; i < last; ++i)
      merged.radius = std::max(merged.radius, length(targets[i].centre - merged.centre) + targets[i].radius);
    out.push_back(last - first == 1 ? targets[first] : merged);
    return;
  }
  Bounds centres;
  for (size_t i = first; i < last; ++i) centres.extend(targets[i].centre);
  const Vec3 d = centres.high - centres.low;
  const int axis = d.x > d.y ? (d.x > d.z ? 0 : 2) : (d.y > d.z ? 1 : 2);
  const size_t middle = (first + last) / 2;
  std::nth_element(targets.begin() + ptrdiff_t(first), targets.begin() + ptrdiff_t(middle), targets.begin() + ptrdiff_t(last),
                   [axis](const EmissionTarget &a, const EmissionTarget &b) { return a.centre[axis] < b.centre[axis]; });
  merge_targets(targets, first, middle, groups / 2, out);
  merge_targets(targets, middle, last, groups - groups / 2, out);
}

bool uses(const Scene &scene, const Instance &instance, uint32_t flag) {
  for (const int32_t m : scene.groups[instance.group].materials)
    if (m >= 0 && (scene.materials[size_t(m)].flags & flag)) return true;
  return false;
}

void collect_casters(Scene &scene) {
  std::vector<EmissionTarget> all;
  for (const Instance &instance : scene.instances) {
    scene.stop_if_cancelled();
    const Mesh &mesh = *scene.meshes[instance.mesh];
    if (mesh.n_triangles() > 0 && uses(scene, instance, OPAL_MATERIAL_CASTER)) all.push_back(bounding_sphere(mesh, instance));
  }
  scene.casters.clear();
  if (all.size() <= kMaxCasters) scene.casters = std::move(all);
  else merge_targets(all, 0, all.size(), kMaxCasters, scene.casters);
}

void collect_emissive(Scene &scene) {
  scene.emissive.clear();
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance &instance = scene.instances[i];
    if (!uses(scene, instance, OPAL_MATERIAL_EMISSIVE)) continue;
    const Mesh &mesh = *scene.meshes[instance.mesh];
    for (uint32_t t = 0; t < uint32_t(mesh.n_triangles()); ++t) {
      if (t % kBetweenChecks == 0) scene.stop_if_cancelled();
      const uint32_t m = scene.material_index(i, t);
      const Material &material = scene.materials[m];
      if (!(material.flags & OPAL_MATERIAL_EMISSIVE)) continue;
      EmissiveTriangle e;
      e.instance = i, e.triangle = t, e.material = m;
      const int32_t *v = &mesh.triangles[size_t(t) * 3];
      e.p0 = instance.to_world.point(mesh.vertex(v[0]));
      e.p1 = instance.to_world.point(mesh.vertex(v[1]));
      e.p2 = instance.to_world.point(mesh.vertex(v[2]));
      e.area = 0.5f * length(cross(e.p1 - e.p0, e.p2 - e.p0));
      if (!(e.area > 0) || !std::isfinite(e.area)) continue;
      if (material.surface.constant_emission) {
        e.emission = material.surface.emission;
      } else {  // the mean over a few points of the face
        constexpr float kPoints[7][2] = {{1 / 3.f, 1 / 3.f}, {.1f, .1f},  {.8f, .1f},  {.1f, .8f},
                                         {.45f, .1f},        {.1f, .45f}, {.45f, .45f}};
        for (const auto &uv : kPoints) {
          const Vec3 p = e.p0 * (1 - uv[0] - uv[1]) + e.p1 * uv[0] + e.p2 * uv[1];
          const Vec3 n = safe_normalize(cross(e.p1 - e.p0, e.p2 - e.p0), {0, 0, 1});
          Hit hit{1, uv[0], uv[1], i, t};
          const ShadingPoint sp = scene.shading_point({p + n, -n, 0, kInfinity, 0}, hit);
          e.emission += max(run_emission(scene, material.surface, sp), Vec3{}) * (1 / 7.0f);
        }
      }
      if (max_component(e.emission) > 0) scene.emissive.push_back(e);
    }
  }
}

}  // namespace

Scene::~Scene() {
  if (top) embree.release_scene(top);
  for (const auto &mesh : meshes)
    if (mesh && mesh->embree) embree.release_scene(mesh->embree);
  if (device) embree.release_device(device);
}

int Scene::find_emissive(uint32_t instance, uint32_t triangle) const {
  const auto before = [](const EmissiveTriangle &e, std::pair<uint32_t, uint32_t> key) {
    return std::pair{e.instance, e.triangle} < key;
  };
  const auto it = std::lower_bound(emissive.begin(), emissive.end(), std::pair{instance, triangle}, before);
  if (it == emissive.end() || it->instance != instance || it->triangle != triangle) return -1;
  return int(it - emissive.begin());
}

void Scene::commit() {
  const Stopwatch start;
  // A stop is for one commit: the next one builds what this one leaves.
  struct Rearm {
    std::atomic<bool> &flag;
    ~Rearm() { flag = false; }
  } const rearm{commit_cancelled};
  stop_if_cancelled();
  if (materials.empty()) materials.emplace_back();
  if (geometry_dirty)
    for (const auto &mesh : meshes)
      if (mesh->dirty) {
        build_mesh(*this, *mesh);
        ++mesh_builds;
      }
  if (geometry_dirty || instances_dirty || !top) {
    build_top(*this);
    ++top_builds;
    bounds = {};
    for (const Instance &instance : instances) bounds.extend(world_bounds(meshes[instance.mesh]->bounds, instance));
  }
  if (geometry_dirty || instances_dirty || lights_dirty) {
    any_transparent_shadow = false;
    any_medium = world_medium >= 0;
    world_floor = -kInfinity;
    if (world_medium >= 0 && media[size_t(world_medium)].density.kind == DensityKind::Height) {
      const float base = media[size_t(world_medium)].density.base_height;
      world_floor = bounds.empty() ? base : std::min(base, bounds.low.z);
    }
    any_glowing_medium = false;
    for (const Medium &m : media) any_glowing_medium |= m.emission >= 0;
    for (const Material &m : materials) {
      any_transparent_shadow |= (m.flags & (OPAL_MATERIAL_TRANSPARENT_SHADOW | OPAL_MATERIAL_NO_SURFACE)) != 0;
      any_medium |= m.medium >= 0;
    }
    collect_casters(*this);
    find_touching(*this);
    collect_emissive(*this);
    lights = build_light_tables(*this);
    ++light_builds;
    weigh_wavelengths(*this, colour);
  }
  geometry_dirty = instances_dirty = lights_dirty = world_dirty = false;
  build_seconds = start.seconds();
}

void Scene::set_wavelengths(float first, float last) {
  colour.prepare(tables(), first, last);
  weigh_wavelengths(*this, colour);
}

int64_t Scene::memory_bytes() const {
  size_t bytes = instances.size() * sizeof(Instance) + emissive.size() * sizeof(EmissiveTriangle);
  for (const Instance &instance : instances) bytes += instance.motion ? sizeof(Motion) : 0;
  for (const auto &mesh : meshes) {
    bytes += (mesh->positions.size() + mesh->positions_start.size() + mesh->positions_end.size() + mesh->corner_normals.size() +
              mesh->corner_tangents.size() + mesh->generated.size()) *
             sizeof(float);
    bytes += (mesh->triangles.size() + mesh->material_slots.size()) * sizeof(int32_t);
    for (const Attribute &a : mesh->attributes) bytes += a.values.size() * sizeof(float);
  }
  for (const auto &grid : grids) bytes += size_t(grid->memory_bytes());
  for (const Image &image : images) bytes += image.bytes.size() + image.floats.size() * sizeof(float);
  return int64_t(bytes);
}

}  // namespace opal
