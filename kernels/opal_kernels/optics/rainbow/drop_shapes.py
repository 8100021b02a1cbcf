# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of revolution that a drop may have: what air makes of a falling one, spheroids, the sphere.

Each is r(c), the distance of its surface from its centre over c, the cosine of the angle from its upper pole, in units of the radius
of the sphere of equal volume; the axis is vertical (z).

A falling drop is a cosine series r = a0 (1 + sum c_n cos(n theta)), flat below and round above: Chuang and Beard, J. Atmos. Sci. 47
(1990) 1374, table 1, in units of 1e-4, for diameters of 1 to 6 mm (`COEFFICIENTS`); between, cubic in the diameter. Smaller drops have
the form of the one of 1 mm, as far from round as the axis ratios of Beard and Chuang, J. Atmos. Sci. 44 (1987) 1509 say (`axis_ratio`);
larger ones, which burst, that of 6 mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

DIAMETERS_MM = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0)
COEFFICIENTS = (  # c_0 to c_10 of one diameter a row
    (-28, 30, -83, 22, -3, -2, 1, 0, 0, 0, 0),
    (-72, 70, -210, 57, -6, -7, 3, 0, -1, 0, 1),
    (-134, 118, -385, 100, -5, -17, 6, 1, -3, 1, 1),
    (-211, 180, -592, 147, 4, -32, 10, 3, -5, 1, 2),
    (-297, 247, -816, 188, 24, -52, 13, 8, -8, 1, 4),
    (-481, 359, -1263, 244, 91, -99, 15, 25, -16, -2, 10),
    (-665, 435, -1674, 258, 187, -141, 4, 48, -21, -11, 17),
    (-843, 472, -2040, 240, 299, -168, -21, 73, -20, -25, 24),
)
_UNIT = 1e-4


def axis_ratio(radius_um: float) -> float:
    """Return height over width of a falling drop: Beard and Chuang 1987, a polynomial in the diameter, at most 1."""
    d = min(2e-3 * radius_um, 8.0)
    return min(1.0, 1.0048 + d * (5.7e-4 + d * (-2.628e-2 + d * (3.682e-3 - 1.677e-4 * d))))


def coefficients(diameter_mm: float) -> np.ndarray:
    """Return c_0 to c_10 of a falling drop of this equal-volume diameter."""
    table, nodes = _UNIT * np.array(COEFFICIENTS, float), np.array(DIAMETERS_MM)
    if diameter_mm <= nodes[0]:
        return table[0] * (1 - axis_ratio(500 * diameter_mm)) / (1 - axis_ratio(500 * nodes[0]))
    d = min(diameter_mm, nodes[-1])
    i = min(int(np.searchsorted(nodes, d, "right")) - 1, len(nodes) - 2)
    slopes = np.gradient(table, nodes, axis=0, edge_order=2)
    width = nodes[i + 1] - nodes[i]
    t = (d - nodes[i]) / width
    values = (1 + 2 * t) * (1 - t) ** 2 * table[i] + t * t * (3 - 2 * t) * table[i + 1]
    return values + width * t * (1 - t) * ((1 - t) * slopes[i] - t * slopes[i + 1])


@dataclass(frozen=True)
class CosineSeries:
    """1 + sum c_n cos(n theta) times what makes its volume a unit sphere's; c_n are `series`."""

    series: tuple[float, ...] = (0.0,)

    @cached_property
    def _powers(self) -> tuple[np.ndarray, np.ndarray]:
        """The series as a polynomial in c = cos(theta) (cos(n theta) is Chebyshev's T_n(c)), and its derivative."""
        chebyshev = np.array(self.series, float)
        chebyshev[0] += 1
        nodes, weights = np.polynomial.legendre.leggauss(2 * len(chebyshev) + 2)
        volume = 0.5 * weights @ np.polynomial.chebyshev.chebval(nodes, chebyshev) ** 3  # over a unit sphere's
        powers = np.polynomial.chebyshev.cheb2poly(chebyshev) / np.cbrt(volume)
        return powers, np.polynomial.polynomial.polyder(powers)

    def radius(self, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return (r, dr/dc)."""
        powers, slopes = self._powers
        return _horner(powers, c), _horner(slopes, c)

    @cached_property
    def ratio(self) -> float:
        """Height over width."""
        c = np.linspace(-1, 1, 2001)
        r = self.radius(c)[0]
        return float((r[0] + r[-1]) / (2 * (r * np.sqrt(1 - c * c)).max()))


@dataclass(frozen=True)
class Spheroid:
    """An ellipsoid of revolution of height over width `ratio`, its volume a unit sphere's."""

    ratio: float = 1.0

    def radius(self, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return (r, dr/dc)."""
        wide2 = self.ratio ** (-2 / 3)
        bulge = 1 / self.ratio**2 - 1
        r = np.sqrt(wide2 / (1 + bulge * c * c))
        return r, -bulge * c * r**3 / wide2


Surface = CosineSeries | Spheroid
SPHERE = Spheroid(1.0)


@lru_cache(maxsize=512)
def falling(diameter_mm: float, flattening: float = 1.0) -> Surface:
    """Return the surface of a falling drop, `flattening` times as far from a sphere as it is."""
    series = flattening * coefficients(diameter_mm)
    return CosineSeries(tuple(float(c) for c in series)) if np.abs(series).max() > 1e-9 else SPHERE


def _horner(powers: np.ndarray, c: np.ndarray) -> np.ndarray:
    result = np.full_like(c, powers[-1]) if len(powers) else np.zeros_like(c)
    for coefficient in powers[-2::-1]:
        result *= c
        result += coefficient
    return result
