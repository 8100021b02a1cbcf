// SPDX-License-Identifier: GPL-3.0-or-later
// Running a material's register program at a point.
#pragma once

#include "bsdf/closure.h"
#include "opal.h"
#include "opal_shader.h"

#include <vector>

namespace opal {

struct Scene;

// A program as kept by the scene: the whole of it, and the parts of it that answer smaller questions, cut out by
// following registers backwards from the operations that matter.
struct Program {
  using Code = std::vector<opal_instruction>;

  Code code;
  Code emission_code;            // what the emission needs; empty: none is emitted
  Code transparency_code;        // what the straight-through transmittance needs; empty: opaque
  std::vector<Code> heights;     // of the Bump operations, by number (their last input)
  std::vector<float> constants;  // 4 floats a register
  int n_constants = 0, n_registers = 0;
  bool constant_emission = true;    // emission is the same everywhere
  Vec3 emission;                    // that value, or an estimate
  bool emission_of_layers = false;  // a Principled BSDF emits, under its coat and sheen
};

// Copies and checks a program: operations known, registers in range, images existing. On failure `error` says which
// instruction and why.
bool program_from_desc(const opal_program &desc, int n_images, Program &out, const char **error);

// Runs `program` at `sp` and fills `out` (count, emission, holdout, albedo). Never throws, never allocates.
void run_surface(const Scene &scene, const Program &program, const ShadingPoint &sp, ClosureSet &out);
// Only the straight-through transmittance, for shadow rays.
Vec3 run_transparency(const Scene &scene, const Program &program, const ShadingPoint &sp);
// Only the emission (lamps' faces, the world; for the world sp.mesh is null and sp.p = direction).
Vec3 run_emission(const Scene &scene, const Program &program, const ShadingPoint &sp);

}  // namespace opal
