# SPDX-License-Identifier: GPL-3.0-or-later
"""A wall of rain opposite the sun, wide and high enough for the bows that an eye sees in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opal_kernels.optics.rainbow.sight import View, elevation

_REACH = np.radians(56.0)  # from the antisolar point: water's secondary with 5 degrees to spare
_WIDEST = np.radians(82.0)  # to either side of the wall's middle; a flat wall never spans a right angle


@dataclass(frozen=True)
class Curtain:
    """Where a wall of rain stands: its centre, its size (across, deep, high) and its turn about the vertical from facing -Y."""

    centre: tuple[float, float, float]
    size: tuple[float, float, float]
    turn: float


def curtain(
    suns: Sequence[np.ndarray], view: View | None, eye: Sequence[float], distance: float, depth: float, ground: float = 0.0
) -> Curtain:
    """Return a wall of rain opposite the sun that an eye looks at best, wide and high enough for both bows of every sun within 90° of it.

    Parameters
    ----------
    suns : sequence of arrays (3,)
        Unit vectors towards the suns; without one that is up the wall stands before the camera.
    view : View, optional
        None looks along +Y.
    eye : sequence of 3 floats
        Where the camera is, m.
    distance, depth : float
        To the wall's near side and through it, m.
    ground : float
        Height that the rain falls to, m; the wall ends below the eye in any case.
    """
    forward = np.array([0.0, 1.0, 0.0]) if view is None else view.forward
    ahead = [-np.asarray(sun, float) for sun in suns if elevation(sun) > -1e-3]
    best = max(ahead, key=lambda anti: float(anti @ forward)) if ahead else forward
    middle = np.arctan2(best[0], best[1]) if np.hypot(best[0], best[1]) > 1e-6 else 0.0
    others = [(np.arctan2(anti[0], anti[1]) - middle + np.pi) % (2 * np.pi) - np.pi for anti in ahead if np.hypot(*anti[:2]) > 1e-6]
    near = [0.0, *(turn for turn in others if abs(turn) <= np.pi / 2)]
    # Turned towards the others, as far as the best sun's own bows stay on the wall.
    turn = np.clip((min(near) + max(near)) / 2, _REACH - _WIDEST, _WIDEST - _REACH)
    half = min(_REACH + max(max(near) - turn, turn - min(near)), _WIDEST)
    middle += turn
    far = distance + depth
    low, high = min(ground, eye[2] - 0.02 * far), eye[2] + far * np.tan(_REACH)
    centre = (eye[0] + np.sin(middle) * (distance + depth / 2), eye[1] + np.cos(middle) * (distance + depth / 2), (low + high) / 2)
    return Curtain(tuple(float(c) for c in centre), (float(2 * far * np.tan(half)), float(depth), float(high - low)), float(-middle))
