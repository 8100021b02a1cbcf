# SPDX-License-Identifier: GPL-3.0-or-later
"""The simplest register programs, for scenes that are built by hand: one lobe each. Inside Blender, node trees are compiled.

Operations and the order of their operands are those of ``include/opal_shader.h``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .descriptions import Program

_OP_MATH, _OP_SEPARATE, _OP_COORDINATE = 1, 11, 40
_MATH_MULTIPLY, _MATH_LESS_THAN, _MATH_GREATER_THAN = 2, 13, 14
_COORDINATE_POSITION = 4
_OP_DIFFUSE, _OP_GLOSSY, _OP_EMISSION = 80, 82, 88
_NONE = -1


def diffuse(color: Sequence[float], roughness: float = 0.0) -> Program:
    """A matte surface: Lambert, or Oren and Nayar with a roughness. ``color``: linear Rec.709 reflectance."""
    return _one_lobe(_OP_DIFFUSE, [_NONE, 0, 1, _NONE], [color, roughness])


def mirror(color: Sequence[float] = (1.0, 1.0, 1.0), roughness: float = 0.0) -> Program:
    """A metal of this reflectance at every angle; give its material the flag `MaterialFlag.CASTER`."""
    return _one_lobe(_OP_GLOSSY, [_NONE, 0, 1, 2, 2, _NONE, _NONE, 0], [color, roughness, 0.0])


def emission(color: Sequence[float] = (1.0, 1.0, 1.0), strength: float = 1.0) -> Program:
    """Light of this radiance, both sides of a face or the whole world; a material of it needs `MaterialFlag.EMISSIVE`."""
    return _one_lobe(_OP_EMISSION, [_NONE, 0, 1], [color, strength])


def hemisphere(shadow_angle: float = 0.0, strength: float = 1.0) -> Program:
    """A world that is white above the horizon, but for a dark cone of this half angle (radians) about +z, and dark below."""
    constants = np.zeros((4, 4), np.float32)
    constants[0] = strength
    constants[1] = 0.0
    constants[2] = math.cos(shadow_angle) if shadow_angle > 0 else 2.0
    code = np.full((6, 16), _NONE, np.int32)
    direction, height, above, beside, both = range(4, 9)
    code[0, :3] = _OP_COORDINATE, _COORDINATE_POSITION, direction
    code[1, :3], code[1, 3:5] = (_OP_SEPARATE, 0, height), (direction, 2)
    code[2, :3], code[2, 3:5] = (_OP_MATH, _MATH_GREATER_THAN, above), (height, 1)
    code[3, :3], code[3, 3:5] = (_OP_MATH, _MATH_LESS_THAN, beside), (height, 2)
    code[4, :3], code[4, 3:5] = (_OP_MATH, _MATH_MULTIPLY, both), (above, beside)
    code[5, :3], code[5, 3:6] = (_OP_EMISSION, 0, _NONE), (_NONE, both, 0)
    return Program(code, constants, 9)


def _one_lobe(operation: int, operands: Sequence[int], constants: Sequence[Sequence[float] | float]) -> Program:
    code = np.full((1, 16), _NONE, np.int32)
    code[0, 0], code[0, 1] = operation, 0
    code[0, 3 : 3 + len(operands)] = operands
    values = np.zeros((len(constants), 4), np.float32)
    for row, constant in zip(values, constants, strict=True):
        if np.ndim(constant) == 0:
            row[:] = constant  # a number stands in all four lanes
        else:
            row[:3] = constant
    return Program(code, values, len(values))
