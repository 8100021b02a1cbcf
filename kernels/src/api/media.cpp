// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface: phase functions, media and their grids.
#include "api/guarded.h"
#include "core/sampler.h"
#include <cstdio>

namespace {

using namespace opal;

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
  require(desc.also >= 0 && size_t(desc.also) <= scene.media.size(), "The medium goes with one that does not exist");
  m.also = desc.also - 1;
  return m;
}

}  // namespace

extern "C" {

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

}  // extern "C"
