# SPDX-License-Identifier: GPL-3.0-or-later
"""Airy's bow: the cubic wavefront at the caustic, with supernumeraries, in both polarisations, for k = 1 and 2
(and for the fifth order, whose bow lies in the dark band).

With x = 2 pi a/lambda, delta = D - D_k into the bright side and h of van de Hulst, X = delta x^(2/3)/h^(1/3), and

    d sigma_j/d Omega = a^2 2 pi sin i x^(1/3) h^(-2/3)/sin theta [t0^2 Ai^2(-X) + t1^2 (x h)^(-2/3) Ai'^2(-X)]

with the signed amplitude factor t_j(b) = (1 - r_j^2) r_j^k at the caustic (t0) and its slope in b = sin i there (t1). The second
term is the linear change of the amplitude across the wavefront, a quarter period out of phase; it is small for the perpendicular
component and most of the parallel one, whose r changes sign near the caustic.

Away from the caustic the cubic no longer holds: two degrees from it the rays bring 8 (perpendicular) and 11 per cent (parallel) less
than Airy's mean in the primary, 22 and 8 in the secondary. In tables the mean is led
back to theirs (`ray_ratio`), and far away the order is its rays; `bow` is Airy's formula alone. Sources: Airy, Trans. Camb. Phil.
Soc. 6 (1838) 379; van de Hulst 1957, 13.23; Konnen and de Boer, Appl. Opt. 18 (1979) 1961 (the parallel supernumeraries).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from opal_kernels.optics.rainbow import background, geometric
from opal_kernels.optics.rainbow.airy_function import squares
from opal_kernels.optics.rainbow.folded_bow import DARK_POINTS, POINTS, SINGLE_POINTS, Fold, sum_of_sizes

# Over which distance from the caustic Airy's intensity gives way to that of rays.
_BLEND = {1: (np.radians(14), np.radians(24)), 2: (np.radians(6), np.radians(14)), 5: (np.radians(2), np.radians(6))}


@lru_cache(maxsize=4096)
def caustic(n: float, k: int) -> tuple[float, float, float, np.ndarray, np.ndarray]:
    """Return (D_k, sin i, h, t0, t1) of order k; t0 and t1 have (perpendicular, parallel)."""
    sine = float(np.sin(geometric.caustic_incidence(n, k)))
    step = 1e-5
    after, before = (np.array(geometric.amplitudes(sine + s, n, k)) for s in (step, -step))
    middle = np.array(geometric.amplitudes(sine, n, k))
    return float(geometric.caustic_deviation(n, k)), sine, float(geometric.curvature(n, k)), middle, (after - before) / (2 * step)


def bow(angles_rad: np.ndarray, n: float, x: float, k: int) -> np.ndarray:
    """Return one bow (2, n_angles), 1/sr per unit of light on the drop: d sigma/d Omega over pi a^2, at every angle.

    Parameters
    ----------
    angles_rad : array (n_angles,)
        Scattering angles in (0, pi).
    n : float
        Index relative to air, 1 < n < k + 1.
    x : float
        Size parameter; below about 500 use Lorenz-Mie.
    k : int
        Internal reflections, 1 and up.
    """
    d_k, sine, h, t0, t1 = caustic(n, k)
    delta = _delta(angles_rad, d_k)
    ai2, slope2 = squares(delta * x ** (2 / 3) / h ** (1 / 3))
    scale = 2 * sine * x ** (1 / 3) * h ** (-2 / 3) / np.sin(geometric.fold(d_k))
    return scale * (t0[:, None] ** 2 * ai2 + t1[:, None] ** 2 * (x * h) ** (-2 / 3) * slope2)


@lru_cache(maxsize=512)
def as_fold(n: float, k: int) -> Fold:
    """Return Airy's bow as a fold whose curves are constants, so that many sizes are summed at once: its `intensity` is `bow`."""
    d_k, sine, h, t0, t1 = caustic(n, k)
    scale = h ** (-1 / 3)
    factor = 2 * sine * h ** (-2 / 3) / (np.pi * np.sin(geometric.fold(d_k)))
    sums, differences = factor * t0**2 / np.sqrt(scale), factor * t1**2 * np.sqrt(scale) * h ** (-2 / 3)
    curves = np.repeat(np.concatenate([sums, differences, [scale]])[:, None], DARK_POINTS + POINTS, axis=1)
    rising = int(d_k // np.pi) % 2 == 0
    return Fold(float(geometric.fold(d_k)), 1.0 if rising else -1.0, np.pi, curves, (np.pi, 2 * np.pi), np.zeros((2, SINGLE_POINTS)))


def _delta(angles_rad: np.ndarray, d_k: float) -> np.ndarray:
    """Distance from the caustic into the bright side: D grows with theta in odd half turns, falls in even ones."""
    rising = int(d_k // np.pi) % 2 == 0
    folded = float(geometric.fold(d_k))
    return (np.asarray(angles_rad) - folded) if rising else (folded - np.asarray(angles_rad))


def _share(angles_rad: np.ndarray, n: float, k: int) -> np.ndarray:
    """Airy's share of order k at angles: 1 at the caustic and in its shadow, 0 far into the bright side, smooth between."""
    first, last = _BLEND[k]
    t = np.clip((_delta(angles_rad, caustic(n, k)[0]) - first) / (last - first), 0, 1)
    return 1 - t * t * (3 - 2 * t)


@lru_cache(maxsize=512)
def ray_ratio(n: float, k: int) -> tuple[np.ndarray, np.ndarray]:
    """Return (delta, ratio (2, m)): the intensity of the two rays over the mean of Airy's, from 1 at the caustic on."""
    d_k, sine, h, t0, t1 = caustic(n, k)
    b = np.concatenate([sine - (sine - 0.02) * np.linspace(1, 0, 1500) ** 2, sine + (1 - sine) * np.linspace(0, 1, 1500)[1:] ** 2])
    angle = geometric.deviation(b, n, k)
    slope = 2 / np.sqrt(np.clip(1 - b**2, 1e-12, None)) - 2 * (k + 1) / np.sqrt(n * n - b**2)
    power = np.array(geometric.amplitudes(b, n, k)) ** 2 * b / (np.sin(geometric.fold(angle)) * np.abs(slope) + 1e-12)
    inner, outer = slice(1499, None, -1), slice(1499, None)
    last = _BLEND[k][1]
    delta = np.linspace(0, 1, 400)[1:] ** 2 * last
    rays = np.array([sum(np.interp(delta, angle[side] - d_k, row[side]) for side in (inner, outer)) for row in power])
    mean = 2 * sine * np.sqrt(delta) / (2 * np.pi * np.sin(geometric.fold(d_k)) * h)
    mean = mean * (t0[:, None] ** 2 * h**0.5 / delta + t1[:, None] ** 2 / h**0.5)
    ratio = rays / np.pi / mean
    fit = (delta > np.radians(0.5)) & (delta < np.radians(4))
    for row in ratio:  # next to the caustic both grow without bound: there a line through 1
        line = np.sum(delta[fit] * (row[fit] - 1)) / np.sum(delta[fit] ** 2)
        near = delta < np.radians(0.5)
        row[near] = 1 + line * delta[near]
    return delta, ratio


class Drop:
    """All that Airy's theory needs of one index, so that sizes share it."""

    def __init__(self, n: float) -> None:
        self._n = n
        self._bows = [k for k in background.WAVES if 1 < n < k + 1]
        self._densities = background.orders(n)
        self._rays = sum(self._densities[k] * (1 - _share(background.CENTRES, n, k) if k in self._bows else 1) for k in background.WAVES)

    def _airy(self, angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
        total = np.zeros((2, len(angles_rad)))
        for k in self._bows:
            delta = _delta(angles_rad, caustic(self._n, k)[0])
            near = np.flatnonzero((delta > -np.radians(25)) & (delta < _BLEND[k][1]))
            if near.size == 0:
                continue
            one = as_fold(self._n, k)
            at, angles = np.zeros(sizes.size), np.full(sizes.size, one.angle)
            intensity = sum_of_sizes([one], at, angles, sizes, share, angles_rad[near])
            grid, ratio = ray_ratio(self._n, k)
            intensity *= [np.interp(delta[near], grid, row, left=1.0) for row in ratio]
            total[:, near] += _share(angles_rad[near], self._n, k) * intensity
        return total

    def scattered(self, angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
        """Return (2, n_angles), 1/sr per unit of light on the drops: bows and background, no diffraction lobe; integral 1.

        `sizes` are size parameters, `share` their part of the drops' cross-section (sum 1).
        """
        bows = self._rays + self._airy(background.CENTRES, sizes, share) + background.edge(background.CENTRES, sizes, share)
        rest = self._rays + background.closed(self._densities, bows, background.WAVES)
        grazing = background.edge(angles_rad, sizes, share)
        return background.at(angles_rad, rest) + self._airy(np.asarray(angles_rad, float), sizes, share) + grazing
