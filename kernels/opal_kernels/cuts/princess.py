# SPDX-License-Identifier: GPL-3.0-or-later
"""The princess: a square stone whose pavilion is nested chevrons.

Ribs run from the four corners to the culet. A chevron is a pair of facets on each side of the square, turned away from each other
(more from chevron to chevron) and hung on one piece of the rib, so that eight facets make a row and rows meet on the ribs. The
crown has a kite on each corner, a star on each of the table's sides and two upper halves under each star; the sides bow out by one
part in a hundred, which gives each its two halves. Facets: 17 above, 8 a chevron below; four chevrons make 49, and 50 with the culet.

Proportions: table 67–72 %, depth 65–75 %, length over width up to 1.05 (PHYSICS §2.3). The trade cuts many variants; where ribs
divide and how chevrons turn is our own choice.
"""

from __future__ import annotations

import math

import numpy as np

from .fancy_brilliant import add_girdle
from .outline import Outline, Station, junction
from .stone import FacetPlanes, Stone, check_fraction

BOW = 0.01
"""Height of the sides' arcs over their chords, in widths."""
BULGE = 0.1
"""How far, in crown heights, the crown stands out over straight lines from table to girdle: what makes stars flatter than halves."""


def princess(
    *,
    table: float = 0.69,
    crown_angle: float = math.radians(33.0),
    pavilion_depth: float = 0.56,
    chevrons: int = 4,
    girdle: float = 0.025,
    star_length: float = 0.5,
    culet: float = 0.0,
) -> Stone:
    """A princess cut.

    Parameters
    ----------
    table, girdle, star_length, culet : float
        As for a brilliant, fractions of the width.
    crown_angle : float
        Of the line from the table's edge to the girdle, seen along a side, radians.
    pavilion_depth : float
        From girdle to culet, fraction of the width.
    chevrons : int
        Rows of eight facets below the girdle, 2 to 5.
    """
    check_fraction("pavilion_depth", pavilion_depth, 0.3, 0.8)
    if chevrons not in range(2, 6):
        raise ValueError(f"chevrons must be 2 to 5, not {chevrons!r}")
    check_fraction("table", table, 0.3, 0.85)
    check_fraction("crown_angle", crown_angle, math.radians(10), math.radians(60))
    check_fraction("girdle", girdle, 0.0, 0.3)
    check_fraction("star_length", star_length, 0.2, 0.8)
    outline = _bowed_square()
    top, crown_height = 0.5 * girdle, 0.5 * (1.0 - table) * math.tan(crown_angle)

    facets = FacetPlanes()
    facets.through("table", (0.0, 0.0, 1.0), (0.0, 0.0, top + crown_height))
    for a, b in zip(outline.stations, outline.stations[1:] + outline.stations[:1], strict=True):
        facets.through("bezel", (*(a.normal * crown_height), a.reach * (1.0 - table)), (*a.point, top))
        between = junction(a, b, outline.points)
        middle = between.girdle * between.direction
        edge = table * between.chord
        reach = edge + star_length * (between.girdle - edge)
        star_tip = np.array((*(reach * between.direction), top + crown_height * (1.0 - star_length + BULGE)))
        facets.through_points("star", *((*(table * s.point), top + crown_height) for s in (a, b)), star_tip)
        for corner in (a, b):
            facets.through_points("upper half", (*corner.point, top), (*middle, top), star_tip)
            _add_chevrons(facets, corner, middle, -top, pavilion_depth, chevrons)
    add_girdle(facets, zip(outline.points, np.roll(outline.points, -1, axis=0), strict=True))
    if culet > 0.0:
        check_fraction("culet", culet, 0.0, 0.3)
        facets.through("culet", (0.0, 0.0, -1.0), (0.0, 0.0, -top - pavilion_depth * (1.0 - culet)))
    return facets.cut()


def _add_chevrons(facets: FacetPlanes, corner: Station, middle: np.ndarray, height: float, depth: float, count: int) -> None:
    """The facets of half a side: from its corner to its middle, row under row down the rib."""
    # Ribs bend in at equal steps, and their slopes fall evenly to the last.
    slopes = np.linspace(1.55, 1.0, count)
    heights = height - depth * np.concatenate(((0.0,), np.cumsum(slopes) / slopes.sum()))
    reaches = np.linspace(1.0, 0.0, count + 1)
    ribs = [np.array((*(reach * corner.point), z)) for reach, z in zip(reaches, heights, strict=True)]
    facets.through_points("chevron 1", ribs[0], (*middle, height), ribs[1])
    side, towards = middle / np.linalg.norm(middle), corner.point - middle
    towards = towards - (towards @ side) * side
    towards /= np.linalg.norm(towards)
    for row in range(1, count):
        azimuth = math.radians(20.0 * row / count)
        facing = math.cos(azimuth) * side + math.sin(azimuth) * towards
        fall = ribs[row] - ribs[row + 1]
        facets.through(f"chevron {row + 1}", (*(facing * fall[2]), -(facing @ fall[:2])), ribs[row])


def _bowed_square(segments: int = 8) -> Outline:
    """A square with sides that are arcs of height `BOW`, width 1, stations on its corners."""
    half = 0.5 - BOW
    radius = (half * half + BOW * BOW) / (2.0 * BOW)
    opening = math.asin(half / radius)
    points, stations = [], []
    for turn in math.tau * np.arange(4) / 4:
        angles = turn + opening * (2.0 * np.arange(segments) / segments - 1.0)
        centre = (0.5 - radius) * np.array((math.cos(turn), math.sin(turn)))
        points.append(centre + radius * np.stack((np.cos(angles), np.sin(angles)), axis=1))
        out = np.array((math.cos(turn + math.pi / 4), math.sin(turn + math.pi / 4)))
        stations.append(Station(half * math.sqrt(2.0) * out, out))
    return Outline(np.concatenate(points), tuple(stations))
