# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays of the eye through a stone, backwards: at each facet the part that leaves is noted and what is reflected goes on.

Nothing is left to chance: a ray carries its share of one, by Fresnel's equations for unpolarised light and Beer's law, so all exits, what is
absorbed and what is still inside at the end add up to one. Intersections are Embree's, through the kernels' scene.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import binding
from ..descriptions import wavelengths
from ..scene import Scene
from .stone import FacetedStone

# After this many facets a diamond holds less than a thousandth of the light that entered.
MOST_FACETS = 96
# Rays that carry less are given up.
_LEAST_WEIGHT = 1e-4


@dataclass(frozen=True)
class Exits:
    """What leaves a stone at one facet after another.

    Attributes
    ----------
    weight : ndarray
        (facets + 1, rays): share of each ray that leaves; row 0 is the reflection off the outside.
    direction : ndarray
        (facets + 1, rays, 3) unit vectors away from the stone.
    triangle : ndarray
        (facets + 1, rays): which triangle it left through; -1 where there is none.
    hit : ndarray
        (rays,): whether the ray meets the stone.
    absorbed : ndarray
        (rays,): share that stays in the stone.
    """

    weight: np.ndarray
    direction: np.ndarray
    triangle: np.ndarray
    hit: np.ndarray
    absorbed: np.ndarray


def fresnel(cosine: np.ndarray, eta: float) -> tuple[np.ndarray, np.ndarray]:
    """Reflectance of unpolarised light and the cosine behind; eta = n(behind) / n(in front). Grazing light is reflected."""
    cosine = np.maximum(cosine, 1e-9)
    sine2 = (1 - cosine**2) / eta**2
    behind = np.sqrt(np.maximum(1 - sine2, 0))
    s = (cosine - eta * behind) / (cosine + eta * behind)
    p = (eta * cosine - behind) / (eta * cosine + behind)
    return np.where(sine2 >= 1, 1.0, 0.5 * (s**2 + p**2)), behind


class StoneRays:
    """A stone ready to be looked into; close it, or use it in a ``with`` statement.

    Parameters
    ----------
    stone : FacetedStone
    """

    def __init__(self, stone: FacetedStone) -> None:
        self.stone = stone
        self._size = stone.reach
        self._scene = Scene()
        # A stone of unit size about the origin: single precision then serves a stone of any size.
        mesh = self._scene.add_mesh((stone.vertices - stone.centre) / self._size, stone.triangles)
        self._scene.add_instances(mesh, [np.eye(4)])
        self._scene.commit()

    def close(self) -> None:
        self._scene.close()

    def __enter__(self) -> StoneRays:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _intersect(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = binding.scene_intersect(self._scene.handle, origins.astype(np.float32), directions.astype(np.float32))
        return found["distance"].astype(float), found["triangle"]

    def look(self, origins: np.ndarray, towards: np.ndarray, nm: float, facets: int = MOST_FACETS, least: float = _LEAST_WEIGHT) -> Exits:
        """Follows rays that all run in one direction.

        Parameters
        ----------
        origins : ndarray
            (rays, 3), in units of the stone's reach about its centre.
        towards : ndarray
            (3,) unit vector.
        nm : float
            Wavelength.
        facets : int
            How many facets a ray meets inside at most.
        least : float
            Rays that carry less of one are given up.
        """
        n = float(np.interp(nm, wavelengths(), self.stone.index))
        sigma = 0.0 if self.stone.absorption is None else float(np.interp(nm, wavelengths(), self.stone.absorption)) * self._size
        count = len(origins)
        out = Exits(
            np.zeros((facets + 1, count)),
            np.zeros((facets + 1, count, 3)),
            np.full((facets + 1, count), -1),
            np.zeros(count, bool),
            np.zeros(count),
        )
        d = np.broadcast_to(np.asarray(towards, float), (count, 3)).copy()
        t, triangle = self._intersect(origins, d)
        alive = np.isfinite(t)
        out.hit[:] = alive
        rays = np.flatnonzero(alive)
        p, d = origins[rays] + t[rays, None] * d[rays], d[rays]
        normal = self.stone.normals[triangle[rays]]
        cosine = np.clip(-np.einsum("ij,ij->i", d, normal), 0, 1)
        reflected, behind = fresnel(cosine, n)
        out.weight[0, rays] = reflected
        out.direction[0, rays] = d + 2 * cosine[:, None] * normal
        out.triangle[0, rays] = triangle[rays]
        d = d / n + (cosine / n - behind)[:, None] * normal
        weight = 1 - reflected
        for facet in range(1, facets + 1):
            p, d, weight, rays = self._next_facet(out, facet, p, d, weight, rays, n, sigma, least)
            if not len(rays):
                break
        return out

    def _hit_from_inside(self, p, d):
        # Off the facet by a rounding error's worth; inside a closed surface the next hit is another facet, seen from within.
        t, triangle = self._intersect(p + 1e-5 * d, d)
        t += 1e-5
        slipped = np.flatnonzero(~(np.isfinite(t) & (np.einsum("ij,ij->i", d, self.stone.normals[triangle]) > 0)))
        if len(slipped):
            # Beside an edge that step left the stone: the ray starts a little nearer to the stone's centre instead.
            p = p.copy()
            p[slipped] *= 1 - 1e-4
            t[slipped], triangle[slipped] = self._intersect(p[slipped], d[slipped])
        return p, t, triangle

    def _next_facet(self, out, facet, p, d, weight, rays, n, sigma, least):
        carried = weight > least
        p, d, weight, rays = p[carried], d[carried], weight[carried], rays[carried]
        p, t, triangle = self._hit_from_inside(p, d)
        inside = np.isfinite(t)
        p, d, weight, rays, t, triangle = p[inside], d[inside], weight[inside], rays[inside], t[inside], triangle[inside]
        p = p + t[:, None] * d
        passed = np.exp(-sigma * t)
        out.absorbed[rays] += weight * (1 - passed)
        weight = weight * passed
        normal = -self.stone.normals[triangle]
        cosine = -np.einsum("ij,ij->i", d, normal)
        right_side = cosine > 0  # a ray that twice slipped out at an edge is given up
        cosine = np.clip(cosine, 0, 1)
        reflected, behind = fresnel(cosine, 1 / n)
        out.weight[facet, rays] = np.where(right_side, weight * (1 - reflected), 0)
        leaving = d * n + (cosine * n - behind)[:, None] * normal
        out.direction[facet, rays] = leaving
        out.triangle[facet, rays] = triangle
        d = d + 2 * cosine[:, None] * normal
        return p[right_side], d[right_side], (weight * reflected)[right_side], rays[right_side]
