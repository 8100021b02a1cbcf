// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/render.h"

#include "core/parallel.h"
#include "film/spectral_film.h"
#include "integrator/path_tracer.h"
#include "photons/photon_tracer.h"
#include "integrator/path_class.h"

#include <chrono>

namespace opal {
namespace {

constexpr int kTile = 16;
constexpr uint32_t kPhotonChunk = 4096;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void put(float *out, const Vec3 &v) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

}  // namespace

Render::Render(const Scene &scene, const opal_render_settings &settings)
    : scene_(scene),
      settings_(settings),
      filter_(settings.filter, settings.filter_width),
      threads_(resolve_threads(settings.threads > 0 ? settings.threads : scene.threads)) {
  film_.allocate(width(), height(), settings.passes, settings.spectral_bins);
  statistics_.build_seconds = scene.build_seconds;
}

bool Render::wants_photons() const {
  if (settings_.photons_per_pass <= 0 || settings_.photons_carry == OPAL_CARRY_NONE) return false;
  return settings_.photons_carry != OPAL_CARRY_CAUSTICS || !scene_.casters.empty();
}

float Render::radius_of(int pass) const {
  double radius = settings_.radius;
  if (!(radius > 0)) {
    // Four pixels' footprint where the nearest caster stands.
    const opal_camera_desc &camera = scene_.camera;
    const float pixel = (camera.window[1] - camera.window[0]) / float(settings_.width);
    float distance = 1;
    if (camera.type == OPAL_CAMERA_PERSPECTIVE) {
      const Vec3 eye = camera_transform(camera, 0).origin();
      distance = kInfinity;
      for (const EmissionTarget &target : scene_.casters)
        distance = std::min(distance, std::max(length(target.centre - eye), target.radius));
      if (!std::isfinite(distance)) distance = std::max(length(scene_.bounds.centre() - eye), scene_.bounds.radius());
    }
    radius = 4.0 * double(pixel) * double(distance);
  }
  // Knaus & Zwicker 2011, equation 20: the disc shrinks by (i + alpha) / (i + 1) from pass i to the next.
  const double alpha = clamp(settings_.radius_shrink, 0.01f, 1.0f);
  double area = radius * radius;
  for (int i = 1; i <= pass; ++i) area *= (i + alpha) / (i + 1.0);
  return float(std::sqrt(area));
}

bool Render::trace_photons_of(PassContext &pass, PassBuffer &buffer, SplatSums &splats) {
  const auto start = std::chrono::steady_clock::now();
  const uint32_t n = uint32_t(settings_.photons_per_pass);
  const int64_t n_chunks = (int64_t(n) + kPhotonChunk - 1) / kPhotonChunk;
  std::vector<PhotonChunk> chunks{size_t(n_chunks)};
  std::atomic<int64_t> done{0};
  const bool complete = parallel_for(n_chunks, threads_, cancelled_, [&](int64_t i) {
    const uint32_t first = uint32_t(i) * kPhotonChunk;
    for (uint32_t k = first; k < std::min(n, first + kPhotonChunk); k += 256) {  // short steps, so that cancelling is prompt
      if (cancelled_.load(std::memory_order_relaxed)) return;
      trace_photons(pass, k, std::min({n, first + kPhotonChunk, k + 256}), chunks[size_t(i)]);
    }
    progress_ = 0.3f * float(++done) / float(n_chunks);
  });
  if (!complete || cancelled_) return false;

  size_t total = 0;
  for (const PhotonChunk &chunk : chunks) total += chunk.photons.size();
  std::vector<Photon> photons;
  photons.reserve(total);
  int64_t rays = 0;
  splats.direct.resize(size_t(width()) * size_t(height()));
  splats.indirect = splats.caustics = splats.direct;
  for (PhotonChunk &chunk : chunks) {  // in order: the sums do not depend on who traced what
    photons.insert(photons.end(), chunk.photons.begin(), chunk.photons.end());
    for (const Splat &splat : chunk.splats)
      (splat.pass == OPAL_PASS_CAUSTICS ? splats.caustics
       : splat.pass == OPAL_PASS_DIRECT ? splats.direct
                                        : splats.indirect)[splat.pixel] += splat.rgb;
    for (const auto &[slot, value] : chunk.spectral)
      if (buffer.has(OPAL_PASS_SPECTRAL)) buffer.values[OPAL_PASS_SPECTRAL][slot] += value;
    rays += chunk.rays;
    statistics_.splats += int64_t(chunk.splats.size());
    chunk = {};
  }
  statistics_.photons_emitted += n;
  statistics_.photons_stored += int64_t(total);
  statistics_.path_rays += rays;
  pass.photons.build(std::move(photons), radius_of(pass.pass), threads_);
  statistics_.photon_seconds += seconds_since(start);
  return true;
}

bool Render::trace_camera_of(const PassContext &pass, PassBuffer &buffer, const SplatSums &splats) {
  const auto start = std::chrono::steady_clock::now();
  const int w = width(), h = height();
  const int tiles_x = (w + kTile - 1) / kTile, tiles_y = (h + kTile - 1) / kTile;
  const int samples = settings_.samples_per_pass;
  const float filter = scene_.camera.polarizer ? 0.5f : 1.0f;  // a polarising filter takes half of unpolarised light
  const float scale = 1 / float(samples), exposure = settings_.exposure * filter;
  const float from = progress_;
  std::atomic<int64_t> done{0}, camera{0}, path{0}, shadow{0};

  const auto render_pixel = [&](int x, int y, RayCounts &counts) {
    const size_t pixel = size_t(y) * size_t(w) + size_t(x);
    Vec3 emission, direct, indirect, caustics, medium, normal, position, albedo;
    LayerLight layers;
    float alpha = 0, depth = 0;
    int hits = 0;
    for (int s = 0; s < samples; ++s) {
      const PathLight light =
          trace_camera_path(pass, uint32_t(x + settings_.region[0]), uint32_t(y + settings_.region[1]), uint32_t(s), counts);
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
    camera += counts.camera, path += counts.path, shadow += counts.shadow;
    progress_ = from + (1 - from) * float(++done) / float(int64_t(tiles_x) * tiles_y);
  });
  if (!complete || cancelled_) return false;
  statistics_.camera_rays += camera;
  statistics_.path_rays += path;
  statistics_.shadow_rays += shadow;
  statistics_.camera_seconds += seconds_since(start);
  return true;
}

bool Render::render_pass(int number) {
  progress_ = 0;
  PassBuffer buffer;
  buffer.allocate(width(), height(), settings_.passes, settings_.spectral_bins);
  SplatSums splats;
  PassContext pass(scene_, settings_, filter_, number);
  if (wants_photons() && !trace_photons_of(pass, buffer, splats)) return false;
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
