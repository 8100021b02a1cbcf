# SPDX-License-Identifier: GPL-3.0-or-later
"""A rainbow as a medium: the phase function of water drops as a table that the tracer can sample.

The diffraction lobe, half of all scattered light in a fraction of a degree round the forward direction, is left out: that light goes
on as if nothing had happened. A medium's extinction then counts what drops take by geometry alone (PHYSICS §4, scene iii).
The sun's disc is not folded in: the tracer samples it as a light.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from .descriptions import Phase, PhaseKind

FIRST_NM, LAST_NM, STEP_NM = 380.0, 780.0, 10.0
_FINE_FROM, _FINE_TO = np.radians(100.0), np.radians(170.0)


def angles() -> np.ndarray:
    """The table's scattering angles, radians: 0.05° where bows of the first two orders can lie, 0.5° elsewhere."""
    coarse, fine = np.radians(0.5), np.radians(0.05)
    return np.concatenate(
        [
            np.arange(0.0, _FINE_FROM - fine / 2, coarse),
            np.arange(_FINE_FROM, _FINE_TO - fine / 2, fine),
            np.linspace(_FINE_TO, np.pi, 21),
        ]
    )


@lru_cache(maxsize=16)
def _table(theory: str, radius_um: float, spread: float, flattening: float) -> tuple[np.ndarray, np.ndarray]:
    return _compute(theory, radius_um, spread, flattening, None)


def _compute(
    theory: str, radius_um: float, spread: float, flattening: float, progress: Callable[[float], bool | None] | None
) -> tuple[np.ndarray, np.ndarray]:
    from .optics import rainbow

    wavelengths = np.arange(FIRST_NM, LAST_NM + 0.5 * STEP_NM, STEP_NM)
    values = rainbow.phase_function(
        theory,
        radius_um,
        wavelengths,
        angles(),
        spread,
        diffraction=False,
        flattening=flattening if theory == "DROPLET" else 0.0,
        progress=progress,
    )
    return wavelengths, values


def phase(theory: str, radius_um: float, spread: float = 0.05, flattening: float = 0.0) -> Phase:
    """The phase function of drops for unpolarised light, as a table.

    Parameters
    ----------
    theory : str
        One of `optics.rainbow.THEORIES`.
    radius_um : float
        Mean radius in µm.
    spread : float
        Relative width of the size distribution.
    flattening : float
        ``DROPLET`` only: 0 spheres, 1 the shape of falling drops.

    Raises
    ------
    ValueError
        If an argument is out of range, in one sentence.
    """
    wavelengths, values = _table(theory, float(radius_um), float(spread), float(flattening))
    return Phase(kind=PhaseKind.TABLE, wavelengths=wavelengths, angles=angles(), values=values.mean(axis=0))
