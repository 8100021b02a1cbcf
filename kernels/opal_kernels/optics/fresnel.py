# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflection and refraction at a smooth boundary of two clear media.

Convention: `eta` is the index behind the boundary over the index before it, as seen by the incoming light; `cos_i` is the
cosine of the angle of incidence, 0 to 1. s is perpendicular to the plane of incidence, p parallel. Amplitudes follow
r_p = (n2 cos_i - n1 cos_t)/(n2 cos_i + n1 cos_t): both are equal in size and opposite in sign at normal incidence.

Source: Born and Wolf, Principles of Optics, 1.5; Schlick, "An Inexpensive BRDF Model", 1994.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def amplitudes(cos_i, eta) -> tuple[np.ndarray, np.ndarray]:
    """Return the complex amplitude reflectances (r_s, r_p); of modulus 1 under total internal reflection."""
    cos_i, eta = np.asarray(cos_i, float), np.asarray(eta, float)
    # (1 - cos^2)/eta^2 may exceed 1: the cosine is then imaginary and the wave behind the boundary evanescent.
    cos_t = np.sqrt(np.asarray(1 - (1 - cos_i**2) / eta**2, complex))
    return (cos_i - eta * cos_t) / (cos_i + eta * cos_t), (eta * cos_i - cos_t) / (eta * cos_i + cos_t)


def polarised_reflectance(cos_i, eta) -> tuple[np.ndarray, np.ndarray]:
    """Return the reflected fractions of power (R_s, R_p)."""
    r_s, r_p = amplitudes(cos_i, eta)
    return np.abs(r_s) ** 2, np.abs(r_p) ** 2


def reflectance(cos_i, eta) -> np.ndarray:
    """Return the reflected fraction of unpolarised power. For a chain of boundaries use `chain` instead."""
    r_s, r_p = polarised_reflectance(cos_i, eta)
    return (r_s + r_p) / 2


def schlick(cos_i, eta) -> np.ndarray:
    """Return Schlick's approximation, with the cosine on the side of the lower index; 1 beyond the critical angle."""
    cos_i, eta = np.broadcast_arrays(np.asarray(cos_i, float), np.asarray(eta, float))
    sin2_t = (1 - cos_i**2) / eta**2
    cos_low = np.where(eta >= 1, cos_i, np.sqrt(np.clip(1 - sin2_t, 0, None)))
    normal = ((eta - 1) / (eta + 1)) ** 2
    return np.where(sin2_t >= 1, 1.0, normal + (1 - normal) * (1 - cos_low) ** 5)


def total_reflection_phases(cos_i, eta) -> tuple[np.ndarray, np.ndarray]:
    """Return (delta_s, delta_p), radians in [0, pi]: tan(delta/2) of Born and Wolf 1.5.4; 0 where light gets through."""
    cos_i, eta = np.asarray(cos_i, float), np.asarray(eta, float)
    root = np.sqrt(np.clip(1 - cos_i**2 - eta**2, 0, None))
    return 2 * np.arctan2(root, cos_i), 2 * np.arctan2(root, eta**2 * cos_i)


def chain(events: Sequence[tuple[str, float, float]]) -> float:
    """Return the unpolarised power left after boundaries that share one plane of incidence.

    Each component is followed through and the two are averaged at the end; averaging at every boundary is wrong by 12 % for
    a primary rainbow.

    Parameters
    ----------
    events : sequence of (kind, cos_i, eta)
        `kind` is ``"R"`` (reflected) or ``"T"`` (transmitted).

    Raises
    ------
    ValueError
        If a kind is neither R nor T.
    """
    power = np.ones(2)
    for kind, cos_i, eta in events:
        reflected = np.array(polarised_reflectance(cos_i, eta))
        if kind not in ("R", "T"):
            raise ValueError(f"an event is R or T, not {kind!r}")
        power *= reflected if kind == "R" else 1 - reflected
    return float(power.mean())


def diffuse_reflectance(eta: float, samples: int = 20000) -> float:
    """Return the reflected fraction of diffuse unpolarised light: the integral of 2 cos R(cos), by midpoints in cos^2."""
    cos_i = np.sqrt((np.arange(samples) + 0.5) / samples)
    return float(reflectance(cos_i, eta).mean())
