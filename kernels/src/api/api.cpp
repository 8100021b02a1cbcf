// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface: arguments are checked here, exceptions end here.
#include "integrator/render.h"
#include "core/parallel.h"
#include "opal.h"
#include "scene/scene.h"

#include <cstdio>
#include <cstring>
#include <new>
#include <string>

struct opal_scene : opal::Scene {};
struct opal_render : opal::Render {
  using opal::Render::Render;
};

namespace {

using namespace opal;

thread_local std::string last_error;

int32_t fail(opal_status status, std::string message) {
  last_error = std::move(message);
  return status;
}

struct BadArgument : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct OutOfMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};
void require(bool condition, const char *message) {
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

Transform transform_from(const float *m) {
  Transform t;
  std::copy(m, m + 12, t.m);
  return t;
}
bool all_finite(const float *values, size_t n) {
  for (size_t i = 0; i < n; ++i)
    if (!std::isfinite(values[i])) return false;
  return true;
}

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

std::string grid_size_sentence(const int32_t size[3], int channels) {
  const double gigabytes = double(size[0]) * size[1] * size[2] * channels * sizeof(float) / 1e9;
  char text[160];
  std::snprintf(text, sizeof text, "A grid of %d x %d x %d voxels (%.1f GB when dense) does not fit into memory", size[0],
                size[1], size[2], gigabytes);
  return text;
}

Medium medium_from(const Scene &scene, const opal_medium_desc &desc) {
  const auto grid = [&](int32_t number, int channels) {
    require(number >= 0 && size_t(number) <= scene.grids.size(), "The medium names a grid that does not exist");
    require(number == 0 || scene.grids[size_t(number - 1)]->channels() == channels,
            channels == 1 ? "A density needs a grid of one channel" : "Colours need a grid of three channels");
    return number - 1;
  };
  require(desc.density >= OPAL_DENSITY_HOMOGENEOUS && desc.density <= OPAL_DENSITY_HEIGHT, "Unknown kind of density");
  require(desc.emission_density >= OPAL_EMISSION_AS_DENSITY && desc.emission_density <= OPAL_EMISSION_GRID,
          "Unknown kind of emission");
  Medium m;
  m.extinction = desc.extinction, m.scattering = desc.scattering, m.emission = desc.emission, m.phase = desc.phase;
  m.density.kind = DensityKind(desc.density);
  m.density.grid = grid(desc.density_grid, 1);
  if (m.density.kind == DensityKind::Noise) {
    require(desc.noise_scale > 0 && std::isfinite(desc.noise_scale) && desc.noise_detail >= 0 && desc.noise_detail <= 15 &&
                desc.noise_contrast >= 0 && std::isfinite(desc.noise_contrast),
            "The noise needs a size above 0, a detail of 0 to 15 and a contrast that is not negative");
    m.density.noise_scale = desc.noise_scale, m.density.noise_detail = desc.noise_detail;
    m.density.noise_contrast = desc.noise_contrast;
    const auto shift = [&](uint32_t axis) { return float(hash32(desc.noise_seed, axis) & 0xffff) / 16.0f - 2048.0f; };
    m.density.noise_offset = {shift(1), shift(2), shift(3)};
  }
  if (m.density.kind == DensityKind::Height) {
    require(desc.scale_height > 0 && std::isfinite(desc.scale_height) && std::isfinite(desc.base_height),
            "The scale height is not above 0");
    m.density.scale_height = desc.scale_height, m.density.base_height = desc.base_height;
  }
  if (desc.emission_density == OPAL_EMISSION_AS_DENSITY) m.emission_density = m.density;
  if (desc.emission_density == OPAL_EMISSION_GRID) {
    m.emission_density.kind = DensityKind::Grid;
    m.emission_density.grid = grid(desc.emission_density_grid, 1);
  }
  m.scattering_grid = grid(desc.scattering_grid, 3), m.absorption_grid = grid(desc.absorption_grid, 3);
  m.emission_grid = grid(desc.emission_grid, 3);
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

void set_transform(Instance &instance, const float *begin, const float *end) {
  instance.to_world = transform_from(begin);
  instance.to_object = inverse(instance.to_world);
  instance.moving = end && std::memcmp(begin, end, 12 * sizeof(float)) != 0;
  instance.to_world_end = instance.moving ? transform_from(end) : instance.to_world;
  instance.mirrored = instance.to_world.determinant() < 0;
}

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

extern "C" {

const char *opal_last_error(void) { return last_error.c_str(); }
int32_t opal_api_version(void) { return OPAL_API_VERSION; }
int32_t opal_cpu_level(void) { return cpu_level(); }

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

int32_t opal_scene_add_phase(opal_scene *scene, const opal_phase_desc *desc) {
  return guarded([&] {
    require(scene && desc, "No phase function");
    switch (desc->kind) {
      case OPAL_PHASE_ISOTROPIC: scene->phases.push_back(PhaseFunction::isotropic()); break;
      case OPAL_PHASE_HENYEY_GREENSTEIN:
        require(desc->anisotropy >= -1 && desc->anisotropy <= 1, "The anisotropy is not between -1 and 1");
        scene->phases.push_back(PhaseFunction::henyey_greenstein(desc->anisotropy));
        break;
      case OPAL_PHASE_RAYLEIGH: scene->phases.push_back(PhaseFunction::rayleigh()); break;
      case OPAL_PHASE_TABLE: {
        require(desc->n_wavelengths >= 1 && desc->n_angles >= 2 && desc->wavelengths && desc->angles && desc->values,
                "A table needs at least one wavelength and two angles");
        const size_t rows = size_t(desc->n_wavelengths), columns = size_t(desc->n_angles);
        require((desc->n_elevations <= 0 || desc->elevations) && (desc->n_clocks <= 0 || desc->clocks),
                "A table for particles that are not round needs its elevations and clocks");
        const size_t elevations = size_t(std::max(desc->n_elevations, 0)), clocks = size_t(std::max(desc->n_clocks, 0));
        const size_t places = std::max<size_t>(elevations, 1) * std::max<size_t>(clocks, 1);
        require(places == 1 || (elevations > 0 && clocks > 0), "A table has both elevations and clocks, or neither");
        require(all_finite(desc->elevations, elevations) && all_finite(desc->clocks, clocks) &&
                    (!desc->polarization || all_finite(desc->polarization, places * rows * columns)) &&
                    all_finite(desc->wavelengths, rows) && all_finite(desc->angles, columns) &&
                    all_finite(desc->values, places * rows * columns),
                "The phase table has a value that is not finite");
        require(
            std::is_sorted(desc->wavelengths, desc->wavelengths + rows) && std::is_sorted(desc->angles, desc->angles + columns),
            "The phase table's wavelengths and angles must ascend");
        scene->phases.push_back(
            PhaseFunction::table({desc->wavelengths, desc->angles, desc->elevations, desc->clocks, desc->n_wavelengths,
                                  desc->n_angles, desc->n_elevations, desc->n_clocks, desc->values, desc->polarization}));
        break;
      }
      default: throw BadArgument("Unknown kind of phase function");
    }
    return int32_t(scene->phases.size() - 1);
  });
}

int32_t opal_scene_add_medium(opal_scene *scene, const opal_medium_desc *desc) {
  return guarded([&] {
    require(scene && desc, "No medium");
    const int32_t n = int32_t(scene->spectra.size());
    require(desc->extinction < n && desc->scattering < n && desc->emission < n,
            "The medium names a spectrum that does not exist");
    require(desc->phase < int32_t(scene->phases.size()), "The medium names a phase function that does not exist");
    for (const int32_t s : {desc->extinction, desc->scattering, desc->emission})
      if (s >= 0)
        for (const float v : scene->spectra[size_t(s)]) require(v >= 0, "A medium's coefficient is negative");
    scene->media.push_back(medium_from(*scene, *desc));
    return int32_t(scene->media.size() - 1);
  });
}

int32_t opal_scene_add_grid(opal_scene *scene, const opal_grid_desc *desc) {
  return guarded([&] {
    require(scene && desc, "No grid");
    for (const int32_t n : desc->size) require(n >= 1 && n <= 16384, "A grid has between 1 and 16384 voxels along each axis");
    require(desc->channels == 1 || desc->channels == 3, "A grid has 1 or 3 channels");
    require(all_finite(desc->transform, 12), "The grid's transform is not finite");
    const Transform transform = transform_from(desc->transform);
    require(transform.determinant() != 0, "The grid is scaled to nothing");
    try {
      scene->grids.push_back(std::make_unique<Grid>(desc->size, desc->channels, transform));
    } catch (const std::bad_alloc &) {
      throw OutOfMemory(grid_size_sentence(desc->size, desc->channels));
    }
    return int32_t(scene->grids.size() - 1);
  });
}

int32_t opal_scene_set_grid_block(opal_scene *scene, int32_t grid, const int32_t origin[3], const int32_t size[3],
                                  const float *values, opal_grid_faults *faults) {
  return guarded([&] {
    require(scene && grid >= 0 && size_t(grid) < scene->grids.size() && origin && size && values, "No such grid or no values");
    Grid &g = *scene->grids[size_t(grid)];
    for (int a = 0; a < 3; ++a)
      require(origin[a] >= 0 && size[a] >= 1 && origin[a] <= g.size(a) - size[a], "The block lies outside of the grid");
    Grid::Bad bad;
    try {
      g.set_block(origin, size, values, bad);
    } catch (const std::bad_alloc &) {
      const int32_t whole[3] = {g.size(0), g.size(1), g.size(2)};
      throw OutOfMemory(grid_size_sentence(whole, g.channels()));
    }
    if (faults) faults->not_finite += bad.not_finite, faults->negative += bad.negative;
    return 0;
  });
}

int32_t opal_scene_set_medium_layer(opal_scene *scene, int32_t medium, int32_t layer) {
  return guarded([&] {
    require(scene && medium >= 0 && medium < int32_t(scene->media.size()), "No such medium");
    require(layer >= OPAL_MEDIUM_LAYER_MEDIA && layer <= OPAL_MEDIUM_LAYER_BASE, "Unknown layer of a medium");
    scene->media[size_t(medium)].layer = uint8_t(layer);
    return 0;
  });
}

int32_t opal_scene_set_world_medium(opal_scene *scene, int32_t medium) {
  return guarded([&] {
    require(scene && medium < int32_t(scene->media.size()), "No such medium");
    scene->world_medium = medium;
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
    set_transform(instance, places->transform ? places->transform : identity.m, nullptr);
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

int32_t opal_scene_add_mesh(opal_scene *scene, const opal_mesh_desc *desc, int32_t *n_dropped) {
  return guarded([&] {
    require(scene && desc && desc->n_vertices >= 0 && desc->n_triangles >= 0, "No mesh");
    require(desc->n_triangles == 0 || (desc->positions && desc->triangles),
            "A mesh with triangles needs positions and corners");
    auto mesh = std::make_unique<Mesh>();
    const size_t nv = size_t(desc->n_vertices), nt = size_t(desc->n_triangles);
    for (size_t i = 0; i < nt * 3; ++i)
      require(desc->triangles[i] >= 0 && desc->triangles[i] < desc->n_vertices,
              "A triangle names a vertex that does not exist");

    std::vector<uint8_t> finite(nv, 1);
    for (size_t i = 0; i < nv; ++i)
      finite[i] =
          all_finite(desc->positions + 3 * i, 3) && (!desc->positions_end || all_finite(desc->positions_end + 3 * i, 3));
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
      if (!mesh->positions_end.empty()) mesh->bounds.extend(mesh->vertex(c, 1));
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
    require(all_finite(desc->transforms, n * 12) && (!desc->transforms_end || all_finite(desc->transforms_end, n * 12)),
            "A transform is not finite");
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
      set_transform(instance, desc->transforms + 12 * i, desc->transforms_end ? desc->transforms_end + 12 * i : nullptr);
      if (desc->object_info) {
        const float *info = desc->object_info + 8 * i;
        instance.random = info[0], instance.object_index = info[1];
        std::copy(info + 2, info + 6, instance.color);
      }
      scene->instances.push_back(instance);
    }
    scene->instances_dirty = true;
    return first;
  });
}

int32_t opal_scene_set_transforms(opal_scene *scene, int32_t first, int32_t count, const float *begin, const float *end) {
  return guarded([&] {
    require(scene && begin && first >= 0 && count >= 0 && size_t(first) + size_t(count) <= scene->instances.size(),
            "No such instances");
    require(all_finite(begin, size_t(count) * 12) && (!end || all_finite(end, size_t(count) * 12)),
            "A transform is not finite");
    for (int32_t i = 0; i < count; ++i)
      set_transform(scene->instances[size_t(first + i)], begin + 12 * i, end ? end + 12 * i : nullptr);
    scene->instances_dirty = true;
    return 0;
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
    require(
        scene && desc && all_finite(desc->transform, 12) && all_finite(desc->transform_end, 12) && all_finite(desc->window, 4),
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

opal_render *opal_render_create(opal_scene *scene, const opal_render_settings *settings) {
  opal_render *render = nullptr;
  const int32_t status = guarded([&] {
    require(scene && settings, "No scene or settings");
    require(scene->top && !scene->geometry_dirty && !scene->instances_dirty && !scene->lights_dirty,
            "The scene was not committed");
    require(scene->has_camera, "The scene has no camera");
    const opal_render_settings &s = *settings;
    require(s.width > 0 && s.height > 0 && int64_t(s.width) * s.height < int64_t(kStreamPhotons),
            "The resolution is out of range");
    require(s.region[0] >= 0 && s.region[1] >= 0 && s.region[2] <= s.width && s.region[3] <= s.height &&
                s.region[0] < s.region[2] && s.region[1] < s.region[3],
            "The region to render is empty or lies outside the frame");
    require(s.samples_per_pass > 0, "A pass needs at least one sample");
    require(s.photons_per_pass >= 0 && s.photons_carry >= 0 && s.photons_carry <= OPAL_CARRY_NONE,
            "The photon settings are out of range");
    require(s.volume_estimate >= OPAL_VOLUME_POINTS && s.volume_estimate <= OPAL_VOLUME_BEAMS && s.volume_photons >= 0 &&
                std::isfinite(s.volume_radius) && s.volume_radius >= 0 && s.march_steps >= 1 && s.march_steps <= 256 &&
                s.march_tolerance >= 0,
            "The settings of photons in media are out of range");
    require(s.wavelength_first >= 360 && s.wavelength_last <= 830 && s.wavelength_last - s.wavelength_first >= 1,
            "The wavelengths must lie between 360 and 830 nm, at least 1 nm apart");
    require(s.spectral_bins >= 0 && s.spectral_bins <= 1000, "Between 0 and 1000 spectral bins are possible");
    if (s.wavelength_first != scene->colour.first_nm || s.wavelength_last != scene->colour.last_nm)
      scene->set_wavelengths(s.wavelength_first, s.wavelength_last);
    render = new opal_render(*scene, s);
    return 0;
  });
  return status == OPAL_OK ? render : nullptr;
}

void opal_render_destroy(opal_render *render) { delete render; }

int32_t opal_render_pass(opal_render *render, int32_t pass) {
  return guarded([&] {
    require(render && pass >= 0, "No such pass");
    if (!render->render_pass(pass)) return fail(OPAL_ERROR_CANCELLED, "Cancelled");
    return 0;
  });
}

void opal_render_cancel(opal_render *render) {
  if (render) render->cancel();
}

float opal_render_progress(const opal_render *render) { return render ? render->progress() : 0.0f; }

int32_t opal_film_read(const opal_render *render, int32_t pass, float *out) {
  return guarded([&] {
    require(render && out, "No render");
    require(render->read(pass, out), "The film does not keep this pass");
    return 0;
  });
}

int32_t opal_film_read_sums(const opal_render *render, int32_t pass, double *out) {
  return guarded([&] {
    require(render && out, "No render");
    require(render->read_sums(pass, out), "The film does not keep this pass");
    return 0;
  });
}

int32_t opal_film_depth_pass(const opal_render *render) { return render ? render->depth_pass() : -1; }

float opal_film_noise(const opal_render *render) { return render ? render->noise() : -1.0f; }

int32_t opal_render_get_statistics(const opal_render *render, opal_render_statistics *out) {
  return guarded([&] {
    require(render && out, "No render");
    *out = render->statistics();
    return 0;
  });
}

}  // extern "C"
