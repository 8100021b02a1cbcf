// SPDX-License-Identifier: GPL-3.0-or-later
// The Voronoi node: cellular noise (Worley 1996) in 1 to 4 dimensions, with fractal octaves.
//
// Smooth F1 and the distance to the edge of a cell follow Quilez ("Smooth Voronoi", "Voronoi edges", iquilezles.org).
// One random point a unit cell; the cells' hash is Blender's, so that patterns coincide: it changed with Blender 5.
#pragma once

#include "shader/registers.h"

namespace opal {

struct Voronoi {
  int feature = OPAL_VORONOI_F1, metric = 0;
  float detail = 0, roughness = 0.5f, lacunarity = 2, smoothness = 1, exponent = 0.5f, randomness = 1;
  bool normalize = false;
  bool jenkins = false;  // the cells' hash of Blender 4; PCG since 5
};
struct VoronoiSample {
  float distance = 0;
  Vec3 color;
  Float4 position{};
  float radius = 0;
};
// `p` and `w` are the node's coordinates, `scale` its Scale socket.
VoronoiSample voronoi_texture(const Voronoi &settings, int dimensions, const Vec3 &p, float w, float scale);

}  // namespace opal
