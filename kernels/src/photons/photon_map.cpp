// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/photon_map.h"

#include "core/radix_sort.h"
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

void PhotonMap::build(Chunks<Photon> &&chunks, float radius, int threads) {
  radius_ = radius;
  photons_ = {};
  starts_ = {};
  const std::vector<size_t> starts = starts_of(chunks);
  const size_t n = starts.back();
  if (n == 0 || !(radius > 0)) return;
  origin_ = bounds_of_positions(chunks, threads).low;
  mask_ = uint32_t(std::bit_ceil(n) - 1);

  // Stable, so that the order inside a bucket is the order of emission.
  LargeArray<Keyed<const Photon *>> keyed(n);
  for_chunks(chunks, threads, [&](size_t c) {
    for (size_t i = 0; i < chunks[c].size(); ++i) keyed[starts[c] + i] = {bucket_of(chunks[c][i]), &chunks[c][i]};
  });
  radix_sort(keyed, std::bit_width(mask_), threads);
  photons_ = LargeArray<Photon>(n);
  starts_ = LargeArray<uint32_t>(size_t(mask_) + 2);
  for_slices(n, threads, [&](size_t, size_t from, size_t to) {
    for (size_t k = from; k < to; ++k) {
      photons_[k] = *keyed[k].item;
      for (size_t b = k > 0 ? size_t(keyed[k - 1].key) + 1 : 0; b <= keyed[k].key; ++b) starts_[b] = uint32_t(k);
    }
  });
  for (size_t b = size_t(keyed[n - 1].key) + 1; b < starts_.size(); ++b) starts_[b] = uint32_t(n);
}

}  // namespace opal
