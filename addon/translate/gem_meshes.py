# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with the gems of a mesh: holes, and faces that look inwards. They are rendered all the same; the report names the object.

A mesh may hold several bodies, of which some are gems: a ring and its stone, or stones that were joined. Each body is judged alone. Bodies
of media are judged by the same rules.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from opal_kernels.mesh_bodies import NO_GEM, bodies_of, turned_inwards

_PLURAL = {"gem": "gems", "medium": "media"}


def mend_gem_mesh(arrays: Any, gem_of_slot: Sequence[int], what: str = "gem") -> list[str]:
    """Turns gems whose faces look inwards outwards; returns what there is to say.

    Parameters
    ----------
    arrays : MeshArrays
    gem_of_slot : sequence of int
        For each material slot the number of its gem, the same for the same material; `NO_GEM` for anything else.
    what : str
        What they are, for the sentences: a gem or a medium.
    """
    slots = arrays.material_slots if arrays.material_slots is not None else np.zeros(len(arrays.triangles), np.int64)
    gems = np.asarray(gem_of_slot, np.int64)[np.clip(slots, 0, len(gem_of_slot) - 1)]
    problems, inverted = gem_mesh_problems(arrays.positions, arrays.triangles, gems, what)
    if inverted.any():
        arrays.triangles = np.ascontiguousarray(_turned(arrays.triangles, inverted))
        for name, sign in (("corner_normals", -1), ("corner_tangents", 1)):
            if (values := getattr(arrays, name)) is not None:
                shaped = _turned(values.reshape(len(inverted), 3, -1), inverted)
                shaped[inverted] *= sign
                setattr(arrays, name, np.ascontiguousarray(shaped).reshape(values.shape))
        arrays.attributes = [
            (number, domain, _turned(values.reshape(len(inverted), 3, -1), inverted).reshape(values.shape) if domain == 0 else values)
            for number, domain, values in arrays.attributes
        ]
    return problems


def _turned(corners: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """A copy of values at the corners of triangles, (m, 3, ...), with those of some faces in reverse order."""
    result = corners.copy()
    result[faces] = corners[faces][:, ::-1]
    return result


def gem_mesh_problems(positions: np.ndarray, triangles: np.ndarray, gems: np.ndarray, what: str = "gem") -> tuple[list[str], np.ndarray]:
    """Sentences about a mesh whose inside matters, and which faces have to be turned.

    Parameters
    ----------
    positions : ndarray
        (n, 3).
    triangles : ndarray
        (m, 3) corners.
    gems : ndarray
        (m,) number of each triangle's gem, `NO_GEM` for other surfaces.

    Returns
    -------
    problems : list of str
    inverted : ndarray
        (m,) of bool: triangles of gems that look inwards.
    """
    inverted = np.zeros(len(triangles), bool)
    # Corners in the same place are one: facets that are split along their edges still close the surface.
    _, place = np.unique(positions, axis=0, return_inverse=True)
    places = place.reshape(-1)[triangles]
    solid = np.flatnonzero((places[:, 0] != places[:, 1]) & (places[:, 1] != places[:, 2]) & (places[:, 2] != places[:, 0]))
    if not (gems[solid] != NO_GEM).any():
        return [], inverted
    bodies = bodies_of(triangles[solid], places[solid], np.asarray(positions, float), gems[solid])
    is_gem = bodies.gem != NO_GEM
    is_open = is_gem & (bodies.open_edges > 0)
    is_mixed = is_gem & ~is_open & bodies.mixed
    problems = []
    if is_open.any():
        edges = int(bodies.open_edges[is_open].sum())
        problems.append(f"the {what}'s mesh is open at {edges} edges and has no proper inside: close its holes; it is rendered as it is")
    if is_mixed.any():
        problems.append(f"some faces of the {what} look inwards, others outwards: recalculate its normals to the outside")
    flipped = turned_inwards(bodies, is_gem & ~is_open & ~is_mixed)
    if count := int((flipped & (bodies.volume < 0)).sum()):
        one = f"the {what}'s normals are flipped, its faces look inwards"
        whose = one if is_gem.sum() == 1 else _of_several(count, int(is_gem.sum()), _PLURAL[what])
        problems.append(f"{whose}; they are taken as looking outwards")
        inverted[solid] = flipped[bodies.of_face]
    return problems, inverted


def _of_several(count: int, all_gems: int, plural: str) -> str:
    return f"the normals of {count} of the mesh's {all_gems} {plural} are flipped, their faces look inwards"
