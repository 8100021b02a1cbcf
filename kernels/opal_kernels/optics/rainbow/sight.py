# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a bow stands for an eye: opposite the sun, and so high as the sun leaves room.

The primary bow is a circle of about 42 degrees round the antisolar point, which lies as far under the horizon as the sun stands
above it: the bow's top has the elevation 42 degrees minus the sun's. Azimuths here are from +Y (north) towards +X (east), as maps
have them; +Z is up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

PRIMARY_RAD = np.radians(42.0)
SECONDARY_RAD = np.radians(51.0)
_STEPS = 720


@dataclass(frozen=True)
class View:
    """How a camera looks.

    Attributes
    ----------
    axes : array (3, 3)
        Columns: right, up and back of the camera in the world.
    window : tuple of 4 floats
        Left, right, bottom, top at distance 1.
    """

    axes: np.ndarray
    window: tuple[float, float, float, float]

    @classmethod
    def of(cls, camera: Any) -> View:
        """The view of a `descriptions.Camera`."""
        axes = np.asarray(camera.transform, float)[:3, :3]
        window = tuple(float(v) for v in camera.window)
        return cls(axes / np.linalg.norm(axes, axis=0), window if camera.type == 0 else (-0.01, 0.01, -0.01, 0.01))

    @property
    def forward(self) -> np.ndarray:
        return -self.axes[:, 2]

    def sees(self, directions: np.ndarray) -> np.ndarray:
        """Whether each direction (n, 3) lies in the frame."""
        right, up, depth = (np.asarray(directions, float) @ self.axes * [1, 1, -1]).T
        ahead = depth > 1e-6
        safe = np.where(ahead, depth, 1.0)
        left, right_edge, bottom, top = self.window
        return ahead & (right / safe >= left) & (right / safe <= right_edge) & (up / safe >= bottom) & (up / safe <= top)


def circle(sun: np.ndarray, radius_rad: float = PRIMARY_RAD) -> np.ndarray:
    """Return directions (n, 3) to a bow of this radius, all round, from its top on.

    Parameters
    ----------
    sun : array (3,)
        Unit vector towards the sun.
    """
    anti = -np.asarray(sun, float)
    up = np.array([0.0, 0.0, 1.0]) - anti[2] * anti
    if np.linalg.norm(up) < 1e-6:  # the sun in the zenith or the nadir: any meridian will do
        up = np.array([0.0, 1.0, 0.0])
    up /= np.linalg.norm(up)
    side = np.cross(anti, up)
    clock = np.linspace(0, 2 * np.pi, _STEPS, endpoint=False)[:, None]
    return np.cos(radius_rad) * anti + np.sin(radius_rad) * (np.cos(clock) * up + np.sin(clock) * side)


def elevation(direction: np.ndarray) -> float:
    """Return the height over the horizon of a direction, radians."""
    return float(np.arcsin(np.clip(direction[2] / np.linalg.norm(direction), -1, 1)))


def top_elevation(sun: np.ndarray, radius_rad: float = PRIMARY_RAD) -> float:
    """Return the height of the bow's top over the horizon, radians: its radius minus the sun's height."""
    return radius_rad - elevation(sun)


def azimuth(direction: np.ndarray) -> float:
    """Return the azimuth of a direction, radians in [0, 2 pi), from +Y towards +X."""
    return float(np.arctan2(direction[0], direction[1]) % (2 * np.pi))


def visible(sun: np.ndarray, view: View, lowest_rad: float = -np.pi / 2) -> bool:
    """Whether a part of the primary bow lies in the frame, not under an elevation, where the ground hides the drops."""
    bow = circle(sun)
    return bool((view.sees(bow) & (bow[:, 2] >= np.sin(lowest_rad))).any())


def where_to_look(sun: np.ndarray) -> str:
    """Return where the bow's top stands, as the end of a sentence."""
    anti = -np.asarray(sun, float)
    return f"azimuth {np.degrees(azimuth(anti)):.0f}° (from +Y towards +X), elevation {np.degrees(top_elevation(sun)):.0f}°"


def warnings(suns: Sequence[np.ndarray], view: View, lamps: bool = False, lowest_rad: float = -np.pi / 2) -> list[str]:
    """Return why a camera in rain sees no bow, one sentence a reason; empty where it may see one.

    Parameters
    ----------
    suns : sequence of arrays (3,)
        Unit vectors towards the suns.
    view : View
    lamps : bool
        Whether other lamps light the drops: their bows are wherever the lamps put them, and nothing is said.
    lowest_rad : float
        Elevation under which the ground hides the drops.
    """
    if lamps:
        return []
    if not suns:
        return ["There is no sun in the scene: add a Sun lamp behind the camera, or the drops show no bow."]
    risen = [sun for sun in suns if elevation(sun) > -1e-3]
    if not risen:
        return ["The sun is below the horizon: drops over flat ground get none of its light and show no bow."]
    if any(visible(sun, view, lowest_rad) for sun in risen):
        return []
    sun = max(risen, key=lambda s: float(-s @ view.forward))
    if float(sun @ view.forward) > np.cos(np.radians(60)):
        return [f"The camera looks towards the sun and a bow stands opposite it: turn it to {where_to_look(sun)}."]
    if top_elevation(sun) < 0:
        height = np.degrees(elevation(sun))
        return [
            f"The sun stands {height:.0f}° high, above 42°, so the whole bow lies below the horizon: lower the sun, or look down from a height "
            f"to {where_to_look(sun)}."
        ]
    return [f"No bow is in the frame: the top of the bow stands at {where_to_look(sun)}."]


@dataclass(frozen=True)
class Curtain:
    """Where a wall of rain stands: its centre, its size (across, deep, high) and its turn about the vertical from facing -Y."""

    centre: tuple[float, float, float]
    size: tuple[float, float, float]
    turn: float


def curtain(
    suns: Sequence[np.ndarray], view: View | None, eye: Sequence[float], distance: float, depth: float, ground: float = 0.0
) -> Curtain:
    """Return a wall of rain opposite the sun that an eye looks at best, wide and high enough for both bows.

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
    risen = [sun for sun in suns if elevation(sun) > -1e-3]
    ahead = -max(risen, key=lambda s: float(-s @ forward)) if risen else forward
    flat = np.array([ahead[0], ahead[1]])
    if np.linalg.norm(flat) < 1e-6:
        flat = np.array([0.0, 1.0])
    flat /= np.linalg.norm(flat)
    far = distance + depth
    reach = far * np.tan(SECONDARY_RAD + np.radians(5))
    low = min(ground, eye[2] - 0.02 * far)
    high = eye[2] + reach
    centre = (eye[0] + flat[0] * (distance + depth / 2), eye[1] + flat[1] * (distance + depth / 2), (low + high) / 2)
    return Curtain(
        tuple(float(c) for c in centre), (float(2 * reach), float(depth), float(high - low)), float(np.arctan2(-flat[0], flat[1]))
    )
