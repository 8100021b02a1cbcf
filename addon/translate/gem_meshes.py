# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a mesh as a gem: holes, and faces that look inwards. The gem is rendered all the same; the report names it."""

from __future__ import annotations

import numpy as np


def gem_mesh_problems(positions: np.ndarray, triangles: np.ndarray) -> list[str]:
    """Sentences about a mesh whose inside matters.

    Parameters
    ----------
    positions : ndarray
        (n, 3).
    triangles : ndarray
        (m, 3) corners.
    """
    if not len(triangles):
        return []
    # Corners in the same place are one: facets that are split along their edges still close the surface.
    _, place = np.unique(positions, axis=0, return_inverse=True)
    corners = place.reshape(-1)[triangles]
    corners = corners[(corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2]) & (corners[:, 2] != corners[:, 0])]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).astype(np.int64)
    count = int(place.max()) + 1
    forward = np.where(edges[:, 0] < edges[:, 1], 1, -1)
    key = edges.min(axis=1) * count + edges.max(axis=1)
    _, which, uses = np.unique(key, return_inverse=True, return_counts=True)
    turns = np.bincount(which.reshape(-1), weights=forward)
    open_edges = int((uses % 2 == 1).sum())
    if open_edges:
        return [
            f"the gem's mesh is open at {open_edges} edges, so it has no inside; it is rendered as it is, and light that gets lost in its "
            "holes is missing"
        ]
    problems = []
    if (turns != 0).any():
        problems.append("some faces of the gem look inwards, others outwards: recalculate the normals to the outside")
    p = np.asarray(positions, float)
    p = p - p.mean(axis=0)
    volume = np.einsum("ij,ij->i", p[triangles[:, 0]], np.cross(p[triangles[:, 1]], p[triangles[:, 2]])).sum()
    if volume < 0 and not problems:
        problems.append("the faces of the gem look inwards; they are taken as looking outwards")
    return problems
