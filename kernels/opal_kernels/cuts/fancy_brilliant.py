# SPDX-License-Identifier: GPL-3.0-or-later
"""Brilliants of other outlines: oval, cushion, pear, marquise, trillion.

The round brilliant's plan, hung on the stations of an outline: one bezel and one main a station, one star and two upper and two lower
halves a pair of neighbours, so 7K + 1 facets from K stations (57 from eight). Heights and depths are those of the width (`crown_angle` and
`pavilion_angle` hold where the outline is half a width from the axis) and facets farther out are flatter, as in a stretched round stone.
Proportions follow the trade's ranges (PHYSICS §2.3: diamondcuttersintl.com; mydiamondcuts.com); no standard fixes them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from . import outline as outlines
from .outline import Junction, Outline, Station, junction
from .stone import FacetPlanes, Stone, check_fraction


@dataclass(frozen=True)
class Plan:
    """Heights of a brilliant-type cut, fractions of the width, and how far its stars and lower halves reach."""

    table: float
    crown_height: float
    pavilion_depth: float
    girdle: float
    star_length: float
    lower_half_length: float
    culet: float

    @classmethod
    def from_angles(
        cls,
        table: float,
        crown_angle: float,
        pavilion_angle: float,
        girdle: float,
        star_length: float,
        lower_half_length: float,
        culet: float,
    ) -> Plan:
        """From the angles (radians) that facets half a width from the axis have."""
        check_fraction("table", table, 0.2, 0.9)
        check_fraction("crown_angle", crown_angle, math.radians(5), math.radians(70))
        check_fraction("pavilion_angle", pavilion_angle, math.radians(5), math.radians(70))
        check_fraction("girdle", girdle, 0.0, 0.5)
        check_fraction("star_length", star_length, 0.05, 0.95)
        check_fraction("lower_half_length", lower_half_length, 0.05, 0.95)
        check_fraction("culet", culet, 0.0, 0.5)
        crown, pavilion = 0.5 * (1.0 - table) * math.tan(crown_angle), 0.5 * math.tan(pavilion_angle)
        return cls(table, crown, pavilion, girdle, star_length, lower_half_length, culet)

    @property
    def top(self) -> float:
        """Height of the girdle's upper edge at a station."""
        return 0.5 * self.girdle

    def add_table_and_culet(self, facets: FacetPlanes) -> None:
        """The two horizontal facets."""
        facets.through("table", (0.0, 0.0, 1.0), (0.0, 0.0, self.top + self.crown_height))
        if self.culet > 0.0:
            facets.through("culet", (0.0, 0.0, -1.0), (0.0, 0.0, -self.top - self.pavilion_depth * (1.0 - self.culet)))

    def add_station(self, facets: FacetPlanes, station: Station) -> None:
        """A bezel from the girdle to the table and a main from the girdle to the point below the axis."""
        reach = station.reach
        run = reach * (1.0 - self.table)
        facets.through("bezel", (*(station.normal * self.crown_height), run), (*station.point, self.top))
        facets.through("main", (*(station.normal * self.pavilion_depth), -reach), (*station.point, -self.top))

    def add_star(self, facets: FacetPlanes, a: Station, b: Station, between: Junction) -> None:
        """A star hung on two table corners and the end of the bezels' ridge."""
        height = self.top + self.crown_height
        corners = [(*(self.table * s.point), height) for s in (a, b)]
        facets.through_points("star", *corners, self.star_tip(between))

    def add_half(self, facets: FacetPlanes, station: Station, between: Junction) -> None:
        """The upper and the lower half between a station and a junction beside it."""
        for name, height, tip in (("upper half", self.top, self.star_tip(between)), ("lower half", -self.top, self.half_tip(between))):
            facets.through_points(name, (*station.point, height), (*(between.girdle * between.direction), height), tip)

    def star_tip(self, between: Junction) -> np.ndarray:
        """The point on the ridge between two bezels where the star and two upper halves meet."""
        edge = self.table * between.chord
        distance = edge + self.star_length * (between.girdle - edge)
        share = distance / between.meeting
        if share <= self.table:
            raise ValueError("star_length is too short for this outline: the stars would lie above the table")
        return np.array((*(distance * between.direction), self.top + self.crown_height * (1.0 - share) / (1.0 - self.table)))

    def half_tip(self, between: Junction) -> np.ndarray:
        """The point on the ridge between two mains where two lower halves meet."""
        distance = between.girdle * (1.0 - self.lower_half_length)
        return np.array((*(distance * between.direction), -self.top - self.pavilion_depth * (1.0 - distance / between.meeting)))


