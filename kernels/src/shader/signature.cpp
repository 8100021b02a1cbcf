// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader/signature.h"

#include <array>
#include <cstddef>

namespace opal {
namespace {

constexpr std::array<Signature, OPAL_OP_COUNT> table() {
  std::array<Signature, OPAL_OP_COUNT> t{};
  t[OPAL_OP_GREY] = {"Grey", 1, "r", 2};
  t[OPAL_OP_MATH] = {"Math", 1, "roo", OPAL_MATH_COUNT};
  t[OPAL_OP_VECTOR_MATH] = {"Vector Math", 1, "rooo", OPAL_VECTOR_COUNT};
  t[OPAL_OP_MIX] = {"Mix", 1, "rrri", OPAL_MIX_COUNT};
  t[OPAL_OP_MAP_RANGE] = {"Map Range", 1, "rrrrroi", OPAL_RANGE_COUNT};
  t[OPAL_OP_CLAMP] = {"Clamp", 1, "rrr", 2};
  t[OPAL_OP_MAPPING] = {"Mapping", 1, "rrrr", OPAL_MAPPING_COUNT};
  t[OPAL_OP_VECTOR_ROTATE] = {"Vector Rotate", 1, "rroooi", OPAL_ROTATE_COUNT};
  t[OPAL_OP_TRANSFORM] = {"Transform", 1, "rc", OPAL_TRANSFORM_COUNT};
  t[OPAL_OP_TO_OBJECT] = {"To Object", 1, "r", OPAL_TRANSFORM_PROJECT, false, true};
  t[OPAL_OP_TO_WORLD] = {"To World", 1, "r", OPAL_TRANSFORM_PROJECT, false, true};
  t[OPAL_OP_SEPARATE] = {"Separate", 1, "ri", OPAL_COLOR_COUNT};
  t[OPAL_OP_COMBINE] = {"Combine", 1, "rrr", OPAL_COLOR_COUNT};
  t[OPAL_OP_PACK] = {"Pack", 1, "rroo", 2};

  t[OPAL_OP_HUE_SATURATION] = {"Hue/Saturation/Value", 1, "rrrrr"};
  t[OPAL_OP_INVERT] = {"Invert", 1, "rr"};
  t[OPAL_OP_GAMMA] = {"Gamma", 1, "rr"};
  t[OPAL_OP_BRIGHT_CONTRAST] = {"Brightness/Contrast", 1, "rrr"};
  t[OPAL_OP_TABLE] = {"Table", 1, "rci", 8};

  t[OPAL_OP_COORDINATE] = {"Texture Coordinate", 1, "", OPAL_COORDINATE_COUNT, false, true};
  t[OPAL_OP_ATTRIBUTE] = {"Attribute", 1, "io", OPAL_ATTRIBUTE_COUNT, false, true};
  t[OPAL_OP_GEOMETRY] = {"Geometry", 1, "", OPAL_GEOMETRY_COUNT, false, true};
  t[OPAL_OP_OBJECT_INFO] = {"Object Info", 1, "", OPAL_OBJECT_COUNT, false, true};
  t[OPAL_OP_LIGHT_PATH] = {"Light Path", 1, "", OPAL_PATH_COUNT, false, true};
  t[OPAL_OP_FRESNEL] = {"Fresnel", 1, "ro", 1, false, true};
  t[OPAL_OP_LAYER_WEIGHT] = {"Layer Weight", 1, "ro", 2, false, true};
  t[OPAL_OP_NORMAL_MAP] = {"Normal Map", 1, "rrii", OPAL_NORMAL_COUNT, false, true};
  t[OPAL_OP_BUMP] = {"Bump", 1, "rrrooi", 1, false, true};
  t[OPAL_OP_TANGENT] = {"Tangent", 1, "i", 4, false, true};

  t[OPAL_OP_IMAGE] = {"Image", 1, "rmiiioci", OPAL_PROJECT_COUNT, false, true};
  t[OPAL_OP_CHECKER] = {"Checker", 2, "rrrr"};
  t[OPAL_OP_NOISE] = {"Noise", 2, "rrrrrrrrrii", OPAL_NOISE_COUNT};
  t[OPAL_OP_VORONOI] = {"Voronoi", 4, "rrrrrrrrriiii", OPAL_VORONOI_COUNT};
  t[OPAL_OP_WAVE] = {"Wave", 1, "rrrrrrriii"};
  t[OPAL_OP_MAGIC] = {"Magic", 2, "rrri"};
  t[OPAL_OP_BRICK] = {"Brick", 2, "rrrrrrrrrrc"};
  t[OPAL_OP_GRADIENT] = {"Gradient", 1, "r", OPAL_GRADIENT_COUNT};
  t[OPAL_OP_WHITE_NOISE] = {"White Noise", 2, "rri"};

  t[OPAL_OP_DIFFUSE] = {"Diffuse BSDF", 0, "orro", 1, true};
  t[OPAL_OP_TRANSLUCENT] = {"Translucent BSDF", 0, "oro", 1, true};
  t[OPAL_OP_GLOSSY] = {"Glossy BSDF", 0, "orrrrooi", 1, true};
  t[OPAL_OP_METALLIC] = {"Metallic BSDF", 0, "orrrrrooi", 2, true};
  t[OPAL_OP_GLASS] = {"Glass BSDF", 0, "orrroi", 1, true};
  t[OPAL_OP_REFRACTION] = {"Refraction BSDF", 0, "orrro", 1, true};
  t[OPAL_OP_TRANSPARENT] = {"Transparent BSDF", 0, "or", 1, true};
  t[OPAL_OP_SHEEN] = {"Sheen BSDF", 0, "orro", 1, true};
  t[OPAL_OP_EMISSION] = {"Emission", 0, "orr", 1, true};
  t[OPAL_OP_HOLDOUT] = {"Holdout", 0, "o", 1, true};
  t[OPAL_OP_PRINCIPLED] = {"Principled BSDF", 0, "orooorrrrrrrr", 2, true};
  return t;
}
constexpr auto kTable = table();

}  // namespace

const Signature &signature(int op) {
  static constexpr Signature kNone{};
  return op >= 0 && op < OPAL_OP_COUNT ? kTable[std::size_t(op)] : kNone;
}

int constants_read(const opal_instruction &instruction, int i) {
  switch (instruction.op) {
    case OPAL_OP_TRANSFORM: return 3;
    case OPAL_OP_BRICK: return 1;
    default: return instruction.in[i + 1];  // a table or tiles: the length follows
  }
}

}  // namespace opal
