// SPDX-License-Identifier: GPL-3.0-or-later
// Checking a program on its way in, and cutting out the parts that answer smaller questions.
#include "shader/scene_free.h"
#include "shader/shader.h"
#include "shader/signature.h"

#include <cstdio>
#include <cstring>

namespace opal {
namespace {

thread_local char message[256];

template <class... Args>
bool fail(const char **error, const char *format, Args... args) {
  std::snprintf(message, sizeof message, format, args...);
  if (error) *error = message;
  return false;
}

// Checks one instruction; `written` says which registers hold a value by now.
bool check(const opal_instruction &c, int index, int n_constants, int n_registers, int n_images, const float *constants,
           std::vector<bool> &written, const char **error) {
  const Signature &s = signature(c.op);
  if (!s.name) return fail(error, "instruction %d: there is no operation %d", index, c.op);
  if (c.mode < 0 || c.mode >= s.modes) return fail(error, "instruction %d (%s): there is no mode %d", index, s.name, c.mode);
  const int n_inputs = int(std::strlen(s.inputs));
  for (int i = 0; i < n_inputs; ++i) {
    const int32_t in = c.in[i];
    switch (s.inputs[i]) {
      case 'o':
        if (in == -1) break;
        [[fallthrough]];
      case 'r':
        if (in < 0 || in >= n_registers || !written[size_t(in)])
          return fail(error, "instruction %d (%s): input %d reads register %d, which nothing has written", index, s.name, i,
                      in);
        break;
      case 'm':
        if (in < -1 || in >= n_images) return fail(error, "instruction %d (%s): there is no image %d", index, s.name, in);
        break;
      case 'c': {
        const int count = constants_read(c, i);
        if (in == -1 && c.op == OPAL_OP_IMAGE) break;
        if (in < 0 || count < 1 || in > n_constants - count)
          return fail(error, "instruction %d (%s): constants %d to %d lie outside of the %d there are", index, s.name, in,
                      int(int64_t(in) + count - 1), n_constants);
        if (c.op == OPAL_OP_IMAGE)
          for (int k = in; k < in + count; ++k) {
            const float image = constants[4 * k + 1];
            if (!(image >= 0 && image < float(n_images)))
              return fail(error, "instruction %d (%s): tile %d has no image", index, s.name, k - in);
          }
        break;
      }
      default: break;
    }
  }
  if (s.outputs > 0) {
    if (c.out < n_constants || c.out > n_registers - s.outputs)
      return fail(error, "instruction %d (%s): it cannot write register %d", index, s.name, c.out);
    for (int i = 0; i < s.outputs; ++i) written[size_t(c.out + i)] = true;
  }
  return true;
}

// The instructions before `end` that matter to `needed` registers and to the instructions that `is_root` names, in order.
template <class IsRoot>
Program::Code slice(const Program::Code &code, size_t end, std::vector<bool> needed, IsRoot is_root) {
  std::vector<bool> keep(end, false);
  for (size_t k = end; k-- > 0;) {
    const opal_instruction &c = code[k];
    const Signature &s = signature(c.op);
    bool wanted = is_root(c);
    for (int i = 0; i < s.outputs; ++i) wanted = wanted || needed[size_t(c.out + i)];
    if (!wanted) continue;
    keep[k] = true;
    for (int i = 0; i < s.outputs; ++i) needed[size_t(c.out + i)] = false;
    for (int i = 0; s.inputs[i]; ++i)
      if ((s.inputs[i] == 'r' || s.inputs[i] == 'o') && c.in[i] >= 0) needed[size_t(c.in[i])] = true;
  }
  Program::Code out;
  for (size_t k = 0; k < end; ++k)
    if (keep[k]) out.push_back(code[k]);
  return out;
}

// Whether register `r`'s lane `lane` is a constant that equals `value`.
bool is_constant(const Program &p, int r, int lane, float value) {
  return r >= 0 && r < p.n_constants && p.constants[size_t(r) * 4 + size_t(lane)] == value;
}

bool weighs_nothing(const Program &p, const opal_instruction &c) {
  const int w = c.in[0];
  return is_constant(p, w, 0, 0) && is_constant(p, w, 1, 0) && is_constant(p, w, 2, 0);
}

bool emits(const Program &p, const opal_instruction &c) {
  if (weighs_nothing(p, c)) return false;
  const auto black = [&p](int r) { return is_constant(p, r, 0, 0) && is_constant(p, r, 1, 0) && is_constant(p, r, 2, 0); };
  if (c.op == OPAL_OP_EMISSION) return !is_constant(p, c.in[2], 0, 0) && !black(c.in[1]);
  return c.op == OPAL_OP_PRINCIPLED && !is_constant(p, c.in[8], 3, 0) && !black(c.in[8]);
}

bool lets_through(const Program &p, const opal_instruction &c) {
  if (weighs_nothing(p, c)) return false;
  return c.op == OPAL_OP_TRANSPARENT || (c.op == OPAL_OP_PRINCIPLED && !is_constant(p, c.in[9], 3, 1));
}

}  // namespace

bool program_from_desc(const opal_program &desc, int n_images, Program &out, const char **error) {
  if (desc.n_instructions < 0 || desc.n_instructions > OPAL_MAX_INSTRUCTIONS || (desc.n_instructions && !desc.code))
    return fail(error, "a program of %d instructions cannot be read", desc.n_instructions);
  if (desc.n_constants < 0 || desc.n_constants > OPAL_MAX_CONSTANTS || (desc.n_constants && !desc.constants))
    return fail(error, "a program with %d constants cannot be read", desc.n_constants);
  if (desc.n_registers < desc.n_constants || desc.n_registers - desc.n_constants > OPAL_MAX_REGISTERS)
    return fail(error, "a program with %d registers of which %d are constants cannot be read", desc.n_registers,
                desc.n_constants);

  Program p;
  p.n_constants = desc.n_constants, p.n_registers = desc.n_registers;
  if (desc.n_constants) p.constants.assign(desc.constants, desc.constants + size_t(desc.n_constants) * 4);
  if (desc.n_instructions) p.code.assign(desc.code, desc.code + desc.n_instructions);

  std::vector<bool> written(size_t(p.n_registers), false);
  for (int i = 0; i < p.n_constants; ++i) written[size_t(i)] = true;
  for (int i = 0; i < desc.n_instructions; ++i)
    if (!check(p.code[size_t(i)], i, p.n_constants, p.n_registers, n_images, p.constants.data(), written, error)) return false;

  const std::vector<bool> none(size_t(p.n_registers), false);
  for (size_t k = 0; k < p.code.size(); ++k) {
    if (p.code[k].op != OPAL_OP_BUMP) continue;
    std::vector<bool> height = none;
    height[size_t(p.code[k].in[0])] = true;
    p.code[k].in[kBumpHeight] = int32_t(p.heights.size());
    p.heights.push_back(slice(p.code, k, height, [](const opal_instruction &) { return false; }));
  }
  p.code = slice(p.code, p.code.size(), none,
                 [&p](const opal_instruction &c) { return signature(c.op).lobe && !weighs_nothing(p, c); });
  p.emission_code = slice(p.code, p.code.size(), none, [&p](const opal_instruction &c) { return emits(p, c); });
  p.transparency_code = slice(p.code, p.code.size(), none, [&p](const opal_instruction &c) { return lets_through(p, c); });

  p.constant_emission = true;
  for (const opal_instruction &c : p.emission_code)
    p.emission_of_layers |= c.op == OPAL_OP_PRINCIPLED && !(is_constant(p, c.in[6], 3, 0) && is_constant(p, c.in[7], 3, 0));
  for (const opal_instruction &c : p.emission_code)
    if (signature(c.op).of_the_point || p.emission_of_layers) p.constant_emission = false;
  p.emission = estimate_emission(p);
  out = std::move(p);
  return true;
}

}  // namespace opal
