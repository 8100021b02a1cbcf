# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that are none: drivers and scripts can set a property to NaN or to infinity, and its name is what helps to find it.

Blender turns infinity into the largest number of single precision where a property has limits.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

_ROTATIONS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}


def all_finite(values: Iterable[float]) -> bool:
    """Whether every value is a number to calculate with."""
    return all(map(math.isfinite, values))


def matrix_is_finite(matrix: Any) -> bool:
    """Whether every element of a matrix is."""
    return all(all_finite(row) for row in matrix)


def misplaced_by(obj: Any) -> str:
    """What of an object makes its matrix one that is not finite: the label of its own property, or what else places it."""
    own = (
        ("Location", obj.location),
        ("Rotation", getattr(obj, _ROTATIONS.get(obj.rotation_mode, "rotation_euler"))),
        ("Scale", obj.scale),
    )
    return next((label for label, values in own if not all_finite(values)), "parent, constraint or instancer")
