// SPDX-License-Identifier: GPL-3.0-or-later
// Which sources photons start from, in proportion to the power that they send towards a set of targets.
#pragma once

#include "lights/lights.h"

#include <vector>

namespace opal {

struct LightTables;

struct EmissionTable {
  std::vector<EmissionTarget> targets;
  std::vector<SourceId> sources;
  std::vector<float> cdf;  // sources + 1, or empty: nothing reaches a target

  // caustics_only: lamps and a world that do not send caustic photons are left out.
  void build(const Scene &scene, const LightTables &lights, std::vector<EmissionTarget> targets, bool caustics_only);
  bool choose(float &u, SourceId &source, float &probability) const;
};

}  // namespace opal
