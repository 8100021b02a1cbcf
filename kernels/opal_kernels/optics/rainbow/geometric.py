# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays through a spherical drop: deviations, caustics, and what each family of rays sends where.

Order k counts internal reflections: -1 is the reflection outside, 0 the light that passes, 1 and 2 the two bows. i and r are the
angles of incidence and refraction, D the total deviation, theta the scattering angle D folded to [0, pi].

Sources: Descartes 1637; van de Hulst, Light Scattering by Small Particles (1957), chapters 12 and 13.
"""

from __future__ import annotations

import numpy as np

from opal_kernels.optics import fresnel

_RINGS_END = np.radians(20)
_AT_ONCE = 200_000  # values of the lobe, so that many sizes need no more memory than few


def deviation(sine: np.ndarray, n: float, k: int) -> np.ndarray:
    """Return D (rad) of rays at sin i = impact parameter over radius."""
    i, r = np.arcsin(sine), np.arcsin(np.asarray(sine) / n)
    return np.pi - 2 * i if k < 0 else k * np.pi + 2 * i - 2 * (k + 1) * r


def fold(angle: np.ndarray) -> np.ndarray:
    """Return the scattering angle in [0, pi] of a deviation."""
    turned = np.abs(np.asarray(angle, float)) % (2 * np.pi)
    return np.minimum(turned, 2 * np.pi - turned)


def caustic_incidence(n, k: int) -> np.ndarray:
    """Return the angle of incidence (rad) of least deviation: cos i = sqrt((n^2 - 1)/(k (k + 2))); NaN where there is none."""
    with np.errstate(invalid="ignore"):
        return np.arccos(np.sqrt((np.asarray(n, float) ** 2 - 1) / (k * (k + 2))))


def caustic_deviation(n, k: int) -> np.ndarray:
    """Return the least deviation D_k (rad) of order k >= 1."""
    i = caustic_incidence(n, k)
    return k * np.pi + 2 * i - 2 * (k + 1) * np.arctan(np.tan(i) / (k + 1))


def bow_radius(n, k: int) -> np.ndarray:
    """Return the angle (rad) of the bow of order k from the antisolar point."""
    return np.pi - fold(caustic_deviation(n, k))


def index_of_deviation(angle: np.ndarray, k: int) -> np.ndarray:
    """Return the index whose bow of order k has the deviation D (rad); NaN where none has.

    D(i) = k pi + 2 i - 2 (k + 1) atan(tan i/(k + 1)) falls as i grows; it is inverted by bisection. Then
    n^2 = sin^2 i + (k + 1)^2 cos^2 i.
    """
    angle = np.asarray(angle, float)
    low, high = np.zeros_like(angle), np.full_like(angle, np.pi / 2)
    for _ in range(60):
        i = (low + high) / 2
        above = k * np.pi + 2 * i - 2 * (k + 1) * np.arctan(np.tan(i) / (k + 1)) > angle
        low, high = np.where(above, i, low), np.where(above, high, i)
    i = (low + high) / 2
    n = np.sqrt(np.sin(i) ** 2 + (k + 1) ** 2 * np.cos(i) ** 2)
    return np.where((angle <= k * np.pi) & (angle >= 0), n, np.nan)


def amplitudes(sine: np.ndarray, n: float, k: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the signed amplitude factors t_j of a path, perpendicular and parallel: (1 - r^2)(-r)^k, or r outside."""
    r_s, r_p = (r.real for r in fresnel.amplitudes(np.sqrt(1 - np.asarray(sine, float) ** 2), n))
    if k < 0:
        return r_s, r_p
    return (1 - r_s**2) * (-r_s) ** k, (1 - r_p**2) * (-r_p) ** k


def curvature(n, k: int) -> np.ndarray:
    """Return van de Hulst's h = D''/2 at the caustic, D as a function of sin i."""
    p2, n2 = (k + 1) ** 2, np.asarray(n, float) ** 2
    return (p2 - 1) ** 2 / p2 * np.sqrt((p2 - n2) / (n2 - 1) ** 3)


