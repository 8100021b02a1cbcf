# SPDX-License-Identifier: GPL-3.0-or-later
"""The Dutch rose: a flat base under a dome of 24 triangles.

Six star facets meet in a point; under each hangs a triangle that points to the girdle, and two more fill the gaps beside it: 6 + 6 + 12.
The girdle is the twelve-sided figure on which they stand.
"""

from __future__ import annotations

import math

import numpy as np

from .stone import FacetPlanes, Stone, check_fraction


def rose_cut(*, height: float = 0.45, star_height: float = 0.36, star_length: float = 0.55, girdle: float = 0.02) -> Stone:
    """A Dutch rose of diameter 1, corner to corner.

    Parameters
    ----------
    height : float
        Of the dome over the girdle.
    star_height : float
        Of the stars' lower corners over the girdle.
    star_length : float
        Their distance from the axis, fraction of the radius.
    girdle : float
        Thickness.
    """
    check_fraction("height", height, 0.1, 0.8)
    check_fraction("star_length", star_length, 0.2, 0.9)
    check_fraction("girdle", girdle, 0.001, 0.3)
    if not height * (1.0 - star_length) < star_height < height:
        raise ValueError(
            f"star_height must lie between {height * (1.0 - star_length):g} and {height:g} for a dome that bulges, not {star_height!r}"
        )
    top = 0.5 * girdle

    def at(distance: float, twelfths: float, z: float) -> np.ndarray:
        angle = math.tau * twelfths / 12
        return np.array((distance * math.cos(angle), distance * math.sin(angle), z))

    point, facets = at(0.0, 0, top + height), FacetPlanes()
    for i in range(0, 12, 2):
        left, right = (at(0.5 * star_length, i + side, top + star_height) for side in (1, -1))
        facets.through_points("star", point, left, right)
        facets.through_points("tooth", left, right, at(0.5, i, top))
        for side, corner in ((1, left), (-1, right)):
            facets.through_points("cross", corner, at(0.5, i, top), at(0.5, i + side, top))
    for i in range(12):
        facets.through("girdle", at(1.0, i + 0.5, 0.0), at(0.5, i, 0.0))
    facets.through("base", (0.0, 0.0, -1.0), (0.0, 0.0, -top))
    return facets.cut()
