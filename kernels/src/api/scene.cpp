// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface: scenes, materials, lamps, world and camera.
#include "api/guarded.h"
#include "core/parallel.h"

namespace {

using namespace opal;

Material material_from(const Scene &scene, const opal_material_desc &desc) {
  Material m;
  const char *error = nullptr;
  if (!program_from_desc(desc.surface, int(scene.images.size()), m.surface, &error))
    throw BadArgument(error ? error : "The material's program is not valid");
  m.flags = desc.flags;
  m.medium = desc.medium - 1;
  require(m.medium < int(scene.media.size()), "The material names a medium that does not exist");
  if (desc.gem) {
    m.is_gem = true;
    m.gem = *desc.gem;
    const auto known = [&](int32_t s) { return s >= 0 && size_t(s) < scene.spectra.size(); };
    require(known(m.gem.index_spectrum), "The gem's index of refraction names a spectrum that does not exist");
    require(m.gem.absorption_spectrum < 0 || known(m.gem.absorption_spectrum),
            "The gem's absorption names a spectrum that does not exist");
    require(m.gem.roughness >= 0 && m.gem.roughness <= 1, "The gem's roughness is not between 0 and 1");
    m.flags |= OPAL_MATERIAL_CASTER;
  }
  return m;
}

// Material 0 of every scene: what faces without a material show, a matte grey of 0.8.
Material default_grey() {
  opal_instruction diffuse = {OPAL_OP_DIFFUSE, 0, -1, {-1, 0, 1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1}};
  const float constants[8] = {0.8f, 0.8f, 0.8f, 0.8f};
  opal_program desc{};
  desc.code = &diffuse;
  desc.n_instructions = 1;
  desc.n_constants = desc.n_registers = 2;
  desc.constants = constants;
  Material material;
  const char *error = nullptr;
  if (!program_from_desc(desc, 0, material.surface, &error)) throw std::logic_error(error);
  return material;
}

}  // namespace

