# SPDX-License-Identifier: GPL-3.0-or-later
"""The stone of a report: a closed triangle mesh that looks up along +z, what its facets are, and what it is made of."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

# A facet whose normal stands this near the horizon belongs to the girdle; the steepest pavilions and crowns lie far from it.
_GIRDLE_SINE = 0.17
# A facet this level is a table.
_TABLE_COSINE = 0.999


@dataclass(frozen=True)
class FacetedStone:
    """A stone face-up.

    Attributes
    ----------
    vertices : ndarray
        (n, 3) metres; the table looks along +z.
    triangles : ndarray
        (m, 3) corners, counter-clockwise from outside.
    index : ndarray
        (471,) index of refraction at 360 ... 830 nm.
    absorption : ndarray or None
        (471,) in 1/m, None for a clear stone.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    index: np.ndarray
    absorption: np.ndarray | None = None

    def __post_init__(self) -> None:
        if len(self.triangles) < 4:
            raise ValueError("a stone needs at least four faces")
        volume = np.einsum("ij,ij->i", self._corners[:, 0], np.cross(self._corners[:, 1], self._corners[:, 2])).sum() / 6
        if not volume > 0:
            raise ValueError("the stone's faces look inwards, or it has no volume: recalculate its normals to the outside")
        edges = np.sort(np.stack([self.triangles[:, [0, 1]], self.triangles[:, [1, 2]], self.triangles[:, [2, 0]]]).reshape(-1, 2), axis=1)
        if (np.unique(edges, axis=0, return_counts=True)[1] != 2).any():
            raise ValueError("the stone's mesh is open: close its holes first")

    @property
    def _corners(self) -> np.ndarray:
        return np.asarray(self.vertices, float)[self.triangles]

    @cached_property
    def normals(self) -> np.ndarray:
        """Outward unit normals of the triangles, (m, 3); degenerate ones look up."""
        normal = np.cross(self._corners[:, 1] - self._corners[:, 0], self._corners[:, 2] - self._corners[:, 0])
        length = np.linalg.norm(normal, axis=1, keepdims=True)
        return np.where(length > 0, normal / np.maximum(length, 1e-300), (0.0, 0.0, 1.0))

    @cached_property
    def facets(self) -> np.ndarray:
        """Number of the facet of each triangle, (m,): triangles of one normal are one facet."""
        return np.unique(np.round(self.normals, 4), axis=0, return_inverse=True)[1].reshape(-1)

    @cached_property
    def is_table(self) -> np.ndarray:
        """Whether a triangle is of the table, (m,)."""
        return self.normals[:, 2] > _TABLE_COSINE

    @cached_property
    def is_girdle(self) -> np.ndarray:
        """Whether a triangle is of the girdle, (m,)."""
        return np.abs(self.normals[:, 2]) < _GIRDLE_SINE

    @property
    def reach(self) -> float:
        """Radius about the stone's axis that holds it from above, metres."""
        return float(np.linalg.norm(self.vertices - self.centre, axis=1).max())

    @property
    def centre(self) -> np.ndarray:
        """Middle of its bounds, (3,)."""
        return 0.5 * (self.vertices.min(axis=0) + self.vertices.max(axis=0))