def energy(n: float, k: int, edges_rad: np.ndarray, rays: int = 20000) -> np.ndarray:
    """Return the fraction of the light on the drop that order k sends between scattering angles.

    Between two turning points of theta(i) the energy is a monotone function of theta, and its differences at the edges are
    exact: no ray is counted twice and no singularity sampled.

    Parameters
    ----------
    n : float
        Index.
    k : int
        Order, -1 and up.
    edges_rad : array (m,)
        Ascending in [0, pi].
    rays : int
        Sampled impact parameters.

    Returns
    -------
    array (2, m - 1)
        Perpendicular, parallel; over all orders and angles each sums to 1.
    """
    sine = np.sin(np.linspace(0, np.pi / 2, rays + 1))
    theta = fold(deviation(sine, n, k))
    power = np.array(amplitudes(np.sqrt((sine[1:] ** 2 + sine[:-1] ** 2) / 2), n, k)) ** 2 * np.diff(sine**2)
    result = np.zeros((2, len(edges_rad) - 1))
    direction = np.sign(np.diff(theta))
    turns = np.flatnonzero(direction[1:] * direction[:-1] <= 0) + 1
    for start, stop in zip(np.append(0, turns), np.append(turns, rays), strict=True):
        branch = theta[start : stop + 1]
        total = np.concatenate([np.zeros((2, 1)), np.cumsum(power[:, start:stop], axis=1)], axis=1)
        if branch[0] > branch[-1]:
            branch, total = branch[::-1], total[:, -1:] - total[:, ::-1]
        result += [np.diff(np.interp(edges_rad, branch, row)) for row in total]
    return result


def diffraction(angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Return the diffraction lobe of discs (1/sr) of several size parameters, each with its share of the light.

    A disc's is x^2/(4 pi) (2 J1(z)/z)^2 ((1 + cos)/2)^2, z = x sin theta.

    The obliquity and the end at 90 degrees take (1/pi + 1/4)/x of it away (by the mean 4/(pi z^3) of the squared lobe); that is
    given back, so that the integral is 1. Beyond the rings that anything can show the mean stands for them.
    """
    angles = np.asarray(angles_rad, float)
    sizes, share = np.asarray(sizes, float), np.asarray(share, float)
    factors = share * sizes**2 / (4 * np.pi) / np.maximum(1 - (1 / np.pi + 0.25) / sizes, 0.1)
    front = np.flatnonzero(angles < np.pi / 2)
    total = np.zeros_like(angles)
    for some in np.array_split(np.arange(sizes.size), -(-sizes.size * angles.size // _AT_ONCE)):
        z = sizes[some, None] * np.sin(angles[front])
        rings = (angles[front] < _RINGS_END) | (z < 20)
        squared = np.empty_like(z)
        near = np.maximum(z[rings], 1e-4)
        squared[rings] = (2 * _bessel_j1(near) / near) ** 2
        squared[~rings] = 4 / (np.pi * z[~rings] ** 3)
        total[front] += factors[some] @ squared
    return total * ((1 + np.cos(angles)) / 2) ** 2


def _bessel_j1(z: np.ndarray) -> np.ndarray:
    """J1 for z >= 0 by Abramowitz and Stegun 9.4.4 and 9.4.6, to 1e-8."""
    z = np.abs(np.asarray(z, float))
    t = np.minimum(z, 3.0) ** 2 / 9
    small = z * (0.5 + t * (-0.56249985 + t * (0.21093573 + t * (-0.03954289 + t * (0.00443319 + t * (-0.00031761 + t * 0.00001109))))))
    large = np.maximum(z, 3.0)
    s = 3 / large
    f = 0.79788456 + s * (1.56e-6 + s * (0.01659667 + s * (0.00017105 + s * (-0.00249511 + s * (0.00113653 - s * 0.00020033)))))
    phase = -2.35619449 + s * (0.12499612 + s * (0.0000565 + s * (-0.00637879 + s * (0.00074348 + s * (0.00079824 - s * 0.00029166)))))
    return np.where(z < 3, small, f * np.cos(large + phase) / np.sqrt(large))
