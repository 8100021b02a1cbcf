# SPDX-License-Identifier: GPL-3.0-or-later
"""Where drops are, as far as an eye needs to know to find a bow in them: in boxes, or in all the air over the ground."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from opal_kernels.optics.rainbow.arcs import Arcs

_MOST_COPIES = 1000  # of one body; they stand for the rest
_FAINT = 0.01  # optical depth under which rain shows nothing
_LIT = 0.01  # share of the sun's light under which a lamp's bow is none; without a sun, of Blender's sun of 1 W/m2


@dataclass(frozen=True)
class Box:
    """A closed body of drops, by its box.

    Attributes
    ----------
    arcs : Arcs
        What the drops show.
    transforms : array (n, 3, 4)
        Box to world of each of its copies.
    low, high : array (3,)
        Corners of the box, in its own space.
    """

    arcs: Arcs
    transforms: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def _copies(self) -> Iterable[tuple[np.ndarray, np.ndarray]]:
        """Linear part and place of each copy that has an inside."""
        for matrix in np.asarray(self.transforms, float)[:_MOST_COPIES, :3]:
            if np.isfinite(matrix).all() and abs(np.linalg.det(matrix[:, :3])) > 0:
                yield matrix[:, :3], matrix[:, 3]

    def crossed(self, eye: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Whether a ray from the eye into each direction (n, 3) meets drops, (n,)."""
        met = np.zeros(len(directions), bool)
        for linear, place in self._copies():
            turned = np.linalg.solve(linear, np.column_stack([np.asarray(eye, float) - place, np.asarray(directions, float).T])).T
            start, along = turned[0], np.where(np.abs(turned[1:]) < 1e-300, 1e-300, turned[1:])
            with np.errstate(over="ignore"):
                ends = np.sort([(self.low - start) / along, (self.high - start) / along], axis=0)
            met |= ends[1].min(axis=1) >= np.maximum(ends[0].max(axis=1), 0.0)
        return met

    def lit(self, lamp: np.ndarray, watts: float, sun: float) -> bool:
        """Whether a lamp at a place makes a bow of its own in these drops: it is among or close to them, or outshines distance.

        Parameters
        ----------
        lamp : array (3,)
            World space, m.
        watts : float
            Blender's power of the lamp.
        sun : float
            Irradiance of the strongest sun, W/m².
        """
        for linear, place in self._copies():
            inside = np.clip(np.linalg.solve(linear, np.asarray(lamp, float) - place), self.low, self.high)
            distance = np.linalg.norm(linear @ inside + place - lamp)
            thickness = (np.linalg.norm(linear, axis=0) * (np.asarray(self.high) - self.low)).min()
            if distance <= thickness / 2 or watts >= 4 * np.pi * distance**2 * _LIT * sun:
                return True
        return False


@dataclass(frozen=True)
class Air:
    """Rain to the horizon.

    Attributes
    ----------
    arcs : Arcs
        What the drops show.
    extinction : float
        At the ground, 1/m.
    ground : float
        Height that the rain falls to, m.
    """

    arcs: Arcs
    extinction: float
    ground: float = 0.0

    def crossed(self, eye: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Whether a ray from the eye into each direction (n, 3) meets enough drops before the ground to see them, (n,)."""
        return (max(eye[2] - self.ground, 0.0) * self.extinction >= -directions[:, 2] * _FAINT) | (directions[:, 2] >= 0)

    def lit(self, _lamp: np.ndarray, _watts: float, _sun: float) -> bool:
        """A lamp lights what is close round it, and rain to the horizon hides that."""
        return False


class Lamps(IntEnum):
    """Lamps other than suns: whether there are any, and whether drops are lit by one."""

    NONE = 0
    FAR = 1
    NEAR = 2


def lamps(found: Sequence[tuple[np.ndarray, float]], regions: Sequence[Box | Air], sun: float = 0.0) -> Lamps:
    """Return what a scene's lamps are to its drops.

    Parameters
    ----------
    found : sequence of (array (3,), float)
        Place, m, and power, W, of each.
    regions : sequence of Box or Air
    sun : float
        Irradiance of the strongest sun that is up, W/m²; 0 where there is none.
    """
    sun = sun if sun > 0 else 1.0
    if any(region.lit(place, watts, sun) for place, watts in found for region in regions):
        return Lamps.NEAR
    return Lamps.FAR if found else Lamps.NONE
