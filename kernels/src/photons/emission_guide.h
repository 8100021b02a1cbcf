// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the emitted photons matter, learned before the first pass.
//
// Aiming at what makes caustics (lights/aim.h) knows spheres; it does not know that a slit stands before the prism, or
// which facets throw their light where the camera looks. A pilot of photons finds out: piecewise constant densities over
// the random numbers that emission uses - which light, where on it, which way - are made proportional to the root of the
// rate at which photons were of use, which minimises the variance of what they add up to (Jensen 2001's projection maps,
// learned instead of projected). A second round of the pilot, sent where the first was of use, sharpens what it found; its
// photons count by the inverse of their density, so that rates stay those of plain photons. Each strong source has densities of
// its own, weak ones share theirs. A seventh of all photons keeps the plain distribution, so that nothing is ever missed and no
// photon outweighs a plain one by more than seven.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace opal {

// The random numbers of one emission.
struct EmissionNumbers {
  Vec2 pick, position, direction;
};

// A photon of the pilot: of what use its numbers were (>= 0), and by what density they were chosen.
struct EmissionTrial {
  EmissionNumbers numbers;
  float use = 0, density = 1;
};

class EmissionGuide {
 public:
  // sources: the cumulative probabilities by which pick.x chooses a source.
  EmissionGuide(const std::vector<EmissionTrial> &trials, const std::vector<float> &sources);
  // Numbers that matter, from uniform ones; density is theirs relative to uniform numbers.
  EmissionNumbers warp(EmissionNumbers u, float &density) const;

 private:
  static constexpr int kLights = 64, kSide = 32;
  static constexpr float kStrong = 1.0f / 16;  // share of a source that has densities of its own
  static constexpr float kPlain = 0.15f;

  // A piecewise constant density over [0,1) and its warp.
  template <int N>
  struct Line {
    std::array<float, N> density;
    std::array<float, N + 1> cdf;
    void build(const std::array<double, N> &weight);
    float warp(float u, float &d) const;
    float at(float x) const { return density[size_t(std::min(int(x * N), N - 1))]; }
  };
  // Over the unit square: a marginal in y, a conditional in x.
  struct Square {
    Line<kSide> rows;
    std::array<Line<kSide>, kSide> columns;
    void build(const std::vector<double> &weight);
    Vec2 warp(Vec2 u, float &d) const;
    float at(Vec2 p) const { return rows.at(p.y) * columns[size_t(std::min(int(p.y * kSide), kSide - 1))].at(p.x); }
  };

  struct Source {
    Square position, direction;
  };

  const Source &source_of(float pick) const { return sources_[group_of(pick)]; }
  size_t group_of(float pick) const;

  Line<kLights> lights_;
  std::vector<float> cdf_;
  std::vector<uint32_t> groups_;  // of each source; the first is shared by the weak
  std::vector<Source> sources_;   // by group
};

}  // namespace opal
