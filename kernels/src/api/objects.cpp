// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface: meshes, instances, and what a program makes of places on them.
#include "api/guarded.h"
#include "core/parallel.h"

#include <cstring>

namespace {

using namespace opal;

// start, end: both or neither. What is flat at any of its keys has no turn to interpolate and stands still.
void set_transform(Instance &instance, const float *middle, const float *start, const float *end) {
  instance.to_world = transform_from(middle);
  instance.to_object = inverse(instance.to_world);
  instance.mirrored = instance.to_world.determinant() < 0;
  instance.motion.reset();
  const auto same = [&](const float *key) { return std::memcmp(key, middle, 12 * sizeof(float)) == 0; };
  if (!start || (same(start) && same(end))) return;
  const Transform open = transform_from(start), close = transform_from(end);
  if (open.determinant() == 0 || close.determinant() == 0 || instance.to_world.determinant() == 0) return;
  instance.motion = std::make_shared<const Motion>(open, instance.to_world, close);
}

// The values of element i, of `width` floats each, or NULL.
const float *element(const float *values, size_t i, size_t width = 12) { return values ? values + width * i : nullptr; }
bool finite_or_none(const float *values, size_t count) { return !values || all_finite(values, count); }

}  // namespace

extern "C" {

int32_t opal_scene_add_mesh(opal_scene *scene, const opal_mesh_desc *desc, int32_t *n_dropped) {
  return guarded([&] {
    require(scene && desc && desc->n_vertices >= 0 && desc->n_triangles >= 0, "No mesh");
    require(desc->n_triangles == 0 || (desc->positions && desc->triangles),
            "A mesh with triangles needs positions and corners");
    require(!desc->positions_start == !desc->positions_end, "A mesh that moves needs positions at both ends of the shutter");
    auto mesh = std::make_unique<Mesh>();
    const size_t nv = size_t(desc->n_vertices), nt = size_t(desc->n_triangles);
    for (size_t i = 0; i < nt * 3; ++i)
      require(desc->triangles[i] >= 0 && desc->triangles[i] < desc->n_vertices,
              "A triangle names a vertex that does not exist");

    std::vector<uint8_t> finite(nv, 1);
    for (size_t i = 0; i < nv; ++i)
      finite[i] = all_finite(desc->positions + 3 * i, 3) && finite_or_none(element(desc->positions_start, i, 3), 3) &&
                  finite_or_none(element(desc->positions_end, i, 3), 3);
    std::vector<int32_t> kept;  // triangles whose corners are finite
    kept.reserve(nt);
    for (size_t t = 0; t < nt; ++t) {
      const int32_t *c = desc->triangles + 3 * t;
      if (finite[size_t(c[0])] && finite[size_t(c[1])] && finite[size_t(c[2])]) kept.push_back(int32_t(t));
    }
    if (n_dropped) *n_dropped = int32_t(nt - kept.size());
    const bool all = kept.size() == nt;
    const auto pick = [&](const auto *values, size_t width) {
      using T = std::remove_const_t<std::remove_pointer_t<decltype(values)>>;
      if (!values) return std::vector<T>();
      if (all) return std::vector<T>(values, values + nt * width);
      std::vector<T> out;
      out.reserve(kept.size() * width);
      for (const int32_t t : kept) out.insert(out.end(), values + size_t(t) * width, values + (size_t(t) + 1) * width);
      return out;
    };
    // Embree reads vertices 16 bytes at a time: room for one more float behind the last.
    const auto vertices = [&](const float *values) {
      std::vector<float> out;
      if (!values) return out;
      out.reserve(nv * 3 + 4);
      out.assign(values, values + nv * 3);
      for (size_t i = 0; i < nv; ++i)
        if (!finite[i]) out[3 * i] = out[3 * i + 1] = out[3 * i + 2] = 0;
      return out;
    };
    mesh->positions = vertices(desc->positions);
    mesh->positions_start = vertices(desc->positions_start);
    mesh->positions_end = vertices(desc->positions_end);
    mesh->triangles = pick(desc->triangles, 3);
    mesh->corner_normals = pick(desc->corner_normals, 9);
    mesh->corner_tangents = pick(desc->corner_tangents, 12);
    mesh->material_slots = pick(desc->material_slots, 1);
    mesh->generated = copy(desc->generated, desc->generated ? nv * 3 : 0);
    for (int32_t i = 0; i < desc->n_attributes; ++i) {
      const opal_attribute_desc &a = desc->attributes[i];
      require(a.values && a.components >= 1 && a.components <= 4, "An attribute has 1 to 4 components");
      const size_t width = size_t(a.components);
      Attribute attribute{a.name, a.domain, a.components, {}};
      switch (a.domain) {
        case OPAL_DOMAIN_CORNER: attribute.values = pick(a.values, 3 * width); break;
        case OPAL_DOMAIN_FACE: attribute.values = pick(a.values, width); break;
        case OPAL_DOMAIN_VERTEX: attribute.values = copy(a.values, nv * width); break;
        default: throw BadArgument("Unknown attribute domain");
      }
      mesh->attributes.push_back(std::move(attribute));
    }
    for (const int32_t c : mesh->triangles) {
      mesh->bounds.extend(mesh->vertex(c));
      if (mesh->moving()) mesh->bounds.extend(mesh->vertex(c, 0)), mesh->bounds.extend(mesh->vertex(c, 1));
    }
    scene->meshes.push_back(std::move(mesh));
    scene->geometry_dirty = true;
    return int32_t(scene->meshes.size() - 1);
  });
}

int32_t opal_scene_add_instances(opal_scene *scene, const opal_instances_desc *desc) {
  return guarded([&] {
    require(scene && desc && desc->count >= 0 && (desc->transforms || desc->count == 0), "No transforms");
    require(desc->mesh >= 0 && size_t(desc->mesh) < scene->meshes.size(), "Instances name a mesh that does not exist");
    const size_t n = size_t(desc->count);
    require(all_finite(desc->transforms, n * 12) && finite_or_none(desc->transforms_start, n * 12) &&
                finite_or_none(desc->transforms_end, n * 12),
            "A transform is not finite");
    require(!desc->transforms_start == !desc->transforms_end,
            "Instances that move need transforms at both ends of the shutter");
    InstanceGroup group;
    group.materials = copy(desc->materials, desc->materials ? size_t(desc->n_materials) : 0);
    for (const int32_t m : group.materials)
      require(m < int32_t(scene->materials.size()), "Instances name a material that does not exist");
    group.visibility = desc->visibility & OPAL_RAY_ALL;
    group.holdout = desc->holdout != 0;
    group.light_group = desc->light_group;
    scene->groups.push_back(std::move(group));
    const int32_t first = int32_t(scene->instances.size());
    scene->instances.reserve(scene->instances.size() + n);
    for (size_t i = 0; i < n; ++i) {
      Instance instance;
      instance.mesh = uint32_t(desc->mesh);
      instance.group = uint32_t(scene->groups.size() - 1);
      set_transform(instance, desc->transforms + 12 * i, element(desc->transforms_start, i), element(desc->transforms_end, i));
      if (desc->object_info) {
        const float *info = desc->object_info + 8 * i;
        instance.random = info[0], instance.object_index = info[1];
        std::copy(info + 2, info + 6, instance.color);
      }
      scene->instances.push_back(std::move(instance));
    }
    scene->instances_dirty = true;
    return first;
  });
}

int32_t opal_scene_set_transforms(opal_scene *scene, int32_t first, int32_t count, const float *middle, const float *start,
                                  const float *end) {
  return guarded([&] {
    require(scene && middle && first >= 0 && count >= 0 && size_t(first) + size_t(count) <= scene->instances.size(),
            "No such instances");
    const size_t n = size_t(count);
    require(all_finite(middle, n * 12) && finite_or_none(start, n * 12) && finite_or_none(end, n * 12),
            "A transform is not finite");
    require(!start == !end, "Instances that move need transforms at both ends of the shutter");
    for (size_t i = 0; i < n; ++i)
      set_transform(scene->instances[size_t(first) + i], middle + 12 * i, element(start, i), element(end, i));
    scene->instances_dirty = true;
    return 0;
  });
}

int32_t opal_scene_evaluate(const opal_scene *scene, const opal_program *desc, const opal_places_desc *places, float *out) {
  return guarded([&] {
    require(scene && desc && places && out && places->n >= 0 && places->n < INT32_MAX && (places->n == 0 || places->positions),
            "No places");
    Program program;
    const char *error = nullptr;
    if (!program_from_desc(*desc, int(scene->images.size()), program, &error))
      throw BadArgument(error ? error : "The program is not valid");
    // Each place is a triangle without extent of a mesh made for the purpose.
    const size_t n = size_t(places->n);
    Mesh mesh;
    mesh.positions = copy(places->positions, 3 * n);
    mesh.generated = places->generated ? copy(places->generated, 3 * n) : std::vector<float>(3 * n, 0.0f);
    mesh.triangles.resize(3 * n);
    for (size_t i = 0; i < 3 * n; ++i) mesh.triangles[i] = int32_t(i / 3);
    for (int32_t i = 0; i < places->n_attributes; ++i) {
      const opal_attribute_desc &a = places->attributes[i];
      require(a.values && a.components >= 1 && a.components <= 4 && a.domain == OPAL_DOMAIN_VERTEX,
              "An attribute of places has 1 to 4 components for each");
      mesh.attributes.push_back({a.name, a.domain, a.components, copy(a.values, n * size_t(a.components))});
    }
    Instance instance;
    const Transform identity;
    set_transform(instance, places->transform ? places->transform : identity.m, nullptr, nullptr);
    if (places->object_info) {
      instance.random = places->object_info[0], instance.object_index = places->object_info[1];
      std::copy(places->object_info + 2, places->object_info + 6, instance.color);
    }
    constexpr int64_t kChunk = 4096;
    const std::atomic<bool> never{false};
    parallel_for((places->n + kChunk - 1) / kChunk, resolve_threads(scene->threads), never, [&](int64_t chunk) {
      for (int64_t i = chunk * kChunk; i < std::min(places->n, (chunk + 1) * kChunk); ++i) {
        ShadingPoint sp;
        sp.p = instance.to_world.point(mesh.vertex(int(i)));
        sp.ng = sp.ns = sp.wo = {0, 0, 1};
        sp.triangle = uint32_t(i);
        sp.mesh = &mesh, sp.instance = &instance;
        sp.ray_kind = OPAL_RAY_SCATTER;
        const Vec3 emitted = run_emission(*scene, program, sp);
        for (int c = 0; c < 3; ++c) out[3 * i + c] = emitted[c];
      }
    });
    return 0;
  });
}

}  // extern "C"
