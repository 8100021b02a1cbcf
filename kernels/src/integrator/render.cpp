// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/render.h"

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "film/spectral_film.h"
#include "integrator/path_tracer.h"
#include "integrator/path_class.h"
#include "lights/light_tables.h"
#include "photons/kernel_radius.h"

namespace opal {
namespace {

constexpr int kTile = 16;
constexpr uint32_t kPhotonChunk = 4096;

// What all chunks have left of one kind, in their order; it leaves them.
template <class T>
Chunks<T> taken(std::vector<PhotonChunk> &chunks, std::vector<T> PhotonChunk::*part) {
  Chunks<T> all;
  all.reserve(chunks.size());
  for (PhotonChunk &chunk : chunks) all.push_back(std::move(chunk.*part));
  return all;
}

void put(float *out, const Vec3 &v) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

}  // namespace

Render::Render(const Scene &scene, const opal_render_settings &settings)
    : scene_(scene),
      settings_(settings),
      filter_(settings.filter, settings.filter_width),
      threads_(resolve_threads(settings.threads > 0 ? settings.threads : scene.threads)) {
  if (settings_.photons_per_pass <= 0) settings_.photons_carry = OPAL_CARRY_NONE;  // all light is left to camera paths
  film_.allocate(width(), height(), settings.passes, settings.spectral_bins);
  statistics_.build_seconds = scene.build_seconds;
}

bool Render::wants_photons() const {
  if (settings_.photons_per_pass <= 0 || settings_.photons_carry == OPAL_CARRY_NONE) return false;
  return settings_.photons_carry != OPAL_CARRY_CAUSTICS || !scene_.casters.empty();
}

bool Render::run_task(const PassContext &pass, const PhotonTask &task, float from, float to, std::vector<PhotonChunk> &chunks) {
  const size_t before = chunks.size();
  const int64_t n_chunks = (int64_t(task.count) + kPhotonChunk - 1) / kPhotonChunk;
  chunks.resize(before + size_t(n_chunks));
  std::atomic<int64_t> done{0};
  const bool complete = parallel_for(n_chunks, threads_, cancelled_, [&](int64_t i) {
    const uint32_t first = uint32_t(i) * kPhotonChunk;
    for (uint32_t k = first; k < std::min(task.count, first + kPhotonChunk); k += 256) {  // short, so that cancelling is prompt
      if (cancelled_.load(std::memory_order_relaxed)) return;
      trace_photons(pass, task, k, std::min({task.count, first + kPhotonChunk, k + 256}), chunks[before + size_t(i)]);
    }
    progress_ = lerp(from, to, float(++done) / float(n_chunks));
  });
  return complete && !cancelled_;
}

bool Render::trace_photons_of(PassContext &pass, PassBuffer &buffer, SplatSums &splats) {
  const Stopwatch start;
  const uint32_t n = uint32_t(settings_.photons_per_pass);
  const uint32_t apart = scene_.any_medium ? uint32_t(settings_.volume_photons) : 0;
  std::vector<PhotonChunk> chunks;
  if (!run_task(pass, {n, kStreamPhotons, true, apart == 0}, 0, apart ? 0.15f : 0.3f, chunks)) return false;
  if (apart && !run_task(pass, {apart, kStreamVolumePhotons, false, true}, 0.15f, 0.3f, chunks)) return false;

  splats.direct.resize(size_t(width()) * size_t(height()));
  splats.indirect = splats.caustics = splats.direct;
  for (PhotonChunk &chunk : chunks) {  // in order: the sums do not depend on who traced what
    for (const Splat &splat : chunk.splats)
      (splat.pass == OPAL_PASS_CAUSTICS ? splats.caustics
       : splat.pass == OPAL_PASS_DIRECT ? splats.direct
                                        : splats.indirect)[splat.pixel] += splat.rgb;
    for (const auto &[slot, value] : chunk.spectral)
      if (buffer.has(OPAL_PASS_SPECTRAL)) buffer.values[OPAL_PASS_SPECTRAL][slot] += value;
    statistics_.path_rays += chunk.rays;
    statistics_.gems_passed_over += chunk.passed_over;
    statistics_.media_passed_over += chunk.media_passed_over;
    statistics_.splats += int64_t(chunk.splats.size());
    statistics_.energy_emitted += chunk.energy.emitted;
    statistics_.energy_stored += chunk.energy.stored;
    statistics_.energy_absorbed += chunk.energy.absorbed;
    statistics_.energy_escaped += chunk.energy.escaped;
    chunk.splats = {}, chunk.spectral = {};
  }
  const Stopwatch traced;
  statistics_.photons_emitted += n;
  statistics_.volume_photons_emitted += scene_.any_medium ? (apart ? apart : n) : 0;
  build_maps(pass, chunks);
  statistics_.photons_stored += int64_t(pass.photons.size());
  statistics_.photon_bytes = int64_t(pass.photons.size() * sizeof(Photon)) + pass.volume.memory_bytes();
  statistics_.search_seconds += traced.seconds();
  statistics_.photon_seconds += start.seconds();
  return true;
}

// The photons of a pass, ready to be looked up: on surfaces, and in media points or beams, whichever the estimate takes.
void Render::build_maps(PassContext &pass, std::vector<PhotonChunk> &chunks) {
  const opal_render_settings &settings = pass.settings;
  pass.photons.build(taken(chunks, &PhotonChunk::photons), surface_radius(scene_, settings, pass.pass), threads_);
  const auto of_media = [&](auto part) {
    auto all = taken(chunks, part);
    statistics_.volume_photons_stored += int64_t(starts_of(all).back());
    return all;
  };
  const float radius = settings.volume_radius > 0 ? settings.volume_radius : settings.radius;
  switch (settings.volume_estimate) {
    case OPAL_VOLUME_BEAMS: {
      const float first = radius > 0 ? radius : pixel_footprint(scene_, settings);
      const float shrunk = radius_factor(1, settings.radius_shrink, pass.pass);
      pass.volume.build(of_media(&PhotonChunk::beams), first * shrunk, threads_);
      break;
    }
    case OPAL_VOLUME_BEAM_RADIANCE: {
      // The ray passes many discs where a sphere holds the photons asked for: an eighth of them sets the radius.
      const float shrunk = radius_factor(2, settings.radius_shrink, pass.pass);
      pass.volume.build(of_media(&PhotonChunk::volume), radius * shrunk, shrunk, std::max(1, settings.gather / 8), threads_);
      break;
    }
    default: {
      const float shrunk = radius_factor(3, settings.radius_shrink, pass.pass);
      pass.volume.build(of_media(&PhotonChunk::volume), radius * shrunk, shrunk, settings.gather, threads_);
    }
  }
}

bool Render::trace_camera_of(const PassContext &pass, PassBuffer &buffer, const SplatSums &splats) {
  const Stopwatch start;
  const int w = width(), h = height();
  const int tiles_x = (w + kTile - 1) / kTile, tiles_y = (h + kTile - 1) / kTile;
  const float filter = scene_.camera.polarizer ? 0.5f : 1.0f;  // a polarising filter takes half of unpolarised light
  const float exposure = settings_.exposure * filter;
  const float from = progress_;
  std::atomic<int64_t> done{0}, camera{0}, path{0}, shadow{0}, passed_over{0}, media_passed_over{0};

  const auto render_pixel = [&](int x, int y, RayCounts &counts) {
    const size_t pixel = size_t(y) * size_t(w) + size_t(x);
    Vec3 emission, direct, indirect, caustics, medium, normal, position, albedo;
    LayerLight layers;
    float alpha = 0, depth = 0;
    int hits = 0;
    const int samples = plan_.empty() ? settings_.samples_per_pass
                                      : plan_.samples(x + settings_.region[0], y + settings_.region[1], settings_.seed);
    const float scale = 1 / float(samples);
    for (int s = 0; s < samples; ++s) {
      const uint32_t film_x = uint32_t(x + settings_.region[0]), film_y = uint32_t(y + settings_.region[1]);
      const uint32_t sample = uint32_t(pass.pass) * uint32_t(samples) + uint32_t(s);
      PathLight light = trace_camera_path(pass, film_x, film_y, sample, counts);
      if (light.veiled && keeps_clear(settings_)) {
        const LayerLight clear = trace_clear_path(pass, film_x, film_y, sample, counts);
        light.layers.take(Layer::Behind, clear);
        light.layers.take(Layer::Dimmed, clear);
      }
      emission += light.emission, direct += light.direct, indirect += light.indirect, caustics += light.caustics;
      medium += light.medium;
      layers += light.layers;
      alpha += light.alpha;
      if (light.hit) normal += light.normal, position += light.position, albedo += light.albedo, ++hits;
      if (s == 0) depth = light.hit ? light.depth : 1e10f;
      if (buffer.has(OPAL_PASS_SPECTRAL))
        for (int k = 0; k < kWavelengths; ++k) {
          if (light.spectral[k] == 0) continue;
          const SpectralBin bin = spectral_bin(settings_, pass.wavelengths[light.wavelength_index], k, light.spectral[k]);
          buffer.at(OPAL_PASS_SPECTRAL, pixel)[bin.index] += bin.value * scale * exposure;
        }
    }
    const float light_scale = scale * exposure;
    emission *= light_scale, direct *= light_scale, indirect *= light_scale, caustics *= light_scale, medium *= light_scale;
    if (!splats.caustics.empty()) {
      direct += splats.direct[pixel] * exposure;
      indirect += splats.indirect[pixel] * exposure;
      caustics += splats.caustics[pixel] * exposure;
    }
    float *combined = buffer.at(OPAL_PASS_COMBINED, pixel);
    put(combined, emission + direct + indirect + caustics + medium);
    combined[3] = alpha * scale;
    if (buffer.has(OPAL_PASS_EMISSION)) put(buffer.at(OPAL_PASS_EMISSION, pixel), emission);
    if (buffer.has(OPAL_PASS_DIRECT)) put(buffer.at(OPAL_PASS_DIRECT, pixel), direct);
    if (buffer.has(OPAL_PASS_INDIRECT)) put(buffer.at(OPAL_PASS_INDIRECT, pixel), indirect);
    if (buffer.has(OPAL_PASS_CAUSTICS)) put(buffer.at(OPAL_PASS_CAUSTICS, pixel), caustics);
    if (buffer.has(OPAL_PASS_MEDIUM)) put(buffer.at(OPAL_PASS_MEDIUM, pixel), medium);
    if (keeps_layers(settings_))
      for (int i = 0; i < kLayers; ++i) {
        const int p = OPAL_PASS_LAYER_BASE + i;
        if (!buffer.has(p)) continue;
        Vec3 rgb = layers.rgb[size_t(i)] * light_scale;
        if (p == OPAL_PASS_LAYER_CAUSTICS && !splats.caustics.empty())
          rgb += (splats.direct[pixel] + splats.indirect[pixel] + splats.caustics[pixel]) * exposure;
        put(buffer.at(p, pixel), rgb);
        buffer.at(p, pixel)[3] = layers.alpha[size_t(i)] * scale;
      }
    if (buffer.has(OPAL_PASS_DEPTH)) *buffer.at(OPAL_PASS_DEPTH, pixel) = depth;
    if (buffer.has(OPAL_PASS_NORMAL)) put(buffer.at(OPAL_PASS_NORMAL, pixel), normal * scale);
    if (buffer.has(OPAL_PASS_POSITION)) put(buffer.at(OPAL_PASS_POSITION, pixel), hits ? position / float(hits) : Vec3{});
    if (buffer.has(OPAL_PASS_ALBEDO)) put(buffer.at(OPAL_PASS_ALBEDO, pixel), albedo * scale);
  };

  const bool complete = parallel_for(int64_t(tiles_x) * tiles_y, threads_, cancelled_, [&](int64_t tile) {
    RayCounts counts;
    const int x0 = int(tile % tiles_x) * kTile, y0 = int(tile / tiles_x) * kTile;
    for (int y = y0; y < std::min(h, y0 + kTile); ++y) {
      if (cancelled_.load(std::memory_order_relaxed)) return;
      for (int x = x0; x < std::min(w, x0 + kTile); ++x) render_pixel(x, y, counts);
    }
    camera += counts.camera, path += counts.path, shadow += counts.shadow, passed_over += counts.passed_over;
    media_passed_over += counts.media_passed_over;
    progress_ = from + (1 - from) * float(++done) / float(int64_t(tiles_x) * tiles_y);
  });
  if (!complete || cancelled_) return false;
  statistics_.camera_rays += camera;
  statistics_.path_rays += path;
  statistics_.shadow_rays += shadow;
  statistics_.gems_passed_over += passed_over;
  statistics_.media_passed_over += media_passed_over;
  statistics_.camera_seconds += start.seconds();
  return true;
}

bool Render::render_pass(int number) {
  progress_ = 0;
  PassBuffer buffer;
  buffer.allocate(width(), height(), settings_.passes, settings_.spectral_bins);
  SplatSums splats;
  if (wants_photons() && !guide_ && settings_.photons_carry == OPAL_CARRY_CAUSTICS && !learn_emission()) return false;
  if (settings_.adaptive && plan_.empty() && !plan_work()) return false;
  PassContext pass(scene_, settings_, filter_, number);
  if (wants_photons()) {
    pass.guide = guide_.get();
    if (!trace_photons_of(pass, buffer, splats)) return false;
  }
  if (!trace_camera_of(pass, buffer, splats)) return false;
  const std::lock_guard lock(film_mutex_);
  film_.add(buffer, number);
  progress_ = 1;
  return true;
}

bool Render::read(int pass, float *out) const {
  const std::lock_guard lock(film_mutex_);
  return film_.read(pass, out);
}

bool Render::read_sums(int pass, double *out) const {
  const std::lock_guard lock(film_mutex_);
  return film_.read_sums(pass, out);
}

int Render::depth_pass() const {
  const std::lock_guard lock(film_mutex_);
  return film_.depth_pass();
}

float Render::noise() const {
  const std::lock_guard lock(film_mutex_);
  return film_.noise();
}

opal_render_statistics Render::statistics() const {
  const std::lock_guard lock(film_mutex_);
  opal_render_statistics s = statistics_;
  s.memory_bytes = scene_.memory_bytes() + film_.memory_bytes();
  return s;
}

}  // namespace opal
