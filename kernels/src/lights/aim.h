// SPDX-License-Identifier: GPL-3.0-or-later
// Aiming photons at targets: a mixture of densities, one a target, whose sum is evaluated exactly where targets overlap.
//
// From a point a target is a cone of directions; along a direction it is a disc of parallel rays. In both cases a target
// is chosen with its weight, a place within it uniformly, and the probability is the weighted sum over all targets that
// hold that place (the balance of Veach & Guibas 1995 in one sample).
#pragma once

#include "core/vec.h"
#include "lights/lights.h"

namespace opal {

inline constexpr int kMostTargets = 64;

// What the emitter sends: decides which directions are worth sampling.
struct Emitter {
  enum class Kind { Everywhere, OneSided, TwoSided } kind = Kind::Everywhere;
  Vec3 axis;           // normal, or the axis of a spot
  float cone_omc = 2;  // light stays within this cone round the axis (1 - cos)
};

class DirectionAim {
 public:
  // From x; `grow` is added to the radius of each target (lamps with a size are emitted from round x).
  DirectionAim(const Vec3 &x, const Emitter &emitter, const std::vector<EmissionTarget> &targets, float grow);
  // Solid angle worth sampling, each target's weighed by the cosine of a surface: in proportion to what the targets get.
  float total() const { return total_; }
  bool sample(float pick, Vec2 u, Vec3 &direction, float &pdf) const;
  float pdf(const Vec3 &direction) const;

 private:
  // Cone of directions, or the emitter's own whole distribution where x lies within the target.
  struct Part {
    Vec3 axis;
    float omc, weight;
    bool whole;
  };
  float density(const Part &part, const Vec3 &direction) const;

  Emitter emitter_;
  Part parts_[kMostTargets];
  int count_ = 0;
  float total_ = 0;
};

class ParallelAim {
 public:
  ParallelAim(const Vec3 &direction, const std::vector<EmissionTarget> &targets);
  float total() const { return total_; }  // area, overlaps counted as often as they overlap
  // A point of the plane through the target's centre; pdf per area perpendicular to the direction.
  bool sample(float pick, Vec2 u, Vec3 &point, float &pdf) const;

 private:
  Frame frame_;
  const std::vector<EmissionTarget> &targets_;
  float total_ = 0;
};

}  // namespace opal
