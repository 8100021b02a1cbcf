# SPDX-License-Identifier: GPL-3.0-or-later
"""Rainbows: five theories of what a drop does to light, behind one function.

DESCARTES          rays, each wavelength a line at its caustic
DESCARTES_SAMPLED  rays, each wavelength spread from its caustic
AIRY               the cubic wavefront: supernumeraries, both polarisations; for radii of 50 um and more
MIE                Lorenz-Mie theory, exact for spheres
DROPLET            a traced wavefront, for drops in the shape that falling gives them

`phase_function` gives all the same shape and units, so that charts, materials and tests need not know which they hold.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

THEORIES = ("DESCARTES", "DESCARTES_SAMPLED", "AIRY", "MIE", "DROPLET")

__all__ = ["THEORIES", "Cancelled", "phase_function"]


class Cancelled(Exception):
    """The caller's `progress` asked to stop."""


def phase_function(
    theory: str,
    radius_um: float,
    wavelengths_nm: np.ndarray,
    angles_rad: np.ndarray,
    spread: float = 0.0,
    sun_radius_rad: float = 0.0,
    *,
    distribution: str = "LOG_NORMAL",
    sizes: int | None = None,
    celsius: float = 20.0,
    salinity: float = 0.0,
    index: np.ndarray | None = None,
    diffraction: bool = True,
    flattening: float = 0.0,
    sun_elevation_rad: float = 0.0,
    clock_rad: float = 0.0,
    threads: int = 0,
    progress: Callable[[float], bool | None] | None = None,
) -> np.ndarray:
    """Return the phase function of drops in two polarisations.

    Parameters
    ----------
    theory : str
        One of `THEORIES`.
    radius_um : float
        Mean radius of the drops, µm, 0.1 to 5000.
    wavelengths_nm : array (n_wavelengths,)
        In air, nm, 200 to 1100.
    angles_rad : array (n_angles,)
        Scattering angles, 0 (forward) to pi.
    spread : float
        Standard deviation of the radii over their mean, 0 to 1.
    sun_radius_rad : float
        Angular radius of the sun's disc to smooth by; 0 for a point, 0.00465 for the sun. Give 0 where the disc is sampled as a
        light.
    distribution : str
        Of `drops.DISTRIBUTIONS`.
    sizes : int, optional
        How many radii stand for the distribution; by default enough to average Mie's ripple away.
    celsius, salinity : float
        Of the water.
    index : array (n_wavelengths,), optional
        Index of another liquid or of glass beads relative to air, above 1, instead of water's.
    diffraction : bool
        Keep the forward diffraction lobe, half of all light. Without it the rest is doubled: a medium then has extinction
        pi a^2 a drop instead of 2 pi a^2.
    flattening : float
        `DROPLET` only: 0 for spheres, 1 for the shape that a falling drop of its size has (Chuang and Beard 1990), up to 2.
    sun_elevation_rad, clock_rad : float
        `DROPLET` with flattening: height of the sun, and where on the bow, from its top (0) to its feet (pi/2).
    threads : int
        0 takes every core.
    progress : callable, optional
        Called with the fraction done; returning False stops.

    Returns
    -------
    array (2, n_wavelengths, n_angles)
        Perpendicular and parallel component, 1/sr; the integral of their mean over the sphere is 1. Unpolarised light sees the
        mean, and the degree of polarisation is (perpendicular - parallel)/(perpendicular + parallel).

    Raises
    ------
    ValueError
        If an argument is out of range, in one sentence.
    Cancelled
        If `progress` returned False.
    """
    arguments = dict(locals())
    from opal_kernels.optics.rainbow import _tables  # the theories load with the first table, not with the package

    return _tables.build(**arguments)
