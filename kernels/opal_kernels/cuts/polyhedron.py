# SPDX-License-Identifier: GPL-3.0-or-later
"""A convex polyhedron as the intersection of half-spaces: what a gem cutter makes, plane after plane.

A half-space is ``normal · x <= distance`` with a unit normal that points out of the stone. The stone starts as a cube and each
plane in turn cuts it, as on a faceting machine: corners are sorted into inside, on and outside the plane, edges that cross it get one
new corner each (shared by the two faces beside the edge, so the surface cannot open), and the corners on the plane become the new
facet. Corners closer to a plane than the tolerance count as lying on it, which is how facets come to meet in one point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Polyhedron:
    """A closed surface of planar polygons.

    Attributes
    ----------
    vertices : ndarray of float64, shape (V, 3)
        Corners, in the units of the planes' distances.
    faces : tuple of tuple of int
        Corners of each face, counter-clockwise seen from outside.
    planes : tuple of int
        For each face, the index of the half-space it lies in.
    """

    vertices: np.ndarray
    faces: tuple[tuple[int, ...], ...]
    planes: tuple[int, ...]

    def edges(self) -> set[tuple[int, int]]:
        """Edges as pairs of corner indices, the smaller first."""
        return {(min(a, b), max(a, b)) for a, b in self.directed_edges()}

    def directed_edges(self) -> list[tuple[int, int]]:
        """Every face's edges in its own direction; a watertight surface has each once, and its reverse once."""
        return [edge for face in self.faces for edge in zip(face, face[1:] + face[:1], strict=True)]

    def is_watertight(self) -> bool:
        """Whether each edge borders exactly two faces that run along it in opposite directions."""
        directed = self.directed_edges()
        unique = set(directed)
        return len(unique) == len(directed) and all((b, a) in unique for a, b in unique)

    def euler_characteristic(self) -> int:
        """V − E + F: 2 for anything that is a sphere in shape."""
        return len({corner for face in self.faces for corner in face}) - len(self.edges()) + len(self.faces)

    def area_vectors(self) -> np.ndarray:
        """Outward area vector of each face, shape (F, 3); its length is the face's area (Newell's method)."""
        vectors = np.empty((len(self.faces), 3))
        for i, face in enumerate(self.faces):
            corners = self.vertices[list(face)]
            vectors[i] = 0.5 * np.cross(corners - corners[0], np.roll(corners, -1, axis=0) - corners[0]).sum(axis=0)
        return vectors

    def volume(self) -> float:
        """Enclosed volume, by the divergence theorem over the faces; positive when the winding is outward."""
        firsts = self.vertices[[face[0] for face in self.faces]]
        return float(np.einsum("ij,ij->", firsts, self.area_vectors()) / 3.0)

    def planarity_error(self) -> float:
        """Largest distance of a corner from the plane through its face's centre, along the face's area vector."""
        worst = 0.0
        for face, vector in zip(self.faces, self.area_vectors(), strict=True):
            corners = self.vertices[list(face)]
            worst = max(worst, float(np.abs((corners - corners.mean(axis=0)) @ (vector / np.linalg.norm(vector))).max()))
        return worst

    def contracted(self, length: float) -> Polyhedron:
        """The same with edges shorter than this drawn together to a point; faces that this leaves without area vanish.

        If the surface would not stay closed, nothing is changed.
        """
        group = np.arange(len(self.vertices))

        def root(corner: int) -> int:
            while group[corner] != corner:
                corner = group[corner]
            return int(corner)

        for a, b in sorted(self.edges()):
            if np.linalg.norm(self.vertices[a] - self.vertices[b]) < length:
                group[root(b)] = root(a)
        roots = [root(corner) for corner in range(len(self.vertices))]
        kept = sorted(set(roots))
        number = {corner: i for i, corner in enumerate(kept)}
        members = [[c for c, r in enumerate(roots) if r == corner] for corner in kept]
        faces, planes = [], []
        for face, plane in zip(self.faces, self.planes, strict=True):
            loop = [number[roots[corner]] for corner in face]
            loop = [corner for i, corner in enumerate(loop) if corner != loop[i - 1]]
            if len(loop) > 2:
                faces.append(tuple(loop))
                planes.append(plane)
        result = Polyhedron(np.array([self.vertices[m].mean(axis=0) for m in members]), tuple(faces), tuple(planes))
        return result if result.is_watertight() and result.euler_characteristic() == 2 else self


