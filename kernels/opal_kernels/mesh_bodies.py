# SPDX-License-Identifier: GPL-3.0-or-later
"""The bodies that the triangles of a mesh make: which hang together, which are closed, and which look inwards.

Everything is done for all triangles at once; only bodies that look inwards are looked at one by one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

NO_GEM = -1


@dataclass(frozen=True)
class Bodies:
    """Parts of a mesh that hang together.

    Attributes
    ----------
    corners : ndarray
        (m, 3, 3) corners of the triangles.
    of_face : ndarray
        (m,) number of each triangle's body; the arrays below are by that number.
    gem : ndarray
        The gem of each body's gem faces, `NO_GEM` where it has none.
    open_edges : ndarray
        Edges at which an odd number of the body's faces meet.
    mixed : ndarray
        Whether its faces run along some edge in the same direction.
    volume : ndarray
        Signed; negative where faces look inwards.
    """

    corners: np.ndarray
    of_face: np.ndarray
    gem: np.ndarray
    open_edges: np.ndarray
    mixed: np.ndarray
    volume: np.ndarray


def bodies_of(triangles: np.ndarray, places: np.ndarray, positions: np.ndarray, gems: np.ndarray) -> Bodies:
    """The bodies of a mesh.

    What hangs together by its own corners and is closed is a body: stones that only touch stay two. The rest is joined where corners
    lie in one place.

    Parameters
    ----------
    triangles : ndarray
        (m, 3) corners.
    places : ndarray
        (m, 3) the same, with one number for corners in one place; three different ones in each row.
    positions : ndarray
        (n, 3).
    gems : ndarray
        (m,) number of each triangle's gem, `NO_GEM` for other surfaces.
    """
    edges = np.concatenate([places[:, [0, 1]], places[:, [1, 2]], places[:, [2, 0]]]).astype(np.int64)
    forward = np.where(edges[:, 0] < edges[:, 1], 1, -1)
    _, edge = np.unique(edges.min(axis=1) * (int(places.max()) + 1) + edges.max(axis=1), return_inverse=True)
    edge = edge.reshape(-1)

    pieces = parts(triangles)
    open_edges, mixed = _edge_counts(edge, forward, pieces)
    loose = open_edges[pieces] > 0
    if loose.any():
        pieces[loose] = pieces.max() + 1 + parts(places[loose])
        pieces = np.unique(pieces, return_inverse=True)[1].reshape(-1)
        open_edges, mixed = _edge_counts(edge, forward, pieces)

    count = int(pieces.max()) + 1
    corners = positions[triangles]
    _, first = np.unique(pieces, return_index=True)
    a, b, c = np.moveaxis(corners - corners[first, 0][pieces][:, None], 1, 0)
    volume = np.bincount(pieces, weights=np.einsum("ij,ij->i", a, np.cross(b, c)), minlength=count) / 6.0
    gem = np.full(count, NO_GEM, np.int64)
    np.maximum.at(gem, pieces, gems)
    return Bodies(corners, pieces, gem, open_edges, mixed, volume)


def _edge_counts(edge: np.ndarray, forward: np.ndarray, pieces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each piece the number of open edges, and whether faces beside some edge run along it the same way.

    Parameters
    ----------
    edge, forward : ndarray
        (3 m,) number of each edge of each face, and the way in which the face runs along it, 1 or -1.
    pieces : ndarray
        (m,) piece of each face.
    """
    owner = np.tile(pieces, 3)
    key = owner.astype(np.int64) * (int(edge.max()) + 1) + edge
    _, first, which, uses = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
    turns = np.bincount(which.reshape(-1), weights=forward)
    count = int(pieces.max()) + 1
    open_edges = np.bincount(owner[first], weights=uses % 2 == 1, minlength=count).astype(np.int64)
    return open_edges, np.bincount(owner[first], weights=turns != 0, minlength=count) > 0


def parts(faces: np.ndarray) -> np.ndarray:
    """Numbers, from 0, of the parts into which faces fall that share corners.

    Parameters
    ----------
    faces : ndarray
        (m, 3) corners.

    Returns
    -------
    ndarray
        (m,) part of each face.
    """
    lowest = np.arange(int(faces.max()) + 1)
    links = np.concatenate([faces[:, [0, 1]], faces[:, [0, 2]]])
    while len(links):
        low, high = links.min(axis=1), links.max(axis=1)
        np.minimum.at(lowest, high, low)
        while (lowest[lowest] != lowest).any():
            lowest = lowest[lowest]
        links = lowest[links]
        links = links[links[:, 0] != links[:, 1]]
    return np.unique(lowest[faces[:, 0]], return_inverse=True)[1].reshape(-1)


def turned_inwards(bodies: Bodies, sound: np.ndarray) -> np.ndarray:
    """Bodies that have to be turned: those of negative volume, with what lies in them.

    A body within another one of the same gem keeps its way relative to that one: looking inwards it is a cavity.

    Parameters
    ----------
    sound : ndarray
        Bodies that are gems, closed and of one orientation; no other is looked at.
    """
    flipped = np.zeros(len(bodies.gem), bool)
    negative = np.flatnonzero(sound & (bodies.volume < 0))
    if not len(negative):
        return flipped
    order = np.argsort(bodies.of_face, kind="stable")
    corners = bodies.corners[order]
    starts = np.searchsorted(bodies.of_face[order], np.arange(len(sound) + 1))
    low_of_faces, high_of_faces = corners.min(axis=1), corners.max(axis=1)
    low, high = np.minimum.reduceat(low_of_faces, starts[:-1]), np.maximum.reduceat(high_of_faces, starts[:-1])
    points = np.einsum("i,kij->kj", _SOMEWHERE, corners[starts[:-1]])
    shadows = [np.ascontiguousarray(values[:, axis]) for values in (low_of_faces, high_of_faces) for axis in (1, 2)]

    def holds(body: int, other: int) -> bool:
        faces, point = slice(starts[body], starts[body + 1]), points[other]
        y_low, z_low, y_high, z_high = (values[faces] for values in shadows)
        in_line = (y_low <= point[1]) & (y_high >= point[1]) & (z_low <= point[2]) & (z_high >= point[2])
        return _crossings(corners[faces][in_line] - point) % 2 == 1

    for body in negative:
        others = sound & (bodies.gem == bodies.gem[body])
        others[body] = False
        if any(
            holds(holder, body) for holder in np.flatnonzero(others & (low <= low[body]).all(axis=1) & (high >= high[body]).all(axis=1))
        ):
            continue
        within = np.flatnonzero(others & (low >= low[body]).all(axis=1) & (high <= high[body]).all(axis=1))
        flipped[body] = True
        flipped[[other for other in within if holds(body, other)]] = True
    return flipped


# Where on a body's first face it is asked whether the body lies in another: weights of the corners, so uneven that the line from there
# along x meets no edge of a regular mesh.
_SOMEWHERE = np.array([0.5123, 0.3019, 0.1858])


def _crossings(triangles: np.ndarray) -> int:
    """How many triangles (m, 3, 3) the half-line from the origin along x meets."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    sides = np.stack([u[:, 1] * v[:, 2] - u[:, 2] * v[:, 1] for u, v in ((b, c), (c, a), (a, b))], axis=1)
    met = (sides > 0).all(axis=1) | (sides < 0).all(axis=1)
    # The sign of x, times the size of the triangle's shadow.
    ahead = np.einsum("ki,ki->k", sides, triangles[:, :, 0]) * np.sign(sides[:, 0]) > 0
    return int((met & ahead).sum())
