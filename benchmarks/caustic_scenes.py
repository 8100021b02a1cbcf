# SPDX-License-Identifier: GPL-3.0-or-later
"""Two scenes of dispersed caustics, as arrays that every renderer reads: a prism behind a slit, and a brilliant on a floor.

Both are lit by one small square lamp (radiance `LAMP_RADIANCE` on its front, white) and nothing else. Glass follows Cauchy's formula,
which LuxCore knows too. Metres; the camera is a pinhole.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

SIZE = 256
LAMP_RADIANCE = 1000.0
FLOOR_REFLECTANCE = 0.8


@dataclass
class Mesh:
    """Corners (n, 3) and triangles (m, 3), outward by the right hand."""

    corners: np.ndarray
    triangles: np.ndarray


@dataclass
class CausticScene:
    """What a renderer needs to know.

    Attributes
    ----------
    index_d, cauchy_b : float
        n(λ) = index_d + cauchy_b (1/λ² - 1/0.5893²), λ in µm.
    glass, floor, screen : Mesh
        A dispersing body, a white diffuse ground, a black one that lets a beam through (or None).
    lamp_centre, lamp_target : tuple of float
        The lamp faces its target.
    lamp_side : float
        Of the square.
    eye, target : tuple of float
        Of the camera.
    field_of_view : float
        Radians, across the square picture.
    """

    name: str
    index_d: float
    cauchy_b: float
    glass: Mesh
    floor: Mesh
    screen: Mesh | None
    lamp_centre: tuple[float, float, float]
    lamp_target: tuple[float, float, float]
    lamp_side: float
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    field_of_view: float

    def index(self, nm) -> np.ndarray:
        """Index of refraction at wavelengths in nm."""
        return self.index_d + self.cauchy_b * ((1e3 / np.asarray(nm, float)) ** 2 - 1 / 0.5893**2)

    def lamp(self) -> Mesh:
        """The lamp's square; its front is the side of the right-hand normal."""
        x, y, _ = axes(self.lamp_centre, self.lamp_target)
        h, c = 0.5 * self.lamp_side, np.array(self.lamp_centre)
        # Seen from its target: x to the right, y up, the normal towards the viewer.
        return Mesh(
            np.array([c - h * x - h * y, c - h * x + h * y, c + h * x + h * y, c + h * x - h * y]), np.array([(0, 1, 2), (0, 2, 3)])
        )


def axes(origin, target, up=(0.0, 0.0, 1.0)):
    """Right, up and backward unit vectors of something at ``origin`` that looks at ``target``."""
    back = np.subtract(origin, target)
    back = back / np.linalg.norm(back)
    if abs(back @ np.array(up)) > 0.999:
        up = (0.0, 1.0, 0.0)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    return right, np.cross(back, right), back


def looking(origin, target, up=(0.0, 0.0, 1.0)) -> np.ndarray:
    """3 x 4 matrix of a camera or lamp that looks along its -Z at ``target``."""
    return np.column_stack([*axes(origin, target, up), origin])


def _ground(half: float, first: float | None = None) -> Mesh:
    """A square about the origin; with ``first``, only what lies beyond that x."""
    x = -half if first is None else first
    return Mesh(np.array([(x, -half, 0), (half, -half, 0), (half, half, 0), (x, half, 0)], float), np.array([(0, 1, 2), (0, 2, 3)]))


def prism() -> CausticScene:
    """60° of dense flint (as SF11: n_D 1.7845, V_d 26) behind a slit, at minimum deviation; its spectrum falls on the floor.
    The floor begins behind the screen: lit by the lamp itself, it would send a haze through the slit."""
    side, depth, height = 0.4, 0.5, 0.9
    corners = np.array(
        [(x, y, height + z) for y in (-depth, depth) for x, z in ((-side / 2, 0), (side / 2, 0), (0, side * math.sqrt(0.75)))]
    )
    triangles = np.array([(0, 1, 2), (3, 5, 4), (0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (2, 5, 3), (2, 3, 0)])
    x, low, high, wide, tall = -0.45, 0.79, 0.89, 0.25, 3.0
    ys, zs = (-tall, -wide, wide, tall), (0.0, low, high, tall)
    screen = np.array([(x, y, z) for y in ys for z in zs])
    faces = [(4 * i + j, 4 * i + j + 4, 4 * i + j + 5, 4 * i + j + 1) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    return CausticScene(
        "prism", 1.7845, 0.01595, Mesh(corners, triangles), _ground(4.0, x),
        Mesh(screen, np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])),
        (-1.61, 0.0, 0.09), (-0.1, 0.0, 1.07), 0.04, (1.6, -1.2, 2.6), (1.6, 0.0, 0.0), 0.75,
    )  # fmt: skip


def brilliant() -> CausticScene:
    """A round brilliant of diamond, table up on its culet, and the fans of colour around it."""
    from opal_kernels.cuts import round_brilliant

    solid = round_brilliant().scaled(1.0).solid
    corners = np.asarray(solid.vertices, float)
    corners = corners - (0.0, 0.0, corners[:, 2].min() - 0.02)
    triangles = np.array([(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)])
    return CausticScene(
        "brilliant", 2.41726, 0.01342, Mesh(corners, triangles), _ground(6.0), None,
        (1.2, 0.8, 3.0), (0.0, 0.0, 0.5), 0.08, (0.0, -3.4, 2.6), (0.0, 0.0, 0.25), 0.8,
    )  # fmt: skip


SCENES = {"prism": prism, "brilliant": brilliant}
