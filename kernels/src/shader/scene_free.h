// SPDX-License-Identifier: GPL-3.0-or-later
// Running programs without a scene: images are mid-grey there and coordinates are invented.
#pragma once

#include "shader/shader.h"

namespace opal {

// The input of a Bump instruction that holds its number among Program::heights.
inline constexpr int kBumpHeight = 12;

// What the program emits on average, from a few made-up points; exact where the emission is constant.
Vec3 estimate_emission(const Program &program);

}  // namespace opal
