// SPDX-License-Identifier: GPL-3.0-or-later
// What each operation reads and writes, as data: for checking programs and for following registers through them.
#pragma once

#include "opal.h"
#include "opal_shader.h"

namespace opal {

struct Signature {
  const char *name = nullptr;  // null: no such operation
  int outputs = 0;             // registers written from `out` on
  // One letter an input: r a register, o a register or -1, i an integer, c the first of some constants (or -1), m an image
  // (or -1).
  const char *inputs = "";
  int modes = 1;              // mode lies in 0 .. modes-1
  bool lobe = false;          // leaves a lobe behind
  bool of_the_point = false;  // depends on where it is run
};

const Signature &signature(int op);

// Number of constants behind input `i` of an instruction whose letter there is c.
int constants_read(const opal_instruction &instruction, int i);

}  // namespace opal
