// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/photon_map.h"

#include "core/large_pages.h"
#include "core/parallel.h"
#include "core/sampler.h"

#include <bit>

namespace opal {

uint32_t pack_direction(const Vec3 &d) {
  const float s = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  float x = d.x * s, y = d.y * s;
  if (d.z < 0) {
    const float fx = (1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f), fy = (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f);
    x = fx, y = fy;
  }
  const auto quantize = [](float v) { return uint32_t(std::lround(clamp(v * 0.5f + 0.5f, 0, 1) * 65535)); };
  return quantize(x) | quantize(y) << 16;
}

Vec3 unpack_direction(uint32_t packed) {
  float x = float(packed & 65535u) / 65535 * 2 - 1, y = float(packed >> 16) / 65535 * 2 - 1;
  const float z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const float fx = (1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f), fy = (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f);
    x = fx, y = fy;
  }
  return normalize(Vec3{x, y, z});
}

uint32_t PhotonMap::bucket_of(int64_t x, int64_t y, int64_t z, uint32_t set) const {
  return hash32(hash32(uint32_t(x), uint32_t(y)), hash32(uint32_t(z), set)) & mask_;
}

uint32_t PhotonMap::bucket_of(const Photon &photon) const {
  const Vec3 g = (photon.position - origin_) / (2 * radius_);
  return bucket_of(int64_t(std::floor(g.x)), int64_t(std::floor(g.y)), int64_t(std::floor(g.z)), photon.set);
}

void PhotonMap::build(std::vector<Photon> &&photons, float radius, int threads) {
  radius_ = radius;
  photons_.clear();
  starts_.clear();
  if (photons.empty() || !(radius > 0)) return;
  Bounds bounds;
  for (const Photon &p : photons) bounds.extend(p.position);
  origin_ = bounds.low;
  mask_ = uint32_t(std::bit_ceil(photons.size()) - 1);

  // A counting sort, stable, so that the order inside a bucket is the order of emission.
  std::vector<uint32_t> bucket(photons.size());
  const std::atomic<bool> never{false};
  constexpr int64_t kChunk = 16384;
  parallel_for((int64_t(photons.size()) + kChunk - 1) / kChunk, threads, never, [&](int64_t c) {
    const size_t last = std::min(photons.size(), size_t((c + 1) * kChunk));
    for (size_t i = size_t(c * kChunk); i < last; ++i) bucket[i] = bucket_of(photons[i]);
  });
  starts_.assign(size_t(mask_) + 2, 0);
  for (const uint32_t b : bucket) ++starts_[size_t(b) + 1];
  for (size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
  reserve_large(photons_, photons.size());
  photons_.resize(photons.size());
  for (size_t i = 0; i < photons.size(); ++i) photons_[next[bucket[i]]++] = photons[i];
}

}  // namespace opal