extern "C" {

opal_scene *opal_scene_create(const opal_tables *tables, const char *embree_path, int32_t threads) {
  opal_scene *scene = nullptr;
  const int32_t status = guarded([&] {
    require(tables && tables->observer && tables->d65 && tables->basis, "The colour tables are missing");
    auto made = std::make_unique<opal_scene>();
    made->threads = std::max(0, threads);
    made->observer_table = copy(tables->observer, 3 * kTableSize);
    made->d65_table = copy(tables->d65, kTableSize);
    made->basis_table = copy(tables->basis, 3 * kTableSize);
    made->set_wavelengths(kTableFirst, kTableFirst + kTableSize - 1);
    made->embree.open(embree_path);
    const std::string config = threads > 0 ? "threads=" + std::to_string(threads) : std::string();
    made->device = made->embree.new_device(config.c_str());
    if (!made->device) throw EmbreeError("Embree could not be started on this processor");
    made->embree.version = int(made->embree.device_property(made->device, kRtcPropertyVersion));
    if (made->embree.version < 40000)
      throw EmbreeError("Opal needs Embree 4; the library found has version " + std::to_string(made->embree.version));
    made->embree.ray_mask = made->embree.device_property(made->device, kRtcPropertyRayMask) != 0;
    made->camera.type = OPAL_CAMERA_PERSPECTIVE;
    made->materials.push_back(default_grey());
    scene = made.release();
    return 0;
  });
  return status == OPAL_OK ? scene : nullptr;
}

void opal_scene_destroy(opal_scene *scene) { delete scene; }

int32_t opal_scene_add_image(opal_scene *scene, const opal_image_desc *desc) {
  return guarded([&] {
    require(scene && desc && desc->pixels, "No pixels");
    require(desc->width > 0 && desc->height > 0, "An image needs a width and a height above 0");
    require(desc->channels == 1 || desc->channels == 3 || desc->channels == 4, "An image has 1, 3 or 4 channels");
    require(desc->pixel_type == OPAL_PIXEL_U8 || desc->pixel_type == OPAL_PIXEL_F32, "Unknown pixel type");
    Image image;
    image.width = desc->width, image.height = desc->height, image.channels = desc->channels;
    image.pixel_type = desc->pixel_type, image.transfer = desc->transfer;
    const size_t n = size_t(desc->width) * size_t(desc->height) * size_t(desc->channels);
    if (desc->pixel_type == OPAL_PIXEL_U8) image.bytes = copy(static_cast<const uint8_t *>(desc->pixels), n);
    else image.floats = copy(static_cast<const float *>(desc->pixels), n);
    scene->images.push_back(std::move(image));
    return int32_t(scene->images.size() - 1);
  });
}

int32_t opal_scene_add_spectrum(opal_scene *scene, const float *values) {
  return guarded([&] {
    require(scene && values && all_finite(values, kTableSize), "A spectrum needs 471 finite values");
    SpectralTable table;
    std::copy(values, values + kTableSize, table.begin());
    scene->spectra.push_back(table);
    return int32_t(scene->spectra.size() - 1);
  });
}

int32_t opal_scene_set_spectrum(opal_scene *scene, int32_t spectrum, const float *values) {
  return guarded([&] {
    require(scene && spectrum >= 0 && size_t(spectrum) < scene->spectra.size(), "No such spectrum");
    require(values && all_finite(values, kTableSize), "A spectrum needs 471 finite values");
    std::copy(values, values + kTableSize, scene->spectra[size_t(spectrum)].begin());
    scene->lights_dirty = true;
    return 0;
  });
}

int32_t opal_scene_add_material(opal_scene *scene, const opal_material_desc *desc) {
  return guarded([&] {
    require(scene && desc, "No material");
    scene->materials.push_back(material_from(*scene, *desc));
    scene->lights_dirty = true;
    return int32_t(scene->materials.size() - 1);
  });
}

int32_t opal_scene_update_material(opal_scene *scene, int32_t index, const opal_material_desc *desc) {
  return guarded([&] {
    require(scene && desc && index >= 0 && size_t(index) < scene->materials.size(), "No such material");
    scene->materials[size_t(index)] = material_from(*scene, *desc);
    scene->lights_dirty = true;
    return index;
  });
}

int32_t opal_scene_add_light(opal_scene *scene, const opal_light_desc *desc) {
  return guarded([&] {
    require(scene && desc && desc->type >= OPAL_LIGHT_POINT && desc->type <= OPAL_LIGHT_ELLIPSE, "Unknown type of light");
    require(all_finite(desc->transform, 12) && all_finite(desc->color, 3) && std::isfinite(desc->power),
            "A light has a value that is not finite");
    require(desc->spectrum < int32_t(scene->spectra.size()), "A light names a spectrum that does not exist");
    Lamp lamp;
    lamp.desc = *desc;
    lamp.to_world = transform_from(desc->transform);
    lamp.to_local = inverse(lamp.to_world);
    lamp.position = lamp.to_world.origin();
    lamp.axis = safe_normalize(-lamp.to_world.axis(2), {0, 0, -1});
    scene->lamps.push_back(lamp);
    scene->lights_dirty = true;
    return int32_t(scene->lamps.size() - 1);
  });
}

int32_t opal_scene_clear_lights(opal_scene *scene) {
  return guarded([&] {
    require(scene, "No scene");
    scene->lamps.clear();
    scene->lights_dirty = true;
    return 0;
  });
}

int32_t opal_scene_set_world(opal_scene *scene, const opal_world_desc *desc) {
  return guarded([&] {
    require(scene, "No scene");
    scene->lights_dirty = scene->world_dirty = true;
    if (!desc) {
      scene->world = World();
      return 0;
    }
    World world;
    const char *error = nullptr;
    if (!program_from_desc(desc->program, int(scene->images.size()), world.program, &error))
      throw BadArgument(error ? error : "The world's program is not valid");
    world.present = true;
    world.visibility = desc->visibility;
    world.map_width = std::clamp(desc->map_width, 0, 4096);
    world.caustics = desc->caustics != 0;
    scene->world = std::move(world);
    scene->lights_dirty = true;
    return 0;
  });
}

int32_t opal_scene_set_camera(opal_scene *scene, const opal_camera_desc *desc) {
  return guarded([&] {
    require(scene && desc && all_finite(desc->transform, 12) && all_finite(desc->transform_start, 12) &&
                all_finite(desc->transform_end, 12) && all_finite(desc->window, 4),
            "The camera has a value that is not finite");
    require(desc->window[1] > desc->window[0] && desc->window[3] > desc->window[2], "The camera's window is empty");
    scene->camera = *desc;
    scene->has_camera = true;
    return 0;
  });
}

int32_t opal_scene_commit(opal_scene *scene) {
  return guarded([&] {
    require(scene, "No scene");
    scene->commit();
    return 0;
  });
}

void opal_scene_cancel(opal_scene *scene) {
  if (scene) scene->cancel_commit();
}

int32_t opal_scene_get_statistics(const opal_scene *scene, opal_scene_statistics *out) {
  return guarded([&] {
    require(scene && out, "No scene");
    *out = {};
    for (const Instance &instance : scene->instances) out->triangles += scene->meshes[instance.mesh]->n_triangles();
    out->instances = int64_t(scene->instances.size());
    out->lights = int64_t(scene->lamps.size());
    out->emissive_triangles = int64_t(scene->emissive.size());
    out->memory_bytes = scene->memory_bytes();
    out->build_seconds = scene->build_seconds;
    out->mesh_builds = scene->mesh_builds;
    out->top_builds = scene->top_builds;
    out->light_builds = scene->light_builds;
    return 0;
  });
}

int32_t opal_scene_intersect(const opal_scene *scene, int64_t n, const float *origins, const float *directions, float *distance,
                             int32_t *instance, int32_t *triangle, float *barycentrics) {
  return guarded([&] {
    require(scene && n >= 0 && origins && directions, "No rays");
    require(scene->top, "The scene was not committed");
    constexpr int64_t kChunk = 4096;
    const std::atomic<bool> never{false};
    parallel_for((n + kChunk - 1) / kChunk, resolve_threads(scene->threads), never, [&](int64_t chunk) {
      for (int64_t i = chunk * kChunk; i < std::min(n, (chunk + 1) * kChunk); ++i) {
        const float *o = origins + 3 * i, *d = directions + 3 * i;
        const Hit hit = scene->intersect({{o[0], o[1], o[2]}, {d[0], d[1], d[2]}}, OPAL_RAY_ALL);
        if (distance) distance[i] = hit.t;
        if (instance) instance[i] = hit.valid() ? int32_t(hit.instance) : -1;
        if (triangle) triangle[i] = hit.valid() ? int32_t(hit.triangle) : -1;
        if (barycentrics) barycentrics[2 * i] = hit.u, barycentrics[2 * i + 1] = hit.v;
      }
    });
    return 0;
  });
}

}  // extern "C"
