# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed forms for light in homogeneous media: what the tracer's estimates are held to.

Lengths in metres and coefficients in 1/m, or both in any other unit that fits. Sources: Chandrasekhar, Radiative Transfer
(1950); Sun, Ramamoorthi, Narasimhan and Nayar, "A Practical Analytic Single Scattering Model", 2005 (airlight).
"""

from __future__ import annotations

import numpy as np


def transmittance(extinction, length) -> np.ndarray:
    """Return exp(-sigma d), Beer and Lambert."""
    return np.exp(-np.asarray(extinction, float) * length)


def coated_slab(n: float, optical_depth: float) -> tuple[float, float]:
    """Return (T, R) of an absorbing plate at normal incidence with all its inner reflections, incoherently summed."""
    r = ((n - 1) / (n + 1)) ** 2
    t = np.exp(-optical_depth)
    inside = 1 - (r * t) ** 2
    return float((1 - r) ** 2 * t / inside), float(r + (1 - r) ** 2 * r * t * t / inside)


def single_scattering_slab(optical_depth: float, mu0: float, mu: float, phase: float = 1 / (4 * np.pi)) -> tuple[float, float]:
    """Return radiance (reflected, transmitted) of a slab after one scattering, per albedo and irradiance of the beam.

    Parameters
    ----------
    optical_depth : float
        Across the slab, along its normal.
    mu0, mu : float
        Cosines of the beam and of the view with the normal, in (0, 1].
    phase : float
        The phase function at the angle between them, 1/sr.
    """
    reflected = phase * mu0 / (mu + mu0) * -np.expm1(-optical_depth * (1 / mu + 1 / mu0))
    if abs(mu0 - mu) < 1e-6 * mu0:
        transmitted = phase * optical_depth / mu0 * np.exp(-optical_depth / mu0)
    else:
        transmitted = phase * mu0 / (mu0 - mu) * (np.exp(-optical_depth / mu0) - np.exp(-optical_depth / mu))
    return float(reflected), float(transmitted)


def airlight(distance: float, start: float, end: float, extinction: float = 0.0, nodes: int = 2000) -> float:
    """Return the radiance a ray gathers by one isotropic scattering of a point light, per intensity and scattering coefficient.

    In equiangular steps (Kulla and Fajardo 2012), which make the integrand smooth: without extinction it is constant.

    Parameters
    ----------
    distance : float
        Of the light from the ray's line, above zero.
    start, end : float
        Ends of the ray, measured from the foot of the light's perpendicular; the camera is at `start`.
    extinction : float
        1/m.
    nodes : int
        Midpoints of the quadrature.
    """
    first, last = np.arctan(start / distance), np.arctan(end / distance)
    angle = first + (last - first) * (np.arange(nodes) + 0.5) / nodes
    way = distance / np.cos(angle) + distance * np.tan(angle) - start
    return float((last - first) / (4 * np.pi * distance) * np.exp(-extinction * way).mean())


def attenuation_rate(albedo: float) -> float:
    """Return the asymptotic decay rate k (per optical depth) of isotropic scattering: albedo/(2k) ln((1+k)/(1-k)) = 1.

    Raises
    ------
    ValueError
        If the albedo is not in (0, 1).
    """
    if not 0 < albedo < 1:
        raise ValueError(f"the albedo must lie between 0 and 1, not {albedo}")
    low, high = 1e-12, 1 - 1e-15
    for _ in range(200):
        k = (low + high) / 2
        if albedo * np.arctanh(k) / k < 1:
            low = k
        else:
            high = k
    return (low + high) / 2


def sphere_multiplier(reflectance: float) -> float:
    """Return by how much a closed diffuse sphere multiplies the light on its wall: 1/(1 - rho)."""
    return 1 / (1 - reflectance)


def chandrasekhar_h(mu, albedo: float, nodes: int = 64) -> np.ndarray:
    """Return Chandrasekhar's H function of isotropic scattering at cosines mu in [0, 1].

    By iteration of 1/H = sqrt(1 - albedo) + (albedo/2) int_0^1 mu' H(mu')/(mu + mu') dmu' (Radiative Transfer, section 40) on
    Gauss-Legendre nodes, which converges to the physical solution.

    Raises
    ------
    ValueError
        If the albedo is not in [0, 1].
    """
    if not 0 <= albedo <= 1:
        raise ValueError(f"the albedo must lie between 0 and 1, not {albedo}")
    x, w = np.polynomial.legendre.leggauss(nodes)
    x, w = (x + 1) / 2, w / 2
    h = np.ones(nodes)
    kernel = x * w / (x[:, None] + x)
    for _ in range(2000):
        following = 1 / (np.sqrt(1 - albedo) + albedo / 2 * kernel @ h)
        following = (following + h) / 2  # the plain iteration swings about the solution when nothing is absorbed
        if np.abs(following - h).max() < 1e-13:
            break
        h = following
    mu = np.asarray(mu, float)
    return 1 / (np.sqrt(1 - albedo) + albedo / 2 * (x * w * h / (mu[..., None] + x)).sum(axis=-1))


def half_space_albedo(mu0, albedo: float) -> np.ndarray:
    """Return the reflected fraction of a beam (cosine mu0 with the normal) on a half-space: 1 - H(mu0) sqrt(1 - albedo)."""
    return 1 - chandrasekhar_h(mu0, albedo) * np.sqrt(1 - albedo)


def half_space_diffuse_albedo(albedo: float, nodes: int = 64) -> float:
    """Return the reflected fraction of diffuse light on a half-space, 2 int mu A(mu) dmu."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    x, w = (x + 1) / 2, w / 2
    return float((2 * x * half_space_albedo(x, albedo) * w).sum())
