// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/emission_guide.h"

#include <algorithm>
#include <cmath>

namespace opal {
namespace {

int cell_of(float x, int n) { return std::min(int(x * float(n)), n - 1); }

// Roots of the rates: use per try, where a cell that was hardly tried keeps near the average.
std::vector<double> roots(const std::vector<double> &use, const std::vector<double> &tries, double average) {
  constexpr double kPrior = 2;  // tries
  std::vector<double> weight(use.size());
  for (size_t i = 0; i < use.size(); ++i) weight[i] = std::sqrt((use[i] + kPrior * average) / (tries[i] + kPrior));
  return weight;
}

}  // namespace

template <int N>
void EmissionGuide::Line<N>::build(const std::array<double, N> &weight) {
  double sum = 0;
  for (const double w : weight) sum += w;
  cdf[0] = 0;
  double running = 0;
  for (size_t i = 0; i < N; ++i) {
    const double share = sum > 0 ? weight[i] / sum : 1.0 / N;
    running += share;
    cdf[i + 1] = float(running);
  }
  cdf[N] = 1;
  for (size_t i = 0; i < N; ++i) density[i] = (cdf[i + 1] - cdf[i]) * float(N);  // of the numbers that warp() really makes
}

template <int N>
float EmissionGuide::Line<N>::warp(float u, float &d) const {
  const auto above = std::upper_bound(cdf.begin(), cdf.end() - 1, u);
  const size_t i = size_t(std::max<std::ptrdiff_t>(0, above - cdf.begin() - 1));
  const float width = cdf[i + 1] - cdf[i];
  d = density[i];
  const float within = width > 0 ? std::min((u - cdf[i]) / width, 0x1.fffffep-1f) : 0.5f;
  return std::min((float(i) + within) / float(N), 0x1.fffffep-1f);
}

void EmissionGuide::Square::build(const std::vector<double> &weight) {
  std::array<double, kSide> marginal{};
  for (int y = 0; y < kSide; ++y) {
    std::array<double, kSide> row;
    for (int x = 0; x < kSide; ++x) row[size_t(x)] = weight[size_t(y * kSide + x)], marginal[size_t(y)] += row[size_t(x)];
    columns[size_t(y)].build(row);
  }
  rows.build(marginal);
}

Vec2 EmissionGuide::Square::warp(Vec2 u, float &d) const {
  float dy, dx;
  const float y = rows.warp(u.y, dy);
  const float x = columns[size_t(cell_of(y, kSide))].warp(u.x, dx);
  d = dy * dx;
  return {x, y};
}

size_t EmissionGuide::group_of(float pick) const {
  if (groups_.empty()) return 0;
  const auto above = std::upper_bound(cdf_.begin(), cdf_.end(), pick);
  const auto source = std::clamp<std::ptrdiff_t>(above - cdf_.begin() - 1, 0, std::ptrdiff_t(groups_.size()) - 1);
  return groups_[size_t(source)];
}

EmissionGuide::EmissionGuide(const std::vector<EmissionTrial> &trials, const std::vector<float> &sources) : cdf_(sources) {
  uint32_t n_groups = 1;
  for (size_t i = 0; i + 1 < cdf_.size(); ++i) groups_.push_back(cdf_[i + 1] - cdf_[i] >= kStrong ? n_groups++ : 0);
  sources_.resize(n_groups);

  struct Count {
    explicit Count(int n) : use(size_t(n)), tries(size_t(n)) {}
    void add(size_t cell, const EmissionTrial &trial) {
      use[cell] += double(trial.use) / double(trial.density), tries[cell] += 1 / double(trial.density);
    }
    std::vector<double> use, tries;
  };
  Count all(1), lights(kLights);
  for (const EmissionTrial &trial : trials) {
    all.add(0, trial);
    lights.add(size_t(cell_of(trial.numbers.pick.x, kLights)), trial);
  }
  const double mean = trials.empty() ? 1 : std::max(all.use[0] / all.tries[0], 1e-9);
  std::array<double, kLights> weight;
  const std::vector<double> root = roots(lights.use, lights.tries, mean);
  std::copy(root.begin(), root.end(), weight.begin());
  lights_.build(weight);

  const auto cell = [](Vec2 p) { return size_t(cell_of(p.y, kSide) * kSide + cell_of(p.x, kSide)); };
  for (uint32_t group = 0; group < n_groups; ++group) {
    Count within(1), position(kSide * kSide), direction(kSide * kSide);
    for (const EmissionTrial &trial : trials) {
      if (group_of(trial.numbers.pick.x) != group) continue;
      within.add(0, trial);
      position.add(cell(trial.numbers.position), trial);
      direction.add(cell(trial.numbers.direction), trial);
    }
    const double rate = within.tries[0] > 0 ? std::max(within.use[0] / within.tries[0], 1e-3 * mean) : mean;
    sources_[group].position.build(roots(position.use, position.tries, rate));
    sources_[group].direction.build(roots(direction.use, direction.tries, rate));
  }
}

EmissionNumbers EmissionGuide::warp(EmissionNumbers u, float &density) const {
  float learned;
  if (u.pick.y < kPlain) {
    u.pick.y /= kPlain;
    const Source &source = source_of(u.pick.x);
    learned = lights_.at(u.pick.x) * source.position.at(u.position) * source.direction.at(u.direction);
  } else {
    u.pick.y = std::min((u.pick.y - kPlain) / (1 - kPlain), 0x1.fffffep-1f);
    float light, position, direction;
    u.pick.x = lights_.warp(u.pick.x, light);
    const Source &source = source_of(u.pick.x);
    u.position = source.position.warp(u.position, position);
    u.direction = source.direction.warp(u.direction, direction);
    learned = light * position * direction;
  }
  density = kPlain + (1 - kPlain) * learned;
  return u;
}

}  // namespace opal
