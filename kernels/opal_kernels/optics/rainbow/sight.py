# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a bow stands for an eye: opposite the sun, and so high as the sun leaves room.

A bow is a circle round the antisolar point, which lies as far under the horizon as the sun stands above it: the top of water's primary has
the elevation 42 degrees minus the sun's. Which circles drops show is said by `arcs`, where the drops are by `rain_places`. Azimuths here are
from +Y (north) towards +X (east), as maps have them; +Z is up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from opal_kernels.descriptions import CameraType
from opal_kernels.optics.rainbow.arcs import Arcs
from opal_kernels.optics.rainbow.rain_places import Air, Box, Lamps

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
    eye : array (3,)
        Where it stands, m.
    parallel : bool
        Whether it looks in one direction all over the frame.
    """

    axes: np.ndarray
    window: tuple[float, float, float, float]
    eye: np.ndarray = field(default_factory=lambda: np.zeros(3))
    parallel: bool = False

    @classmethod
    def of(cls, camera: Any) -> View:
        """The view of a `descriptions.Camera`."""
        matrix = np.asarray(camera.transform, float)
        axes, window = matrix[:3, :3], tuple(float(v) for v in camera.window)
        return cls(axes / np.linalg.norm(axes, axis=0), window, matrix[:3, 3], camera.type == CameraType.ORTHOGRAPHIC)

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


def circle(sun: np.ndarray, radius_rad: float) -> np.ndarray:
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


def top_elevation(sun: np.ndarray, radius_rad: float) -> float:
    """Return the height of the bow's top over the horizon, radians: its radius minus the sun's height."""
    return radius_rad - elevation(sun)


def azimuth(direction: np.ndarray) -> float:
    """Return the azimuth of a direction, radians in [0, 2 pi), from +Y towards +X."""
    return float(np.arctan2(direction[0], direction[1]) % (2 * np.pi))


def visible(sun: np.ndarray, view: View, region: Box | Air, everywhere: bool = False) -> bool:
    """Whether a part of what the drops show under a sun lies in the frame, and drops are there (`everywhere`: or not)."""
    at = np.concatenate([circle(sun, radius) for radius in region.arcs.radii])
    at = at[view.sees(at)]
    return bool(len(at) and (everywhere or region.crossed(view.eye, at).any()))


def place(direction: np.ndarray) -> str:
    """Return where a direction points, as the end of a sentence."""
    turn, height = round(np.degrees(azimuth(direction))) % 360, round(np.degrees(elevation(direction)))
    return f"azimuth {turn}° (from +Y towards +X), elevation {height}°"


def where_to_look(sun: np.ndarray, arcs: Arcs) -> str:
    """Return where the top of the primary bow stands, or of the secondary where only that is over the horizon, as the end of a sentence."""
    radii = [radius for radius in (arcs.primary, arcs.secondary) if np.isfinite(radius)]
    if not radii:
        return place(-np.asarray(sun, float))
    radius = next((radius for radius in radii if top_elevation(sun, radius) >= 0), radii[0])
    anti = -np.asarray(sun, float)
    # Over the zenith the top of a wide bow lies on the sun's side: its height alone would be told wrongly.
    return place(circle(sun, radius)[0] if abs(anti[2]) < 1 - 1e-9 else anti)


def warnings(suns: Sequence[np.ndarray], view: View, regions: Sequence[Box | Air], lamps: Lamps = Lamps.NONE) -> list[str]:
    """Return why a camera in rain sees no bow, one sentence a reason; empty where it may see one.

    Parameters
    ----------
    suns : sequence of arrays (3,)
        Unit vectors towards the suns.
    view : View
    regions : sequence of Box or Air
        Where the drops are, at least one.
    lamps : Lamps
        What other lamps are to the drops; the bows of near ones are wherever the lamps put them, and nothing is said.
    """
    if lamps == Lamps.NEAR:
        return []
    alone = ", and lamps light only drops close to them" if lamps == Lamps.FAR else ""
    if not suns:
        return [f"There is no sun in the scene{alone}: add a Sun lamp behind the camera, or the drops show no bow."]
    risen = [sun for sun in suns if elevation(sun) > -1e-3]
    if not risen:
        return [f"The sun is below the horizon{alone}: drops over flat ground get none of its light and show no bow."]
    if view.parallel:
        return ["An orthographic camera looks in one direction all over the frame, where no bow can be: choose Perspective."]
    if any(visible(sun, view, region) for sun in risen for region in regions):
        return []
    sun = max(risen, key=lambda s: float(-s @ view.forward))
    return [_why_not(sun, view, regions)]


def _why_not(sun: np.ndarray, view: View, regions: Sequence[Box | Air]) -> str:
    """One sentence on a bow that is not in the frame."""
    arcs = regions[0].arcs
    where = where_to_look(sun, arcs)
    if arcs.glory:
        where += f"; the glory is at {place(-sun)}"
    if arcs.corona:
        where += f"; the corona is round the sun, at {place(sun)}"
    elif float(sun @ view.forward) > np.cos(np.radians(60)):
        return f"The camera looks towards the sun and a bow stands opposite it: turn it to {where}."
    widest = np.nanmax([arcs.primary, arcs.secondary, 0.0])
    if top_elevation(sun, widest) < 0:
        return (
            f"The sun stands {np.degrees(elevation(sun)):.0f}° high, above {np.degrees(widest):.0f}°, so every bow lies below the horizon: "
            f"lower the sun, or look down from a height to {where}."
        )
    which = "secondary bow" if not top_elevation(sun, arcs.primary) >= 0 else "bow"
    if any(visible(sun, view, region, everywhere=True) for region in regions):
        return f"The frame holds the place of a bow, but no drops are there: the top of the {which} stands at {where}."
    return f"No bow is in the frame: the top of the {which} stands at {where}."
