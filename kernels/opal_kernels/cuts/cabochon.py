# SPDX-License-Identifier: GPL-3.0-or-later
"""The cabochon: a smooth dome, half an ellipsoid, on a flat base.

The dome is a mesh whose corners lie on the ellipsoid; its quadrilaterals are planar, since an ellipsoid is a stretched surface of revolution.
Shade it smooth. Its volume is below that of the half ellipsoid, (2/3)π·(length/2)(width/2)·height, by a part of order 1/segments².
"""

from __future__ import annotations

import math

import numpy as np

from .polyhedron import Polyhedron
from .stone import Stone, check_fraction


def cabochon(*, ratio: float = 1.3, height: float = 0.45, girdle: float = 0.08, segments: int = 96, rings: int = 24) -> Stone:
    """A cabochon of width 1.

    Parameters
    ----------
    ratio : float
        Length over width.
    height : float
        Of the dome over the girdle, fraction of the width.
    girdle : float
        Thickness of the upright band under the dome.
    segments, rings : int
        Corners round the stone and steps from girdle to top.
    """
    check_fraction("ratio", ratio, 1.0, 3.0)
    check_fraction("height", height, 0.05, 1.5)
    check_fraction("girdle", girdle, 0.001, 0.5)
    if segments < 8 or segments % 4 or rings < 2:
        raise ValueError("segments must be a multiple of 4, at least 8, and rings at least 2")
    angles = math.tau * np.arange(segments) / segments
    ellipse = 0.5 * np.stack((ratio * np.cos(angles), np.sin(angles)), axis=1)
    levels = [(1.0, -0.5 * girdle)]
    levels += [(math.cos(0.5 * math.pi * i / rings), 0.5 * girdle + height * math.sin(0.5 * math.pi * i / rings)) for i in range(rings)]
    loops = [np.concatenate((share * ellipse, np.full((segments, 1), z)), axis=1) for share, z in levels]
    vertices = np.concatenate((*loops, [(0.0, 0.0, 0.5 * girdle + height)]))

    faces, names = [tuple(range(segments - 1, -1, -1))], ["base"]
    for level in range(rings):
        for i in range(segments):
            a, b = level * segments + i, level * segments + (i + 1) % segments
            faces.append((a, b, b + segments, a + segments))
            names.append("dome" if level else "girdle")
    for i in range(segments):
        faces.append((rings * segments + i, rings * segments + (i + 1) % segments, len(vertices) - 1))
        names.append("dome")
    return Stone(Polyhedron(vertices, tuple(faces), tuple(range(len(faces)))), tuple(names))
