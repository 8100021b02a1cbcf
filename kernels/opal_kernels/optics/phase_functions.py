# SPDX-License-Identifier: GPL-3.0-or-later
"""Phase functions: how a medium turns light. Closed forms, and tables sampled by inverse cumulative distribution.

Convention: the angle is between propagation directions (cosine 1 is straight on); values are per steradian and integrate to 1
over the sphere. Sources: Henyey and Greenstein, ApJ 93 (1941) 70; Rayleigh 1871, unpolarised and without anisotropy.
"""

from __future__ import annotations

import numpy as np


def isotropic(cosine) -> np.ndarray:
    """Return 1/(4 pi), 1/sr."""
    return np.full(np.shape(cosine), 1 / (4 * np.pi))


def henyey_greenstein(cosine, anisotropy: float) -> np.ndarray:
    """Return the Henyey-Greenstein phase function (1/sr) of mean cosine `anisotropy`, in (-1, 1)."""
    g = anisotropy
    return (1 - g * g) / (4 * np.pi * (1 + g * g - 2 * g * np.asarray(cosine, float)) ** 1.5)


def rayleigh(cosine) -> np.ndarray:
    """Return Rayleigh's phase function (1/sr): 3/(16 pi) (1 + cos^2)."""
    return 3 / (16 * np.pi) * (1 + np.asarray(cosine, float) ** 2)


def sample_isotropic(u) -> np.ndarray:
    """Return the cosine drawn by u in [0, 1]; u = 1 is straight on."""
    return 2 * np.asarray(u, float) - 1


def sample_henyey_greenstein(u, anisotropy: float) -> np.ndarray:
    """Return the cosine drawn by u in [0, 1]; u = 1 is straight on."""
    u, g = np.asarray(u, float), anisotropy
    if abs(g) < 1e-4:  # the inverse divides by g; this is its series, exact to g^2
        return 2 * u - 1 + 6 * g * u * (1 - u)
    s = (1 - g * g) / (1 - g + 2 * g * u)
    return (1 + g * g - s * s) / (2 * g)


def sample_rayleigh(u) -> np.ndarray:
    """Return the cosine drawn by u in [0, 1]: the real root of c^3 + 3 c + 4 - 8 u = 0 (Frisvad, JOSA A 28 (2011) 2436)."""
    half = 2 * (2 * np.asarray(u, float) - 1)
    root = np.cbrt(half + np.sqrt(half * half + 1))
    return root - 1 / root


class Table:
    """A phase function given at angles: linear in the cosine between them, normalised, sampled exactly.

    Parameters
    ----------
    angles_rad : array (n,)
        Scattering angles from 0 to pi, ascending, n >= 2.
    values : array (n,)
        In any unit, not negative, not all zero.

    Raises
    ------
    ValueError
        If angles do not ascend from 0 to pi, or values are negative, not finite or all zero.
    """

    def __init__(self, angles_rad: np.ndarray, values: np.ndarray) -> None:
        angles, values = np.asarray(angles_rad, float), np.asarray(values, float)
        if angles.ndim != 1 or angles.size < 2 or angles.shape != values.shape:
            raise ValueError(f"a phase table needs as many values as angles, at least two; got {values.shape}, {angles.shape}")
        if abs(angles[0]) > 1e-9 or abs(angles[-1] - np.pi) > 1e-6 or not (np.diff(angles) > 0).all():
            raise ValueError("the angles of a phase table must ascend from 0 to pi")
        if not np.isfinite(values).all() or (values < 0).any() or not values.any():
            raise ValueError("the values of a phase table must be finite, not negative and not all zero")
        self._cosines = np.cos(angles)[::-1].copy()
        self._cosines[[0, -1]] = -1, 1
        reversed_values = values[::-1]
        mass = np.diff(self._cosines) * (reversed_values[1:] + reversed_values[:-1]) / 2
        self._values = reversed_values / (2 * np.pi * mass.sum())
        self._cumulative = np.append(0, np.cumsum(mass)) / mass.sum()

    def value(self, cosine) -> np.ndarray:
        """Return the phase function, 1/sr."""
        return np.interp(cosine, self._cosines, self._values)

    def sample(self, u) -> np.ndarray:
        """Return the cosine drawn by u in [0, 1]: the distribution's inverse, a quadratic in each interval."""
        u = np.asarray(u, float)
        i = np.clip(np.searchsorted(self._cumulative, u, side="right") - 1, 0, len(self._cosines) - 2)
        start, width = self._cosines[i], self._cosines[i + 1] - self._cosines[i]
        a, b = self._values[i], self._values[i + 1]
        wanted = np.clip((u - self._cumulative[i]) / (2 * np.pi * width), 0, None)  # in [0, (a + b)/2]
        root = np.sqrt(np.clip(a * a + 2 * (b - a) * wanted, 0, None))
        with np.errstate(invalid="ignore", divide="ignore"):
            t = np.where(a + root > 0, 2 * wanted / (a + root), 0.0)
        return start + width * np.clip(t, 0, 1)

    def mean_cosine(self) -> float:
        """Return the asymmetry g, the mean of the cosine, exact for the piecewise linear table."""
        c0, c1, a, b = self._cosines[:-1], self._cosines[1:], self._values[:-1], self._values[1:]
        return float((2 * np.pi * (c1 - c0) * (a * (2 * c0 + c1) + b * (c0 + 2 * c1)) / 6).sum())
