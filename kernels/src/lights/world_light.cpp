// SPDX-License-Identifier: GPL-3.0-or-later
// See world_light.h.
#include "lights/world_light.h"

#include "core/parallel.h"
#include "lights/directions.h"
#include "scene/scene.h"

namespace opal {
namespace {

// What part of the samples goes everywhere alike, for what the map's resolution missed.
constexpr float kFloor = 0.02f;
constexpr float kPhotonFloor = 0.1f;  // photons have no second way to find a direction

// Index i with cdf[i] <= u < cdf[i + 1], of n intervals; `fraction` within it.
int find_interval(const float *cdf, int n, float u, float &fraction) {
  const int i = std::clamp(int(std::upper_bound(cdf, cdf + n + 1, u) - cdf) - 1, 0, n - 1);
  const float width = cdf[i + 1] - cdf[i];
  fraction = width > 0 ? clamp((u - cdf[i]) / width, 0.0f, 0x1.fffffep-1f) : 0.5f;
  return i;
}

float importance(const Vec3 &rgb) {
  const Vec3 c = max(rgb, Vec3{});
  const float value = 0.5f * (luminance(c) + average(c));
  return std::isfinite(value) ? value : 0.0f;
}

Vec3 direction_of(float u, float v) {
  const float azimuth = 2 * kPi * (0.5f - u), height = kPi * (v - 0.5f);
  const float c = std::cos(height);
  return {c * std::cos(azimuth), c * std::sin(azimuth), std::sin(height)};
}

Vec2 coordinates_of(const Vec3 &d) {
  const float u = 0.5f - std::atan2(d.y, d.x) / (2 * kPi);
  const float v = 0.5f + std::atan2(d.z, std::hypot(d.x, d.y)) * kInvPi;
  return {saturate(u), saturate(v)};
}

}  // namespace

Vec3 world_radiance(const Scene &scene, const Vec3 &d, uint32_t ray_kind) {
  const Program &program = scene.world.program;
  if (program.constant_emission) return max(Vec3{}, program.emission);
  ShadingPoint sp;
  sp.p = d;
  sp.wo = -d;
  sp.ng = sp.ns = -d;
  sp.ray_kind = ray_kind;
  sp.ray_length = kInfinity;
  // A pixel of a picture may be anything: below zero and NaN count as black.
  const Vec3 rgb = max(Vec3{}, run_emission(scene, program, sp));
  return is_finite(rgb) ? rgb : Vec3{};
}

void WorldLight::build(const Scene &scene) {
  present_ = scene.world.present;
  if (!present_) return;
  const bool map = scene.world.map_width > 0 && !scene.world.program.constant_emission;
  const int width = map ? std::max(4, scene.world.map_width) : 32, height = std::max(2, width / 2);
  std::vector<float> values(size_t(width) * size_t(height));
  parallel_for(height, resolve_threads(scene.threads), scene.commit_cancelled, [&](int64_t y) {
    for (int x = 0; x < width; ++x)
      values[size_t(y) * size_t(width) + size_t(x)] = importance(
          world_radiance(scene, direction_of((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height)), 0));
  });
  scene.stop_if_cancelled();
  double total = 0, solid = 0;
  for (int y = 0; y < height; ++y) {
    const double c = std::cos(kPi * ((y + 0.5) / height - 0.5));
    for (int x = 0; x < width; ++x) total += c * values[size_t(y) * size_t(width) + size_t(x)], solid += c;
  }
  brightness_ = float(total / solid);
  seen_ = {}, emitted_ = {};
  if (!map) return;
  const int threads = resolve_threads(scene.threads);
  seen_.build(values, width, height, brightness_, kFloor, threads);
  emitted_.build(values, width, height, 0, kPhotonFloor, threads);
}

void DirectionMap::build(const std::vector<float> &values, int width, int height, float subtract, float floor_share,
                         int threads) {
  width_ = width, height_ = height;
  const auto at = [&](int x, int y) { return values[size_t(y) * size_t(width) + size_t((x + width) % width)]; };

  // Interpolation spreads a texel over its neighbours, so the map does as well: half is a mean over 3 x 3 cells.
  std::vector<double> smooth(values.size()), rows(size_t(height) + 1, 0);
  const std::atomic<bool> never{false};
  parallel_for(height, threads, never, [&](int64_t row) {
    const int y = int(row), first = std::max(0, y - 1), last = std::min(height - 1, y + 1);
    const double c = std::cos(kPi * ((y + 0.5) / height - 0.5));
    const auto column = [&](int x) {
      double sum = 0;
      for (int j = first; j <= last; ++j) sum += at(x, j);
      return sum;
    };
    double before = column(-1), here = column(0), total = 0;
    for (int x = 0; x < width; ++x) {
      const double after = column(x + 1);
      const double mean = (before + here + after) / (3 * (last - first + 1));
      const double cell = c * std::max(0.5 * at(x, y) + 0.5 * mean - double(subtract), 0.0);
      smooth[size_t(y) * size_t(width) + size_t(x)] = cell;
      total += cell;
      before = here, here = after;
    }
    rows[size_t(y) + 1] = total;
  });
  double total = 0, solid = 0;
  for (int y = 0; y < height; ++y) {
    total += rows[size_t(y) + 1];
    solid += width * std::cos(kPi * ((y + 0.5) / height - 0.5));
  }
  const double floor = total > 0 ? floor_share * total / solid : 1.0;

  row_cdf_.assign(size_t(height) + 1, 0);
  cell_cdf_.assign(size_t(height) * size_t(width + 1), 0);
  density_.assign(values.size(), 0);
  parallel_for(height, threads, never, [&](int64_t y) {
    const double c = std::cos(kPi * ((double(y) + 0.5) / height - 0.5));
    double sum = 0;
    double *cells = &smooth[size_t(y) * size_t(width)];
    for (int x = 0; x < width; ++x) cells[x] = sum += cells[x] + floor * c;
    float *cdf = &cell_cdf_[size_t(y) * size_t(width + 1)];
    for (int x = 0; x < width; ++x) cdf[x + 1] = float(cells[x] / sum);
    rows[size_t(y) + 1] = sum;
  });
  for (size_t y = 0; y < size_t(height); ++y) rows[y + 1] += rows[y];
  for (int y = 0; y <= height; ++y) row_cdf_[size_t(y)] = float(rows[size_t(y)] / rows[size_t(height)]);
  // The density that sampling the rounded tables really has.
  parallel_for(height, threads, never, [&](int64_t y) {
    const float share = (row_cdf_[size_t(y) + 1] - row_cdf_[size_t(y)]) * float(width) * float(height);
    const float *cdf = &cell_cdf_[size_t(y) * size_t(width + 1)];
    float *density = &density_[size_t(y) * size_t(width)];
    for (int x = 0; x < width; ++x) density[x] = share * (cdf[x + 1] - cdf[x]);
  });
}

Vec3 DirectionMap::sample(Vec2 u, float &pdf) const {
  float fx, fy;
  const int y = find_interval(row_cdf_.data(), height_, u.y, fy);
  const int x = find_interval(&cell_cdf_[size_t(y) * size_t(width_ + 1)], width_, u.x, fx);
  const Vec3 d = direction_of((float(x) + fx) / float(width_), (float(y) + fy) / float(height_));
  const float c = std::hypot(d.x, d.y);
  pdf = c > 0 ? density_[size_t(y) * size_t(width_) + size_t(x)] / (2 * kPi * kPi * c) : 0.0f;
  return d;
}

float DirectionMap::pdf(const Vec3 &d) const {
  const Vec2 uv = coordinates_of(d);
  const int x = std::min(int(uv.x * float(width_)), width_ - 1), y = std::min(int(uv.y * float(height_)), height_ - 1);
  const float c = std::hypot(d.x, d.y);
  return c > 0 ? density_[size_t(y) * size_t(width_) + size_t(x)] / (2 * kPi * kPi * c) : 0.0f;
}

Vec3 WorldLight::sample(const Vec3 &normal, bool transmissive, Vec2 u, float &pdf) const {
  if (!seen_.empty()) return seen_.sample(u, pdf);
  if (length_squared(normal) == 0) {
    pdf = 1 / kFourPi;
    return sample_sphere(u);
  }
  const bool behind = transmissive && u.x >= 0.5f;
  if (transmissive) u.x = behind ? reuse_above(u.x, 0.5f) : reuse_below(u.x, 0.5f);
  const Frame frame = Frame::from_z(behind ? -normal : normal);
  const Vec3 d = normalize(sample_cosine(frame, u));
  pdf = std::max(dot(d, frame.z), 0.0f) * kInvPi * (transmissive ? 0.5f : 1.0f);
  return d;
}

Vec3 WorldLight::sample_emission(Vec2 u, float &pdf) const {
  if (!emitted_.empty()) return emitted_.sample(u, pdf);
  pdf = 1 / kFourPi;
  return sample_sphere(u);
}

float WorldLight::pdf(const Vec3 &normal, bool transmissive, const Vec3 &d) const {
  if (!seen_.empty()) return seen_.pdf(d);
  if (length_squared(normal) == 0) return 1 / kFourPi;
  const float c = dot(normal, d);
  return transmissive ? std::abs(c) * kInvPi * 0.5f : std::max(c, 0.0f) * kInvPi;
}

}  // namespace opal
