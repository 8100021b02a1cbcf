// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/grid.h"

#include <algorithm>

namespace opal {

Grid::Grid(const int size[3], int channels, const Transform &index_to_object)
    : size_{size[0], size[1], size[2]}, channels_(channels) {
  for (int axis = 0; axis < 3; ++axis) bricks_[axis] = (size_[axis] + 1 + kCells - 1) / kCells;
  table_.resize(size_t(bricks_[0]) * size_t(bricks_[1]) * size_t(bricks_[2]));
  to_lattice_ = inverse(index_to_object);
  to_lattice_.m[3] += 1, to_lattice_.m[7] += 1, to_lattice_.m[11] += 1;
}

void Grid::set_block(const int origin[3], const int size[3], const float *values, Bad &bad) {
  const size_t n = size_t(size[0]) * size_t(size[1]) * size_t(size[2]) * size_t(channels_);
  for (size_t i = 0; i < n; ++i) {
    bad.not_finite += !std::isfinite(values[i]);
    bad.negative += values[i] < 0 && std::isfinite(values[i]);
  }
  // The block in lattice coordinates, and the bricks that hold a part of it (a brick begins with the last layer of the one
  // before).
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    first[a] = std::max(0, (origin[a] + 1 - 1) / kCells);
    last[a] = std::min(bricks_[a] - 1, (origin[a] + size[a]) / kCells);
  }
  const auto clean = [](float v) { return std::isfinite(v) && v > 0 ? v : 0.0f; };
  for (int bz = first[2]; bz <= last[2]; ++bz)
    for (int by = first[1]; by <= last[1]; ++by)
      for (int bx = first[0]; bx <= last[0]; ++bx) {
        Brick &brick = table_[(size_t(bz) * size_t(bricks_[1]) + size_t(by)) * size_t(bricks_[0]) + size_t(bx)];
        const int b[3] = {bx, by, bz};
        int low[3], high[3];  // samples of this brick that the block writes
        for (int a = 0; a < 3; ++a) {
          low[a] = std::max(0, origin[a] + 1 - b[a] * kCells);
          high[a] = std::min(kCells, origin[a] + size[a] - b[a] * kCells);
        }
        const auto read = [&](int x, int y, int z, int c) {
          const size_t i = size_t(bx * kCells + x - 1 - origin[0]), j = size_t(by * kCells + y - 1 - origin[1]),
                       k = size_t(bz * kCells + z - 1 - origin[2]);
          return clean(values[((i * size_t(size[1]) + j) * size_t(size[2]) + k) * size_t(channels_) + size_t(c)]);
        };
        const auto for_each = [&](const auto &visit) {
          for (int x = low[0]; x <= high[0]; ++x)
            for (int y = low[1]; y <= high[1]; ++y)
              for (int z = low[2]; z <= high[2]; ++z)
                for (int c = 0; c < channels_; ++c) visit(x, y, z, c);
        };
        if (!brick.samples) {
          bool any = false;
          for_each([&](int x, int y, int z, int c) { any |= read(x, y, z, c) > 0; });
          if (!any) continue;
          brick.samples = std::make_unique<float[]>(size_t(kSamples * kSamples * kSamples * channels_));
          ++kept_;
        }
        for_each([&](int x, int y, int z, int c) {
          brick.samples[size_t(((z * kSamples + y) * kSamples + x) * channels_ + c)] = read(x, y, z, c);
        });
        update(brick);
      }
}

void Grid::update(Brick &brick) {
  double sum = 0;
  brick.majorant = 0;
  for (int i = 0; i < kSamples * kSamples * kSamples; ++i) {
    float largest = 0;
    for (int c = 0; c < channels_; ++c) largest = std::max(largest, brick.samples[size_t(i * channels_ + c)]);
    brick.majorant = std::max(brick.majorant, largest);
    sum += largest;
  }
  brick.mean = float(sum / (kSamples * kSamples * kSamples));
  majorant_ = std::max(majorant_, brick.majorant);
}

const Grid::Brick *Grid::cell(const Vec3 &s, size_t &offset, float weight[8]) const {
  // Written so that what is not a number is outside.
  if (!(s.x >= 0 && s.y >= 0 && s.z >= 0 && s.x < float(size_[0] + 1) && s.y < float(size_[1] + 1) &&
        s.z < float(size_[2] + 1)))
    return nullptr;
  const int x = int(s.x), y = int(s.y), z = int(s.z);
  const Brick &b = brick(x / kCells, y / kCells, z / kCells);
  if (!b.samples) return nullptr;
  offset = size_t((((z % kCells) * kSamples + y % kCells) * kSamples + x % kCells) * channels_);
  const float fx = s.x - float(x), fy = s.y - float(y), fz = s.z - float(z);
  for (int i = 0; i < 8; ++i) weight[i] = (i & 1 ? fx : 1 - fx) * (i & 2 ? fy : 1 - fy) * (i & 4 ? fz : 1 - fz);
  return &b;
}

float Grid::value(const Vec3 &s) const {
  size_t offset;
  float weight[8];
  const Brick *b = cell(s, offset, weight);
  if (!b) return 0;
  const float *v = b->samples.get() + offset;
  float sum = 0;
  for (int i = 0; i < 8; ++i)
    sum += weight[i] * v[((i >> 2) * kSamples * kSamples + ((i >> 1) & 1) * kSamples + (i & 1)) * channels_];
  return sum;
}

Vec3 Grid::color(const Vec3 &s) const {
  size_t offset;
  float weight[8];
  const Brick *b = cell(s, offset, weight);
  if (!b) return {};
  const float *v = b->samples.get() + offset;
  Vec3 sum;
  for (int i = 0; i < 8; ++i) {
    const float *c = v + ((i >> 2) * kSamples * kSamples + ((i >> 1) & 1) * kSamples + (i & 1)) * channels_;
    sum += Vec3{c[0], c[1], c[2]} * weight[i];
  }
  return sum;
}

int64_t Grid::memory_bytes() const {
  return int64_t(table_.size() * sizeof(Brick)) +
         kept_ * int64_t(kSamples * kSamples * kSamples * channels_ * int(sizeof(float)));
}

}  // namespace opal
