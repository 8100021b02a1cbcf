// SPDX-License-Identifier: GPL-3.0-or-later
// Gems touch what their bounds meet. Fog, which often holds all the rest of a scene, touches what reaches one of its faces. A
// medium's mesh may also touch itself: cubes that an array has put side by side.
#include "scene/touching.h"

#include <algorithm>
#include <numeric>

namespace opal {
namespace {

constexpr size_t kMostPairs = 20'000'000;  // to look at; of more, all are taken to touch
constexpr int kMostFaces = 1024;           // of a medium, to compare one by one
constexpr size_t kMostShells = 1024;       // of a mesh, likewise
// Of coordinates: how far apart faces lie that a ray's offset could still pass over (offset_origin).
constexpr float kGemSlack = 1e-6f, kMediumSlack = 1e-5f;

Vec3 absolute_largest(const Bounds &b) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = std::max(std::abs(b.low[i]), std::abs(b.high[i]));
  return v;
}

bool overlap(const Bounds &a, const Bounds &b, float slack) {
  const Vec3 width = (absolute_largest(a) + absolute_largest(b)) * slack;
  for (int i = 0; i < 3; ++i)
    if (a.low[i] > b.high[i] + width[i] || b.low[i] > a.high[i] + width[i]) return false;
  return true;
}

// The bounds of each face in the world; of a moving or a fine mesh, of the whole.
std::vector<Bounds> face_bounds(const Mesh &mesh, const Instance &instance, const Bounds &whole) {
  if (instance.motion || mesh.moving() || mesh.n_triangles() > kMostFaces) return {whole};
  std::vector<Bounds> faces(size_t(mesh.n_triangles()));
  for (size_t i = 0; i < faces.size(); ++i)
    for (size_t k = 0; k < 3; ++k) faces[i].extend(instance.to_world.point(mesh.vertex(mesh.triangles[3 * i + k])));
  return faces;
}

// Whether more than two faces meet in an edge: shells that have been welded together.
bool is_welded(const Mesh &mesh) {
  std::vector<std::pair<int32_t, int32_t>> edges;
  edges.reserve(mesh.triangles.size());
  for (size_t i = 0; i < mesh.triangles.size(); i += 3)
    for (size_t k = 0; k < 3; ++k) edges.push_back(std::minmax({mesh.triangles[i + k], mesh.triangles[i + (k + 1) % 3]}));
  std::sort(edges.begin(), edges.end());
  for (size_t i = 2; i < edges.size(); ++i)
    if (edges[i] == edges[i - 2]) return true;
  return false;
}

// Whether the bounds of two shells meet: parts that share no corner.
bool shells_meet(const Mesh &mesh) {
  std::vector<int32_t> parent(mesh.positions.size() / 3);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int32_t v) {
    while (parent[size_t(v)] != v) v = parent[size_t(v)] = parent[size_t(parent[size_t(v)])];
    return v;
  };
  for (size_t i = 0; i < mesh.triangles.size(); i += 3)
    for (size_t k = 1; k < 3; ++k) parent[size_t(root(mesh.triangles[i]))] = root(mesh.triangles[i + k]);
  std::vector<int> number(parent.size(), -1);
  std::vector<Bounds> shells;
  for (const int32_t v : mesh.triangles) {
    int &of_root = number[size_t(root(v))];
    if (of_root < 0) of_root = int(shells.size()), shells.emplace_back();
    shells[size_t(of_root)].extend(mesh.vertex(v));
  }
  if (shells.size() > kMostShells) return true;
  for (size_t i = 0; i < shells.size(); ++i)
    for (size_t k = 0; k < i; ++k)
      if (overlap(shells[i], shells[k], kMediumSlack)) return true;
  return false;
}

bool touches_itself(Mesh &mesh) {
  if (!mesh.touches_itself) mesh.touches_itself = shells_meet(mesh) || is_welded(mesh);
  return *mesh.touches_itself;
}

template <class Of>
bool has_material(const Scene &scene, const Instance &instance, const Of &of) {
  for (const int32_t m : scene.groups[instance.group].materials)
    if (m >= 0 && of(scene.materials[size_t(m)])) return true;
  return false;
}

}  // namespace

void find_touching(Scene &scene) {
  std::vector<uint32_t> gems, media;
  std::vector<Bounds> bounds;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    Instance &instance = scene.instances[i];
    instance.touching = false;
    bounds.push_back(world_bounds(scene.meshes[instance.mesh]->bounds, instance));
    if (has_material(scene, instance, [](const Material &m) { return m.is_gem; })) gems.push_back(i);
    else if (has_material(scene, instance, [](const Material &m) { return m.medium >= 0; })) media.push_back(i);
  }
  std::vector<uint32_t> by_size(bounds.size());
  std::iota(by_size.begin(), by_size.end(), 0u);
  std::stable_sort(by_size.begin(), by_size.end(), [&](uint32_t a, uint32_t b) {
    return length_squared(bounds[a].high - bounds[a].low) > length_squared(bounds[b].high - bounds[b].low);
  });
  for (uint32_t i = 0; i < by_size.size(); ++i) scene.instances[by_size[i]].order = i;
  const bool all = (gems.size() + media.size()) * scene.instances.size() > kMostPairs;
  if (all)
    for (Instance &instance : scene.instances) instance.touching = true;
  for (size_t g = 0; !all && g < gems.size(); ++g) {
    scene.stop_if_cancelled();
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
      const uint32_t gem = gems[g];
      if (i != gem && overlap(bounds[gem], bounds[i], kGemSlack))
        scene.instances[gem].touching = scene.instances[i].touching = true;
    }
  }
  for (size_t m = 0; !all && m < media.size(); ++m) {
    scene.stop_if_cancelled();
    Instance &medium = scene.instances[media[m]];
    Mesh &mesh = *scene.meshes[medium.mesh];
    const std::vector<Bounds> faces = face_bounds(mesh, medium, bounds[media[m]]);
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
      if (i == media[m] || !overlap(bounds[media[m]], bounds[i], kMediumSlack)) continue;
      if (std::any_of(faces.begin(), faces.end(), [&](const Bounds &face) { return overlap(face, bounds[i], kMediumSlack); }))
        medium.touching = scene.instances[i].touching = true;
    }
    if (touches_itself(mesh)) medium.touching = true;
  }
  scene.any_touching =
      std::any_of(scene.instances.begin(), scene.instances.end(), [](const Instance &i) { return i.touching; });
}

}  // namespace opal
