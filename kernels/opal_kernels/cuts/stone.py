# SPDX-License-Identifier: GPL-3.0-or-later
"""A cut stone and the list of facet planes it is cut from.

Convention: the table looks along +z, the girdle's middle plane is z = 0, x is the length and y the width of a stone that has both. Lengths
are fractions of the girdle's width (y extent), so a stone of width 1; `Stone.scaled` makes it real.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from .polyhedron import Polyhedron, intersect_half_spaces

CARAT = 2e-4
"""One metric carat in kilograms (General Conference on Weights and Measures, 1907)."""


@dataclass(frozen=True)
class Stone:
    """A cut gem: a closed surface whose faces know what a cutter calls them.

    Attributes
    ----------
    solid : Polyhedron
        The surface.
    names : tuple of str
        The facet name of each face, such as ``"table"`` or ``"girdle"``.
    """

    solid: Polyhedron
    names: tuple[str, ...]

    def counts(self) -> Counter[str]:
        """How many facets of each name there are."""
        return Counter(self.names)

    def facet_count(self) -> int:
        """Facets as the trade counts them: without the girdle."""
        return sum(name != "girdle" for name in self.names)

    def extent(self) -> np.ndarray:
        """Length, width and height, shape (3,)."""
        return np.ptp(self.solid.vertices, axis=0)

    def scaled(self, width: float) -> Stone:
        """The same stone at a real size.

        Parameters
        ----------
        width : float
            The girdle's y extent that the result has, in any unit; the result is in that unit.
        """
        factor = width / self.extent()[1]
        solid = Polyhedron(self.solid.vertices * factor, self.solid.faces, self.solid.planes)
        return Stone(solid, self.names)

    def carats(self, density: float) -> float:
        """Weight in carats of a stone in metres.

        Parameters
        ----------
        density : float
            In kg/m³; diamond has 3520.
        """
        return self.solid.volume() * density / CARAT


@dataclass
class FacetPlanes:
    """Named half-spaces, gathered in cutting order."""

    normals: list[np.ndarray] = field(default_factory=list)
    distances: list[float] = field(default_factory=list)
    names: list[str] = field(default_factory=list)

    def through(self, name: str, normal: np.ndarray, point: np.ndarray) -> None:
        """Add the plane with this outward normal through a point."""
        normal = np.asarray(normal, dtype=np.float64)
        normal = normal / np.linalg.norm(normal)
        self.normals.append(normal)
        self.distances.append(float(normal @ np.asarray(point, dtype=np.float64)))
        self.names.append(name)

    def through_points(self, name: str, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> None:
        """Add the plane through three points, turned so that the stone's axis at the girdle, the origin, is inside."""
        a, b, c = (np.asarray(point, dtype=np.float64) for point in (a, b, c))
        normal = np.cross(b - a, c - a)
        self.through(name, normal if normal @ a >= 0.0 else -normal, a)

    def cut(self, tolerance: float = 1e-9) -> Stone:
        """Intersect the half-spaces into a stone."""
        solid = intersect_half_spaces(np.array(self.normals), np.array(self.distances), tolerance)
        return Stone(solid, tuple(self.names[plane] for plane in solid.planes))


def check_fraction(name: str, value: float, low: float, high: float) -> None:
    """Refuse a proportion outside its range with a sentence."""
    if not (math.isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} must lie between {low:g} and {high:g}, not {value:.4g}")
