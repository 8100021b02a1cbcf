// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/volume_map.h"

#include "core/sampler.h"

#include <cmath>
#include <numeric>

namespace opal {
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

void VolumeMap::build(Chunks<VolumePhoton> &&chunks, float radius, float shrunk, int gather, int threads) {
  *this = {};
  const std::vector<size_t> starts = starts_of(chunks);
  const size_t n = starts.back();
  if (n == 0) return;
  const CurveOfSets curve(bounds_of_positions(chunks, threads));
  LargeArray<Keyed<const VolumePhoton *>> keyed(n);
  for_chunks(chunks, threads, [&](size_t c) {
    for (size_t i = 0; i < chunks[c].size(); ++i) {
      const VolumePhoton &photon = chunks[c][i];
      keyed[starts[c] + i] = {curve.key(photon.set, photon.position), &photon};
    }
  });
  tree_.build(keyed, [](const VolumePhoton *photon) { return Bounds{photon->position, photon->position}; }, threads);
  photons_ = LargeArray<VolumePhoton>(n);
  for_slices(n, threads, [&](size_t, size_t from, size_t to) {
    for (size_t k = from; k < to; ++k) photons_[k] = *keyed[k].item;
  });
  radius_ = radius > 0 ? radius : typical_distance(gather) * shrunk;
}

void VolumeMap::build(Chunks<PhotonBeam> &&chunks, float radius, int threads) {
  *this = {};
  const size_t n = starts_of(chunks).back();
  if (n == 0 || !(radius > 0)) return;
  beams_ = std::move(chunks);
  n_beams_ = n;
  radius_ = radius;

  std::vector<Bounds> bounds(beams_.size());
  std::vector<double> lengths(beams_.size(), 0.0);
  for_chunks(beams_, threads, [&](size_t c) {
    for (const PhotonBeam &beam : beams_[c]) {
      lengths[c] += double(beam.length);
      bounds[c].extend(beam.origin);
      bounds[c].extend(beam.at(beam.length));
    }
  });
  for (const Bounds &b : bounds) bounds[0].extend(b);
  const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);

  // Short pieces make tight boxes and a tall tree: sixteen to a beam while that is cheap, and where beams are many all but
  // the longest in one.
  const double per_beam = std::min(4e6 / double(n), 16.0);
  const float wanted = std::max(float(total / (double(n) * per_beam)), 2 * radius);
  const auto pieces_of = [wanted](const PhotonBeam &beam) {
    return uint32_t(std::clamp(std::ceil(beam.length / wanted), 1.0f, 64.0f));
  };
  std::vector<size_t> starts(beams_.size() + 1, 0);
  for_chunks(beams_, threads, [&](size_t c) {
    for (const PhotonBeam &beam : beams_[c]) starts[c + 1] += pieces_of(beam);
  });
  for (size_t c = 0; c < beams_.size(); ++c) starts[c + 1] += starts[c];

  const CurveOfSets curve(bounds[0]);
  LargeArray<Keyed<Piece>> keyed(starts.back());
  for_chunks(beams_, threads, [&](size_t c) {
    size_t next = starts[c];
    for (const PhotonBeam &beam : beams_[c]) {
      const uint32_t count = pieces_of(beam);
      for (uint32_t k = 0; k < count; ++k) {
        const Piece piece{&beam, k, count};
        keyed[next++] = {curve.key(beam.set, piece.box().centre()), piece};
      }
    }
  });
  tree_.build(keyed, [](const Piece &piece) { return piece.box(); }, threads);
  pieces_ = LargeArray<Piece>(keyed.size());
  for_slices(keyed.size(), threads, [&](size_t, size_t from, size_t to) {
    for (size_t k = from; k < to; ++k) pieces_[k] = keyed[k].item;
  });
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
         int64_t(photons_.size() * sizeof(VolumePhoton) + n_beams_ * sizeof(PhotonBeam) + pieces_.size() * sizeof(Piece));
}

}  // namespace opal
