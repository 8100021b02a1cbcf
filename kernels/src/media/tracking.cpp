// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/tracking.h"

#include "media/stratified.h"
#include "scene/interior.h"

namespace opal {
namespace {

const PhaseFunction &isotropic() {
  static const PhaseFunction kIsotropic = PhaseFunction::isotropic();
  return kIsotropic;
}

}  // namespace

RayMedia::RayMedia(const Scene &scene, const MediumSet &set, const Wavelengths &w, const Ray &ray) : w_(w) {
  const auto table = [&](int s) { return s >= 0 ? lookup(scene.spectra[size_t(s)], w) : Spectrum(0.0f); };
  const auto grid = [&](int g) { return g >= 0 ? scene.grids[size_t(g)].get() : nullptr; };
  // Where a homogeneous glow overlaps what varies it is looked for a few times across the scene.
  const float size = scene.bounds.empty() ? 1.0f : std::max(scene.bounds.radius(), 1e-6f);
  for (int i = 0; i < set.count(); ++i) {
    const Medium &medium = scene.media[size_t(set[i].medium)];
    Layer &layer = layers_.add();
    layer.medium = &medium;
    layer.phase = medium.phase >= 0 ? &scene.phases[size_t(medium.phase)] : &isotropic();
    layer.density = grid(medium.density.grid), layer.emission = grid(medium.emission_density.grid);
    layer.scattering_colors = grid(medium.scattering_grid), layer.absorption_colors = grid(medium.absorption_grid);
    layer.emission_colors = grid(medium.emission_grid);
    layer.origin = ray.origin, layer.direction = ray.direction;
    if (set[i].instance < scene.instances.size()) {
      const Transform &to_object = scene.instances[set[i].instance].to_object;
      layer.origin = to_object.point(ray.origin), layer.direction = to_object.vector(ray.direction);
    } else {
      layer.floor = scene.world_floor;
    }
    layer.sigma_t = table(medium.extinction), layer.sigma_s = table(medium.scattering), layer.glow = table(medium.emission);
    if (!layer.sigma_t.is_zero()) add_part(layer, medium.density, layer.density, layer.sigma_t, false, 0);
    if (!layer.glow.is_zero())
      add_part(layer, medium.emission_density, layer.emission, Spectrum(0.0f), true,
               medium.emission_density.kind == DensityKind::Noise ? 2 / medium.emission_density.noise_scale : 4 / size);
    DensityField colors;
    colors.kind = DensityKind::Grid;
    if (layer.scattering_colors) add_part(layer, colors, layer.scattering_colors, Spectrum(1.0f), false, 0);
    if (layer.absorption_colors) add_part(layer, colors, layer.absorption_colors, Spectrum(1.0f), false, 0);
    if (layer.emission_colors) add_part(layer, colors, layer.emission_colors, Spectrum(0.0f), true, 0);
  }
}

void RayMedia::add_part(const Layer &layer, const DensityField &field, const Grid *grid, const Spectrum &coefficient,
                        bool emissive, float homogeneous_rate) {
  Part &part = parts_.add();
  part.steps = MajorantSteps(field, grid, layer.origin, layer.direction);
  part.coefficient = coefficient;
  part.mean_coefficient = coefficient.average();
  part.emissive = emissive;
  if (emissive) part.collisions = field.kind == DensityKind::Grid ? 2 / part.steps.stride() : homogeneous_rate;
}

MediumHere RayMedia::at(float t) const {
  MediumHere here;
  for (const Layer &layer : layers_) {
    const Medium &medium = *layer.medium;
    const Vec3 p = layer.origin + layer.direction * t;
    const float density = medium.density.at(p, layer.density);
    here.any_layer = medium.layer;
    Spectrum scattering = p.z < layer.floor ? Spectrum(0.0f) : layer.sigma_s * density;
    here.extinction += layer.sigma_t * density;
    if (!layer.glow.is_zero()) here.emission += layer.glow * medium.emission_density.at(p, layer.emission);
    const auto colors = [&](const Grid *grid) { return uplift(grid->color(grid->to_lattice().point(p)), w_); };
    if (layer.scattering_colors) {
      const Spectrum more = colors(layer.scattering_colors);
      scattering += more, here.extinction += more;
    }
    if (layer.absorption_colors) here.extinction += colors(layer.absorption_colors);
    if (layer.emission_colors) here.emission += colors(layer.emission_colors) * w_.d65;
    if (scattering.is_zero()) continue;
    here.scattering += scattering;
    here.parts.add(layer.phase, scattering, medium.layer);
  }
  return here;
}

bool RayMedia::next(float t_end, Interval &out) {
  out.begin = position_;
  if (!(position_ < t_end)) return false;
  for (;;) {
    float end = kInfinity;
    out.majorant = Spectrum(0.0f), out.mean = 0, out.emissive = false;
    for (Part &part : parts_) {
      while (!(part.steps.end() > position_)) part.steps.advance();
      end = std::min(end, part.steps.end());
      if (!(part.steps.majorant() > 0)) continue;
      out.majorant += part.coefficient * part.steps.majorant();
      out.mean += part.mean_coefficient * part.steps.mean();
      if (part.emissive) out.majorant += Spectrum(part.collisions), out.emissive = true;
    }
    out.begin = position_;
    out.end = std::min(end, t_end);
    if (out.majorant.is_zero()) {  // empty: on to what comes next
      position_ = out.end;
      if (!(position_ < t_end)) return false;
      continue;
    }
    // Rounding must not let a place exceed its majorant.
    out.majorant *= 1 + 1e-5f;
    position_ = out.end;
    return true;
  }
}

void pass_through(RayMedia &media, float t_end, RandomStream &random, Walk &walk, float &depth) {
  RayMedia::Interval interval;
  while (media.next(t_end, interval)) {
    const float sigma = interval.majorant[0];
    depth += std::isfinite(interval.end) ? interval.mean * (interval.end - interval.begin) : 0.0f;
    for (float from = interval.begin;;) {
      const float d = sigma > 0 ? -std::log1p(-random.next()) / sigma : kInfinity;
      const float t = from + d;
      if (!(t < interval.end)) {
        if (!std::isfinite(interval.end)) {  // as in fly(): the hero alone is not held up
          for (int i = 0; i < kWavelengths; ++i)
            if (interval.majorant[i] > sigma) walk.throughput[i] = walk.path_pdf[i] = walk.light_pdf[i] = 0;
          break;
        }
        const Spectrum rest = relative_transmittance(interval.majorant, interval.end - from);
        walk.throughput *= rest, walk.path_pdf *= rest, walk.light_pdf *= rest;
        break;
      }
      const Spectrum through = relative_transmittance(interval.majorant, d);
      const Spectrum extinction = media.at(t).extinction;
      Spectrum null;
      for (int i = 0; i < kWavelengths; ++i) null[i] = std::max(0.0f, interval.majorant[i] - extinction[i]);
      walk.throughput *= through * null / sigma;
      walk.path_pdf *= through * null / sigma;
      walk.light_pdf *= through * interval.majorant / sigma;
      from = t;
      // Roulette: a dim rest is followed half of the time.
      const float left = walk.throughput.max();
      if (left == 0) return;
      if (left < 0.05f * walk.light_pdf.average()) {
        if (random.next() < 0.5f) {
          walk.throughput = Spectrum(0.0f);
          return;
        }
        walk.throughput *= 2;
      }
    }
  }
}

Spectrum estimate_transmittance(const Scene &scene, const MediumSet &set, const Wavelengths &w, const Ray &ray, float t_end,
                                RandomStream &random) {
  if (StratifiedMedia::holds(scene, set)) return StratifiedMedia(scene, set, w, ray).transmittance(t_end);
  RayMedia media(scene, set, w, ray);
  Walk walk;
  float depth = 0;
  pass_through(media, t_end, random, walk, depth);
  return walk.throughput;
}

}  // namespace opal
