// SPDX-License-Identifier: GPL-3.0-or-later
// Four floats: the value of one register, and the register file of a running program.
#pragma once

#include "core/vec.h"
#include "opal.h"
#include "opal_shader.h"

namespace opal {

struct alignas(16) Float4 {
  float x, y, z, w;  // uninitialised unless asked for: a register file is large

  constexpr Vec3 xyz() const { return {x, y, z}; }
  constexpr float operator[](int i) const { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
};

constexpr Float4 number(float s) { return {s, s, s, s}; }
constexpr Float4 vector(const Vec3 &v, float w = 0) { return {v.x, v.y, v.z, w}; }
constexpr Float4 operator+(const Float4 &a, const Float4 &b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
constexpr Float4 operator-(const Float4 &a, const Float4 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
constexpr Float4 operator*(const Float4 &a, float s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }
constexpr Float4 operator*(float s, const Float4 &a) { return a * s; }

// Where an instruction finds what it reads. Constants come first in the numbering of registers.
struct Registers {
  const Float4 *constants;
  int n_constants;
  Float4 *variables;

  const Float4 &operator[](int32_t i) const { return i < n_constants ? constants[i] : variables[i - n_constants]; }
  Float4 &write(int32_t i) const { return variables[i - n_constants]; }
  float scalar(int32_t i) const { return (*this)[i].x; }
  float scalar(int32_t i, float fallback) const { return i < 0 ? fallback : (*this)[i].x; }
  Vec3 xyz(int32_t i) const { return (*this)[i].xyz(); }
  Vec3 xyz(int32_t i, const Vec3 &fallback) const { return i < 0 ? fallback : (*this)[i].xyz(); }
};

}  // namespace opal