def intersect_half_spaces(normals: np.ndarray, distances: np.ndarray, tolerance: float = 1e-9) -> Polyhedron:
    """Intersect half-spaces into one bounded convex polyhedron.

    Parameters
    ----------
    normals : array_like of float, shape (N, 3)
        Outward normals, of any length but zero.
    distances : array_like of float, shape (N,)
        Distances of the planes from the origin along their normals made unit.
    tolerance : float
        Corners closer to a plane than this fraction of the largest distance lie on it. Planes that bring nothing (duplicates, planes that
        only touch) leave no face.

    Returns
    -------
    Polyhedron
        Faces carry the index of their half-space; the first of several coincident ones keeps the face.

    Raises
    ------
    ValueError
        If the input is not finite, a normal is zero, the half-spaces leave nothing, or what they leave has no bound.
    """
    normals = np.array(normals, dtype=np.float64).reshape(-1, 3)
    distances = np.array(distances, dtype=np.float64).reshape(-1)
    if len(normals) != len(distances):
        raise ValueError(f"{len(normals)} normals but {len(distances)} distances")
    lengths = np.linalg.norm(normals, axis=1)
    if not (np.isfinite(normals).all() and np.isfinite(distances).all() and (lengths > 0.0).all()):
        raise ValueError("facet planes must have finite distances and normals that are not zero")
    normals /= lengths[:, None]
    size = float(np.abs(distances).max(initial=0.0))
    if size == 0.0:
        raise ValueError("all facet planes pass through the origin: they enclose nothing")

    solid = _Cube(half_width=_CUBE_TO_STONE * size, tolerance=tolerance * size)
    for plane, (normal, distance) in enumerate(zip(normals, distances, strict=True)):
        if not solid.cut(normal, float(distance), plane):
            raise ValueError(f"facet plane {plane} leaves nothing of the stone")
    if any(plane < 0 for plane in solid.planes):
        raise ValueError("the facet planes leave the stone open: they do not bound it on every side")
    return solid.finish(normals, distances)


# A bounded stone lies well inside a cube this many times its largest plane distance, unless two planes are all but parallel.
_CUBE_TO_STONE = 1e3


class _Cube:
    """The stone while it is being cut: corners, face loops and, for each face, its plane (−1 for the rough's own sides)."""

    def __init__(self, half_width: float, tolerance: float) -> None:
        h = half_width
        self.tolerance = tolerance
        self.corners = [np.array((x, y, z)) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
        self.faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        self.planes = [-1] * 6

    def cut(self, normal: np.ndarray, distance: float, plane: int) -> bool:
        """Remove what lies beyond the plane; False when nothing is left."""
        used = sorted({corner for face in self.faces for corner in face})
        height = {corner: float(self.corners[corner] @ normal) - distance for corner in used}
        side = {c: 0 if abs(h) <= self.tolerance else (1 if h > 0.0 else -1) for c, h in height.items()}
        if all(s <= 0 for s in side.values()):
            return True
        if not any(s < 0 for s in side.values()):
            return False

        crossings: dict[tuple[int, int], int] = {}

        def crossing(a: int, b: int) -> int:
            key = (min(a, b), max(a, b))
            if key not in crossings:
                a, b = key
                t = height[a] / (height[a] - height[b])
                self.corners.append((1.0 - t) * self.corners[a] + t * self.corners[b])
                crossings[key] = len(self.corners) - 1
            return crossings[key]

        faces, planes, rim = [], [], {}
        for face, owner in zip(self.faces, self.planes, strict=True):
            kept: list[int] = []
            for a, b in zip(face, face[1:] + face[:1], strict=True):
                if side[a] <= 0:
                    kept.append(a)
                if side[a] * side[b] < 0:
                    kept.append(crossing(a, b))
            on_plane = [side.get(c, 0) == 0 for c in kept]
            if len(kept) < 3 or all(on_plane):
                continue
            faces.append(kept)
            planes.append(owner)
            # The cut runs along this face from one corner on the plane to the next; the new facet runs it backwards.
            for i, a in enumerate(kept):
                b = kept[(i + 1) % len(kept)]
                if on_plane[i] and on_plane[(i + 1) % len(kept)]:
                    rim[b] = a
        loop = [next(iter(rim))]
        while len(loop) <= len(rim) and rim.get(loop[-1], loop[0]) != loop[0]:
            loop.append(rim[loop[-1]])
        if len(loop) != len(rim):
            raise ValueError(f"facet plane {plane} meets others within the tolerance in more than one way; use a smaller tolerance")
        faces.append(loop)
        planes.append(plane)
        self.faces, self.planes = faces, planes
        return True

    def finish(self, normals: np.ndarray, distances: np.ndarray) -> Polyhedron:
        """Number the corners that are left and move each onto all the planes it belongs to."""
        used = sorted({corner for face in self.faces for corner in face})
        number = {corner: i for i, corner in enumerate(used)}
        owners: list[list[int]] = [[] for _ in used]
        for face, plane in zip(self.faces, self.planes, strict=True):
            for corner in face:
                owners[number[corner]].append(plane)
        vertices = np.array([self.corners[corner] for corner in used])
        for i, mine in enumerate(owners):
            residual = distances[mine] - normals[mine] @ vertices[i]
            vertices[i] += np.linalg.lstsq(normals[mine], residual, rcond=1e-7)[0]
        return Polyhedron(vertices, tuple(tuple(number[c] for c in face) for face in self.faces), tuple(self.planes))
