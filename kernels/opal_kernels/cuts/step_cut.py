# SPDX-License-Identifier: GPL-3.0-or-later
"""Step cuts: the emerald cut and the Asscher cut, three rows of long facets above and three below.

Every row is level, on an octagon: a rectangle with cut corners. From row to row the octagon shrinks towards a line, the keel, as long as
the stone is longer than wide, so that all eight sides live down to the bottom; there the two long sides meet in the keel, and the ends and
corners run out in its two ends. An Asscher is square and its keel is a point.

Facets: 8 · (rows above + rows below) + the table; the usual three and three make 49, and 57 with the girdle's eight.
Proportions: table 60–65.5 %, depth 60–65 %, corners 15–20 % of the width (PHYSICS §2.3: diamondcuttersintl.com).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .stone import FacetPlanes, Stone, check_fraction


def step_cut(
    ratio: float, corner: float, girdle: float, crown: Sequence[tuple[float, float]], pavilion: Sequence[tuple[float, float]]
) -> Stone:
    """A step cut from the profile of its long sides.

    Parameters
    ----------
    ratio : float
        Length over width, at least 1.
    corner : float
        How much of the width each cut corner takes.
    girdle : float
        Thickness, fraction of the width.
    crown, pavilion : sequence of (share, angle)
        Rows from the girdle on: what is left of the octagon's half width at the row's far edge, and the slope of the long sides, radians.
        Slopes must fall from row to row; the pavilion's last share is 0.

    Returns
    -------
    Stone
        With facets ``table``, ``crown 1`` …, ``girdle``, ``pavilion 1`` …
    """
    keel = 0.5 * (ratio - 1.0)
    cut = 0.5 - 0.5 * corner
    sides = []
    for x, y in ((1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 1.0), (-1.0, 0.0), (-1.0, -1.0), (0.0, -1.0), (1.0, -1.0)):
        normal = np.array((x, y)) / math.hypot(x, y)
        # Distance of the side from the keel's end on its own side: half the width, and for a corner half a diagonal less what is cut off.
        sides.append((normal, 0.5 if x * y == 0.0 else math.sqrt(2.0) * cut, np.array((math.copysign(keel, x) if x else 0.0, 0.0))))

    facets = FacetPlanes()
    for rows, name, sign in ((crown, "crown", 1.0), (pavilion, "pavilion", -1.0)):
        share, height = 1.0, sign * 0.5 * girdle
        for row, (next_share, angle) in enumerate(rows, start=1):
            drop = math.tan(angle)
            for normal, reach, end in sides:
                # Corners cover a different distance in the same height, so their slope follows from the sides'.
                facets.through(f"{name} {row}", (*(normal * drop), sign * reach / 0.5), (*(end + share * reach * normal), height))
            height += sign * 0.5 * (share - next_share) * drop
            share = next_share
        if share > 0.0:
            facets.through("table" if sign > 0 else "culet", (0.0, 0.0, sign), (0.0, 0.0, height))
    for normal, reach, end in sides:
        facets.through("girdle", (*normal, 0.0), (*(end + reach * normal), 0.0))
    return facets.cut()


def _rows(first: float, last: float, shares: Sequence[float]) -> list[tuple[float, float]]:
    """Rows whose slopes fall evenly from the first to the last."""
    return [(share, first + (last - first) * i / (len(shares) - 1)) for i, share in enumerate(shares)]


def _step(ratio: float, corner: float, table: float, crown_angle: float, pavilion_angle: float, girdle: float) -> Stone:
    check_fraction("corner", corner, 0.05, 0.55)
    check_fraction("table", table, 0.3, 0.85)
    check_fraction("crown_angle", crown_angle, math.radians(15), math.radians(60))
    check_fraction("pavilion_angle", pavilion_angle, math.radians(25), math.radians(60))
    check_fraction("girdle", girdle, 0.001, 0.5)
    crown = _rows(crown_angle + math.radians(8), crown_angle - math.radians(8), [1 - (1 - table) * i / 3 for i in (1, 2, 3)])
    pavilion = _rows(pavilion_angle + math.radians(10), pavilion_angle - math.radians(6), (0.72, 0.40, 0.0))
    return step_cut(ratio, corner, girdle, crown, pavilion)


def emerald_cut(
    *,
    ratio: float = 1.35,
    corner: float = 0.17,
    table: float = 0.62,
    crown_angle: float = math.radians(34.0),
    pavilion_angle: float = math.radians(42.5),
    girdle: float = 0.03,
) -> Stone:
    """An emerald cut; crown and pavilion angles (radians) are the middle row's, 8° more and less above, 10° more and 6° less below."""
    check_fraction("ratio", ratio, 1.0, 2.5)
    return _step(ratio, corner, table, crown_angle, pavilion_angle, girdle)


def asscher_cut(
    *,
    corner: float = 0.24,
    table: float = 0.58,
    crown_angle: float = math.radians(37.0),
    pavilion_angle: float = math.radians(43.0),
    girdle: float = 0.03,
) -> Stone:
    """An Asscher cut: a square emerald cut with large corners and a high crown; angles as there."""
    return _step(1.0, corner, table, crown_angle, pavilion_angle, girdle)
