// SPDX-License-Identifier: GPL-3.0-or-later
// See work_plan.h.
#include "integrator/work_plan.h"

#include "core/sampler.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opal {
namespace {

// The share of the paths that is spread evenly: what the pilot overlooked costs at most the root of its inverse in noise.
constexpr float kEvenShare = 0.25f;
constexpr float kMostPhotons = 8, kLeastPhotons = 0.125f;  // times the settings' number
constexpr float kMostPaths = 16;
// Below this share of the mean brightness noise no longer counts by the pixel's own.
constexpr float kDark = 0.1f;
// Blocks of the highest variance, left out where photons are weighed against paths: a glint must not decide for the picture.
constexpr float kOutliers = 0.005f;

float mean_square(const Vec3 &v) { return (sqr(v.x) + sqr(v.y) + sqr(v.z)) / 3; }

// Mean over the 3 x 3 blocks round each: a pilot's variance is itself a noisy estimate.
std::vector<float> blurred(const std::vector<float> &values, int width) {
  const int height = int(values.size()) / width;
  std::vector<float> out(values.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float sum = 0;
      int n = 0;
      for (int j = std::max(0, y - 1); j <= std::min(height - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(width - 1, x + 1); ++i) sum += values[size_t(j * width + i)], ++n;
      out[size_t(y * width + x)] = sum / float(n);
    }
  return out;
}

float mean(const std::vector<float> &values) {
  return values.empty() ? 0.0f : std::accumulate(values.begin(), values.end(), 0.0f) / float(values.size());
}

float mean_without_outliers(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  values.resize(values.size() - size_t(kOutliers * float(values.size())));
  return mean(values);
}

}  // namespace

WorkPlan::WorkPlan(const std::vector<PilotBlock> &blocks, int blocks_x, int samples, int photons, float rays_of_photon)
    : blocks_x_(blocks_x), blocks_y_(int(blocks.size()) / blocks_x), photons_(photons) {
  const size_t n = blocks.size();
  Vec3 sum;
  for (const PilotBlock &b : blocks) sum += b.brightness;
  const float dark = kDark * mean_square(sum / float(n));
  std::vector<float> path(n), photon(n), rays(n);
  for (size_t i = 0; i < n; ++i) {
    const PilotBlock &b = blocks[i];
    const float scale = mean_square(b.brightness) + dark;
    path[i] = scale > 0 ? b.path_variance / scale : 0;
    photon[i] = scale > 0 ? b.photon_variance / scale : 0;
    rays[i] = std::max(1.0f, b.rays);
  }
  path = blurred(path, blocks_x), rays = blurred(rays, blocks_x);

  // Where the paths go, with a mean cost as if they went evenly.
  const float cost = mean(rays);
  std::vector<float> wanted(n);
  float wanted_cost = 0;
  for (size_t i = 0; i < n; ++i) {
    wanted[i] = std::sqrt(path[i] / rays[i]);
    wanted_cost += wanted[i] * rays[i] / float(n);
  }
  density_.assign(n, 1.0f);
  if (wanted_cost > 0)
    for (size_t i = 0; i < n; ++i) density_[i] = kEvenShare + (1 - kEvenShare) * wanted[i] * cost / wanted_cost;

  // How many, beside how many photons.
  float paths = float(samples);
  if (photons > 0) {
    std::vector<float> left(n);
    for (size_t i = 0; i < n; ++i) left[i] = path[i] / density_[i];
    const float of_paths = mean_without_outliers(left), of_photons = mean_without_outliers(photon);
    const float pixels = float(n) * kPlanBlock * kPlanBlock, photon_cost = std::max(rays_of_photon, 0.1f) / pixels;
    const float budget = float(samples) * cost + float(photons) * photon_cost;
    const float fewest = kLeastPhotons * float(photons), most = kMostPhotons * float(photons);
    float many = of_paths > 0
                     ? budget / (photon_cost + cost * std::sqrt(of_paths * photon_cost / std::max(of_photons * cost, 1e-30f)))
                     : most;
    many = clamp(std::min(many, (budget - cost) / photon_cost), fewest, most);
    paths = clamp((budget - many * photon_cost) / cost, 1.0f, kMostPaths * float(samples));
    photons_ = std::max(1, int(many));
  }
  for (float &d : density_) d *= paths;
}

float WorkPlan::density(int block_x, int block_y) const {
  block_x = std::clamp(block_x, 0, blocks_x_ - 1), block_y = std::clamp(block_y, 0, blocks_y_ - 1);
  return density_[size_t(block_y) * size_t(blocks_x_) + size_t(block_x)];
}

int WorkPlan::samples(int x, int y, uint32_t seed) const {
  const float u = (float(x) + 0.5f) / kPlanBlock - 0.5f, v = (float(y) + 0.5f) / kPlanBlock - 0.5f;
  const float left = std::floor(u), below = std::floor(v), s = u - left, t = v - below;
  const int i = int(left), j = int(below);
  const float here = lerp(lerp(density(i, j), density(i + 1, j), s), lerp(density(i, j + 1), density(i + 1, j + 1), s), t);
  const float chance = float(hash32(hash32(seed, uint32_t(x)), uint32_t(y)) >> 8) * 0x1p-24f;
  return std::max(1, int(here + chance));
}

}  // namespace opal
