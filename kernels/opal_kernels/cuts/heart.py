# SPDX-License-Identifier: GPL-3.0-or-later
"""The heart: two convex lobes, each a half of a brilliant, joined where they mirror each other.

A heart is not convex, so no list of half-spaces makes it. Its half y ≥ 0 is convex: it is cut like any brilliant, with the plane y = 0 as one
more facet. The other half is its mirror image, the two shared polygons vanish, and facets that continue straight across the mirror become one.
In the cleft the bezels and mains beside it face towards each other and leave a valley from table to culet.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from .fancy_brilliant import Plan, add_girdle
from .outline import heart_lobe, junction
from .polyhedron import Polyhedron
from .stone import FacetPlanes, Stone, check_fraction


def heart(
    *,
    ratio: float = 1.0,
    cleft: float = 0.11,
    table: float = 0.56,
    crown_angle: float = math.radians(34.5),
    pavilion_angle: float = math.radians(40.75),
    girdle: float = 0.035,
    star_length: float = 0.5,
    lower_half_length: float = 0.75,
    culet: float = 0.0,
) -> Stone:
    """A heart brilliant, its tip at +x; angles in radians, `cleft` the depth of the cleft in widths."""
    check_fraction("ratio", ratio, 0.85, 1.2)
    plan = Plan.from_angles(table, crown_angle, pavilion_angle, girdle, star_length, lower_half_length, culet)
    outline = heart_lobe(ratio, cleft)

    facets = FacetPlanes()
    plan.add_table_and_culet(facets)
    for station in outline.stations:
        plan.add_station(facets, station)
    for a, b in zip(outline.stations, outline.stations[1:], strict=False):
        between = junction(a, b, outline.points)
        plan.add_star(facets, a, b, between)
        plan.add_half(facets, a, between)
        plan.add_half(facets, b, between)
    last = outline.stations[-1]
    valley = junction(last, last.mirrored(), outline.points)
    plan.add_half(facets, last, replace(valley, chord=valley.meeting))  # Here the table's notch takes the place of a straight edge.
    add_girdle(facets, zip(outline.points, outline.points[1:], strict=False))
    facets.through("mirror", (0.0, -1.0, 0.0), (0.0, 0.0, 0.0))
    return join_with_mirror_image(facets.cut())


def join_with_mirror_image(half: Stone) -> Stone:
    """Join a stone that has one facet named ``mirror``, in the plane y = 0, with its image on the other side."""
    solid = half.solid
    vertices = solid.vertices.copy()
    on_mirror = np.abs(vertices[:, 1]) < 1e-9
    vertices[on_mirror, 1] = 0.0
    image = np.arange(len(vertices))
    image[~on_mirror] = len(vertices) + np.arange(np.count_nonzero(~on_mirror))
    joined = np.concatenate((vertices, vertices[~on_mirror] * (1.0, -1.0, 1.0)))

    faces, planes, names = [], [], []
    for face, plane, name, vector in zip(solid.faces, solid.planes, half.names, solid.area_vectors(), strict=True):
        if name == "mirror":
            continue
        crossing = [i for i, a in enumerate(face) if on_mirror[a] and on_mirror[face[(i + 1) % len(face)]]]
        if crossing and abs(vector[1]) < 1e-9 * np.linalg.norm(vector):
            near = face[crossing[0] + 1 :] + face[: crossing[0] + 1]
            faces.append(near + tuple(int(image[corner]) for corner in near[-2:0:-1]))
            planes.append(plane)
            names.append(name)
            continue
        faces += [face, tuple(int(image[corner]) for corner in reversed(face))]
        planes += [plane, plane]
        names += [name, name]
    return Stone(_without_loose_corners(Polyhedron(joined, tuple(faces), tuple(planes))), tuple(names))


def _without_loose_corners(solid: Polyhedron) -> Polyhedron:
    """Drop corners that no face uses."""
    used = sorted({corner for face in solid.faces for corner in face})
    number = {corner: i for i, corner in enumerate(used)}
    return Polyhedron(solid.vertices[used], tuple(tuple(number[c] for c in face) for face in solid.faces), solid.planes)
