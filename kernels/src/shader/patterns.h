// SPDX-License-Identifier: GPL-3.0-or-later
// The procedural textures that need no random numbers: Checker, Wave, Magic, Brick (its bricks' tint apart), Gradient.
#pragma once

#include "core/vec.h"
#include "opal_shader.h"

namespace opal {

// Whether the first colour shows at p.
bool checker(const Vec3 &p);

struct Wave {
  bool rings = false;
  int direction = 0, profile = 0;
  float distortion = 0, detail = 2, detail_scale = 1, detail_roughness = 0.5f, phase = 0;
};
float wave(const Wave &wave, const Vec3 &p);

Vec3 magic(const Vec3 &p, int depth, float distortion);

struct Brick {
  float mortar_size, mortar_smooth, bias, width, row_height, offset, squash;
  int offset_frequency, squash_frequency;
};
// tint: 0 the first colour .. 1 the second; mortar: 0 brick .. 1 mortar.
struct BrickSample {
  float tint, mortar;
};
BrickSample brick(const Brick &b, const Vec3 &p);

float gradient(int mode, const Vec3 &p);

}  // namespace opal
