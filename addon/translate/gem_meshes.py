# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a mesh as a gem: holes, and faces that look inwards. The gem is rendered all the same; the report names it."""

from __future__ import annotations

from typing import Any

import numpy as np


def mend_gem_mesh(arrays: Any, only_gems: bool) -> list[str]:
    """Turns a gem's faces outwards where all of them look inwards; returns what there is to say.

    Parameters
    ----------
    arrays : MeshArrays
    only_gems : bool
        Whether every material of the mesh is a gem; a mesh with other surfaces is left as it is.
    """
    problems, inverted = gem_mesh_problems(arrays.positions, arrays.triangles)
    if inverted and only_gems:
        arrays.triangles = np.ascontiguousarray(arrays.triangles[:, ::-1])
        for name in ("corner_normals", "corner_tangents"):
            values = getattr(arrays, name)
            if values is not None:
                shaped = values.reshape(len(arrays.triangles), 3, -1)[:, ::-1]
                setattr(arrays, name, np.ascontiguousarray(-shaped if name == "corner_normals" else shaped).reshape(values.shape))
    return problems


def gem_mesh_problems(positions: np.ndarray, triangles: np.ndarray) -> tuple[list[str], bool]:
    """Sentences about a mesh whose inside matters, and whether its faces all look inwards.

    Parameters
    ----------
    positions : ndarray
        (n, 3).
    triangles : ndarray
        (m, 3) corners.
    """
    if not len(triangles):
        return [], False
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
        return [f"the gem's mesh is open at {open_edges} edges and has no proper inside: close its holes; it is rendered as it is"], False
    if (turns != 0).any():
        return ["some faces of the gem look inwards, others outwards: recalculate its normals to the outside"], False
    p = np.asarray(positions, float)
    p = p - p.mean(axis=0)
    volume = np.einsum("ij,ij->i", p[triangles[:, 0]], np.cross(p[triangles[:, 1]], p[triangles[:, 2]])).sum()
    if volume < 0:
        return ["the gem's normals are flipped, its faces look inwards; they are taken as looking outwards"], True
    return [], False