def add_girdle(facets: FacetPlanes, edges: Iterable[tuple[np.ndarray, np.ndarray]]) -> None:
    """One upright facet an edge of the outline."""
    for a, b in edges:
        facets.through("girdle", (b[1] - a[1], a[0] - b[0], 0.0), (*a, 0.0))


def brilliant_on(outline: Outline, plan: Plan) -> Stone:
    """Cut a brilliant on a closed convex outline."""
    facets = FacetPlanes()
    plan.add_table_and_culet(facets)
    for a, b in zip(outline.stations, outline.stations[1:] + outline.stations[:1], strict=True):
        between = junction(a, b, outline.points)
        plan.add_station(facets, a)
        plan.add_star(facets, a, b, between)
        plan.add_half(facets, a, between)
        plan.add_half(facets, b, between)
    add_girdle(facets, zip(outline.points, np.roll(outline.points, -1, axis=0), strict=True))
    return facets.cut()


def oval(
    *,
    ratio: float = 1.4,
    table: float = 0.56,
    crown_angle: float = math.radians(34.5),
    pavilion_angle: float = math.radians(40.75),
    girdle: float = 0.03,
    star_length: float = 0.5,
    lower_half_length: float = 0.77,
    culet: float = 0.0,
) -> Stone:
    """An oval brilliant: the round one stretched to `ratio` times its width; angles in radians."""
    check_fraction("ratio", ratio, 1.0, 2.0)
    return brilliant_on(
        outlines.ellipse(ratio), Plan.from_angles(table, crown_angle, pavilion_angle, girdle, star_length, lower_half_length, culet)
    )


def cushion(
    *,
    ratio: float = 1.05,
    table: float = 0.60,
    crown_angle: float = math.radians(36.0),
    pavilion_angle: float = math.radians(42.0),
    girdle: float = 0.04,
    star_length: float = 0.5,
    lower_half_length: float = 0.75,
    culet: float = 0.0,
) -> Stone:
    """A cushion: a brilliant on a square or rectangle with round sides and corners; angles in radians."""
    check_fraction("ratio", ratio, 1.0, 1.6)
    return brilliant_on(
        outlines.cushion(ratio), Plan.from_angles(table, crown_angle, pavilion_angle, girdle, star_length, lower_half_length, culet)
    )


def pear(
    *,
    ratio: float = 1.55,
    table: float = 0.56,
    crown_angle: float = math.radians(34.5),
    pavilion_angle: float = math.radians(40.75),
    girdle: float = 0.035,
    star_length: float = 0.5,
    lower_half_length: float = 0.75,
    culet: float = 0.0,
) -> Stone:
    """A pear brilliant, its tip at +x and its culet under the round end's centre; angles in radians."""
    check_fraction("ratio", ratio, 1.15, 2.2)
    return brilliant_on(
        outlines.pear(ratio), Plan.from_angles(table, crown_angle, pavilion_angle, girdle, star_length, lower_half_length, culet)
    )


def marquise(
    *,
    ratio: float = 2.0,
    table: float = 0.56,
    crown_angle: float = math.radians(34.5),
    pavilion_angle: float = math.radians(40.75),
    girdle: float = 0.035,
    star_length: float = 0.5,
    lower_half_length: float = 0.75,
    culet: float = 0.0,
) -> Stone:
    """A marquise brilliant, its tips at ±x; angles in radians."""
    check_fraction("ratio", ratio, 1.3, 2.6)
    return brilliant_on(
        outlines.marquise(ratio), Plan.from_angles(table, crown_angle, pavilion_angle, girdle, star_length, lower_half_length, culet)
    )


def trillion(
    *,
    bulge: float = 0.10,
    table: float = 0.55,
    crown_angle: float = math.radians(34.0),
    pavilion_angle: float = math.radians(40.0),
    girdle: float = 0.035,
    star_length: float = 0.5,
    lower_half_length: float = 0.75,
    culet: float = 0.0,
) -> Stone:
    """A trillion: six stations on a round-sided triangle, 43 facets; angles in radians, `bulge` the sides' height over their chords."""
    check_fraction("bulge", bulge, 0.04, 0.13)
    return brilliant_on(
        outlines.trillion(bulge), Plan.from_angles(table, crown_angle, pavilion_angle, girdle, star_length, lower_half_length, culet)
    )
