// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/volume_map.h"

#include "core/large_pages.h"
#include "core/parallel.h"
#include "core/sampler.h"

#include <cmath>

namespace opal {
namespace {

// Runs task(k) for k in [0, n), many at a time on each thread.
template <class Task>
void in_chunks(size_t n, int threads, const Task &task) {
  constexpr size_t kChunk = 1 << 16;
  const std::atomic<bool> never{false};
  parallel_for(int64_t((n + kChunk - 1) / kChunk), threads, never, [&](int64_t c) {
    for (size_t k = size_t(c) * kChunk; k < std::min(n, size_t(c + 1) * kChunk); ++k) task(k);
  });
}

}  // namespace

uint32_t media_key(const MediumSet &media) {
  uint32_t key = 0;
  for (int i = 0; i < media.count(); ++i) key += hash32(media[i].instance, uint32_t(media[i].medium));
  return key;
}

// The median distance to the n-th nearest photon of the same set, of at most 256 photons. Neighbours are looked for
// among the next along the tree's curve: a little too far at times, which a median forgives.
float VolumeMap::typical_distance(int gather) const {
  std::vector<float> distances, near;
  const int n = std::clamp(gather, 1, 512);
  for (uint32_t set = 0; set < 8; ++set) {
    const uint32_t first = tree_.first(set), last = tree_.last(set);
    const uint32_t step = std::max(1u, (last - first) / 32);
    for (uint32_t k = first; k < last; k += step) {
      near.clear();
      const uint32_t from = k - std::min(k - first, uint32_t(2 * n)), to = std::min(last, k + uint32_t(2 * n) + 1);
      for (uint32_t i = from; i < to; ++i)
        if (i != k) near.push_back(length_squared(photons_[i].position - photons_[k].position));
      if (near.empty()) continue;
      const size_t nth = std::min(near.size(), size_t(n)) - 1;
      std::nth_element(near.begin(), near.begin() + std::ptrdiff_t(nth), near.end());
      distances.push_back(std::sqrt(near[nth]));
    }
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + std::ptrdiff_t(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

void VolumeMap::build(std::vector<VolumePhoton> &&photons, float radius, float shrunk, int gather, int threads) {
  *this = {};
  if (photons.empty()) return;
  const std::vector<uint32_t> order = tree_.build(
      photons.size(), [&](size_t i) { return Bounds{photons[i].position, photons[i].position}; },
      [&](size_t i) { return photons[i].set; }, threads);
  reserve_large(photons_, photons.size());
  photons_.resize(photons.size());
  in_chunks(order.size(), threads, [&](size_t k) { photons_[k] = photons[order[k]]; });
  radius_ = radius > 0 ? radius : typical_distance(gather) * shrunk;
}

void VolumeMap::build(std::vector<PhotonBeam> &&beams, float radius, int threads) {
  *this = {};
  if (beams.empty() || !(radius > 0)) return;
  beams_ = std::move(beams);
  radius_ = radius;
  // Short pieces make tight boxes and a tall tree: sixteen to a beam while that is cheap, and where beams are many all but the
  // longest in one.
  double total = 0;
  for (const PhotonBeam &beam : beams_) total += double(beam.length);
  const double per_beam = std::min(4e6 / double(beams_.size()), 16.0);
  const float wanted = std::max(float(total / (double(beams_.size()) * per_beam)), 2 * radius);
  std::vector<Piece> pieces;
  reserve_large(pieces, size_t(double(beams_.size()) * (per_beam + 1)));
  for (uint32_t i = 0; i < beams_.size(); ++i) {
    const uint32_t count = uint32_t(std::clamp(std::ceil(beams_[i].length / wanted), 1.0f, 64.0f));
    for (uint32_t k = 0; k < count; ++k) pieces.push_back({i, uint16_t(k), uint16_t(count)});
  }
  const std::vector<uint32_t> order = tree_.build(
      pieces.size(),
      [&](size_t i) {
        const PhotonBeam &beam = beams_[pieces[i].beam];
        Bounds box;
        box.extend(beam.at(pieces[i].start(beam)));
        box.extend(beam.at(pieces[i].end(beam)));
        return box;
      },
      [&](size_t i) { return beams_[pieces[i].beam].set; }, threads);
  reserve_large(pieces_, pieces.size());
  pieces_.resize(pieces.size());
  in_chunks(order.size(), threads, [&](size_t k) { pieces_[k] = pieces[order[k]]; });
}

bool VolumeMap::clip(const Vec3 &origin, const Vec3 &direction, uint32_t set, float &t_min, float &t_max) const {
  const Bounds &box = tree_.bounds(set);
  for (int a = 0; a < 3; ++a) {
    const float low = box.low[a] - radius_ - origin[a], high = box.high[a] + radius_ - origin[a];
    if (std::abs(direction[a]) < 1e-18f) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const float t0 = low / direction[a], t1 = high / direction[a];
    t_min = std::max(t_min, std::min(t0, t1)), t_max = std::min(t_max, std::max(t0, t1));
  }
  return t_min < t_max;
}

int64_t VolumeMap::memory_bytes() const {
  return tree_.memory_bytes() +
         int64_t(photons_.size() * sizeof(VolumePhoton) + beams_.size() * sizeof(PhotonBeam) + pieces_.size() * sizeof(Piece));
}

}  // namespace opal
