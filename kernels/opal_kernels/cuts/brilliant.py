# SPDX-License-Identifier: GPL-3.0-or-later
"""The round brilliant: 57 facets, 58 with a culet, and the girdle.

One table, 8 stars, 8 bezels and 16 upper halves above the girdle; 16 lower halves and 8 pavilion mains below it. Proportions are
fractions of the girdle's diameter as the trade gives them; the defaults are Tolkowsky's of 1919 (*Diamond Design*, folds.net/diamond_design):
table 53 %, crown 34.5°, pavilion 40.75°, to which the modern cut adds star and half lengths and a girdle that light can enter.

The cut is drawn by points, and planes go through the points: table corners lie over the bezels' lower tips, the bezels' side corners on the
rays halfway between, and the halves hang on three points each. So every facet meets its neighbours exactly where a cutter wants it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .stone import FacetPlanes, Stone, check_fraction


@dataclass(frozen=True)
class BrilliantProportions:
    """What a grading report says of a round brilliant.

    Attributes
    ----------
    table : float
        Corner to corner, fraction of the girdle's diameter.
    crown_angle, pavilion_angle : float
        Of bezels and mains with the girdle plane, radians.
    girdle : float
        Thickness where it is greatest, at the bezels. Below about 0.018 the scallops of the halves touch.
    star_length : float
        How far the stars reach from the table's edge to the girdle, seen from above.
    lower_half_length : float
        How far the lower halves reach from the girdle to the culet, seen from below.
    culet : float
        Corner to corner; 0 for a point.
    girdle_facets : int
        Sides of the girdle, a multiple of 16; its corners lie on the girdle's circle.
    """

    table: float = 0.53
    crown_angle: float = math.radians(34.5)
    pavilion_angle: float = math.radians(40.75)
    girdle: float = 0.03
    star_length: float = 0.5
    lower_half_length: float = 0.77
    culet: float = 0.0
    girdle_facets: int = 96

    def __post_init__(self) -> None:
        check_fraction("table", self.table, 0.2, 0.9)
        check_fraction("crown_angle", self.crown_angle, math.radians(5), math.radians(70))
        check_fraction("pavilion_angle", self.pavilion_angle, math.radians(5), math.radians(70))
        check_fraction("girdle", self.girdle, 0.0, 0.5)
        check_fraction("star_length", self.star_length, 0.05, 0.95)
        check_fraction("lower_half_length", self.lower_half_length, 0.05, 0.95)
        check_fraction("culet", self.culet, 0.0, 0.5)
        if self.girdle_facets < 16 or self.girdle_facets % 16:
            raise ValueError(f"girdle_facets must be a multiple of 16, not {self.girdle_facets}")

    @property
    def crown_height(self) -> float:
        """From the girdle's upper edge at a bezel to the table."""
        return 0.5 * (1.0 - self.table) * math.tan(self.crown_angle)

    @property
    def pavilion_depth(self) -> float:
        """From the girdle's lower edge at a main to the point where the mains meet."""
        return 0.5 * math.tan(self.pavilion_angle)


def round_brilliant(proportions: BrilliantProportions | None = None) -> Stone:
    """Cut a round brilliant of diameter 1, table up, girdle about z = 0.

    Parameters
    ----------
    proportions : BrilliantProportions, optional
        Tolkowsky's with a 3 % girdle when left out.

    Returns
    -------
    Stone
        With facets named ``table``, ``star``, ``bezel``, ``upper half``, ``girdle``, ``lower half``, ``main`` and, if there is one,
        ``culet``.
    """
    p = proportions or BrilliantProportions()
    radius, eighth = 0.5, math.pi / 4.0
    top, bottom = 0.5 * p.girdle, -0.5 * p.girdle
    table_height = top + p.crown_height
    apex = np.array((0.0, 0.0, bottom - p.pavilion_depth))

    def at(distance: float, azimuth: float, height: float) -> np.ndarray:
        return np.array((distance * math.cos(azimuth), distance * math.sin(azimuth), height))

    # On the ray between two mains the bezels' ridge has fallen, and the mains' ridge risen, with the distance measured across the facet.
    between = math.cos(eighth / 2.0)
    table_edge = 0.5 * p.table * between
    star_tip = table_edge + p.star_length * (radius - table_edge)
    star_height = top + (radius - star_tip * between) * math.tan(p.crown_angle)
    half_tip = radius * (1.0 - p.lower_half_length)
    half_height = bottom - (radius - half_tip * between) * math.tan(p.pavilion_angle)

    facets = FacetPlanes()
    facets.through("table", (0.0, 0.0, 1.0), at(0.0, 0.0, table_height))
    for i in range(8):
        here, right, left = i * eighth, (i - 0.5) * eighth, (i + 0.5) * eighth
        upper, lower = at(radius, here, top), at(radius, here, bottom)
        facets.through("bezel", at(math.sin(p.crown_angle), here, math.cos(p.crown_angle)), upper)
        facets.through("main", at(math.sin(p.pavilion_angle), here, -math.cos(p.pavilion_angle)), lower)
        corner, next_corner = (at(0.5 * p.table, a, table_height) for a in (here, here + eighth))
        facets.through_points("star", corner, next_corner, at(star_tip, left, star_height))
        for side in (right, left):
            facets.through_points("upper half", upper, at(radius, side, top), at(star_tip, side, star_height))
            facets.through_points("lower half", lower, at(radius, side, bottom), at(half_tip, side, half_height))
    step = 2.0 * math.pi / p.girdle_facets
    for i in range(p.girdle_facets):
        facets.through("girdle", at(1.0, (i + 0.5) * step, 0.0), at(radius, i * step, 0.0))
    if p.culet > 0.0:
        facets.through("culet", (0.0, 0.0, -1.0), apex + at(0.0, 0.0, 0.5 * p.culet * between * math.tan(p.pavilion_angle)))
    return facets.cut()
