# SPDX-License-Identifier: GPL-3.0-or-later
"""One drop's light as the sum of waves that Sadeghi et al. describe: every patch of every family, for any shape, none added as power.

ACM TOG 31(1) (2012), section 4.1, by `wavefront` and `patches`. `DROPLET`'s tables do better where they can: for nearly round drops each bow is the
uniform approximation of its two rays, which holds at the caustic and beyond; only flatter drops' bows are patches, and families add as power, because
between families the fringes are narrower than the sun. This module is for checking that: at a caustic its rays have no wave, and their
intensity grows without bound with the grid.
"""

from __future__ import annotations

import numpy as np

from opal_kernels.optics.rainbow import patches, wavefront
from opal_kernels.optics.rainbow.drop_shapes import SPHERE, Surface

FAMILIES = (-1, 0, 1, 2)
"""Reflected outside, passed through, primary, secondary."""


def intensity(
    angles_rad: np.ndarray,
    n: float,
    x: float,
    surface: Surface = SPHERE,
    sun_elevation_rad: float = 0.0,
    clock_rad: float = 0.0,
    families: tuple[int, ...] = FAMILIES,
    rows: int = 385,
    columns: int = 64,
) -> np.ndarray:
    """Return the summed waves of one drop (2, n_angles), 1/sr per unit of light on it: perpendicular and parallel, their mean for the sun's light.

    Parameters
    ----------
    angles_rad : array (n_angles,)
        Scattering angles, ascending, in (0, pi).
    n, x : float
        Index relative to air, and the size parameter of the equal-volume radius.
    surface : Surface
        Of `drop_shapes`: `SPHERE`, `falling(diameter_mm)`, a spheroid.
    sun_elevation_rad, clock_rad : float
        Height of the sun, and the place on the bow from its top (0) to its feet (pi/2).
    families : tuple of int
        Orders whose waves are added.
    rows, columns : int
        Of the grid of rays over the drop's shadow.
    """
    angles = np.asarray(angles_rad, float)
    waves = wavefront.trace(surface, n, sun_elevation_rad, families, rows, columns)
    hits = [patches.Patches(waves[k]).hits(clock_rad, angles) for k in families]
    return (np.abs(patches.together(*hits).field(x, angles.size)) ** 2).sum(axis=1)
