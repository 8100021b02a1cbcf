# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectra of lamps: standard illuminants, black bodies, and lines. All at 360-830 nm in 1 nm steps.

Every function returns relative spectral power scaled to luminance 1, so that exchanging one lamp's spectrum for another
changes its colour and not its brightness. Sources: CIE 15:2018, CIE S 014-2, and `data/illuminants.csv`.
"""

from __future__ import annotations

import numpy as np

from opal_kernels import data
from opal_kernels.optics import colour

SODIUM_D_NM = ((588.995, 2.0), (589.592, 1.0))  # NIST ASD: D2 and D1, intensities 2 : 1


def _luminance_one(spectrum: np.ndarray) -> np.ndarray:
    return spectrum / colour.xyz(spectrum)[1]


def blackbody(kelvin: float) -> np.ndarray:
    """Return a black body's spectrum (471,) of luminance 1. Raises ValueError unless kelvin > 0."""
    return _luminance_one(colour.planck(kelvin))


def line(wavelength_nm: float) -> np.ndarray:
    """Return a monochromatic spectrum (471,) of luminance 1, its power shared by the two samples nearest the line.

    Raises
    ------
    ValueError
        If the wavelength lies outside 360-830 nm.
    """
    if not colour.FIRST_NM <= wavelength_nm <= colour.LAST_NM:
        raise ValueError(f"a line must lie in 360-830 nm, not at {wavelength_nm} nm")
    spectrum = np.clip(1 - np.abs(colour.WAVELENGTHS_NM - wavelength_nm), 0, None)
    return _luminance_one(spectrum)


def sodium() -> np.ndarray:
    """Return the yellow doublet of a low-pressure sodium lamp (471,), luminance 1."""
    return _luminance_one(sum(weight * line(nm) / colour.xyz(line(nm)).sum() for nm, weight in SODIUM_D_NM))


def tabulated(name: str) -> np.ndarray:
    """Return ``a``, ``f2``, ``f11`` or ``led`` of `data/illuminants.csv` (471,), luminance 1."""
    table = data.columns("illuminants")
    return _luminance_one(colour.resample(table["nm"], table[name], outside=0.0))


LAMPS = {
    "D65": lambda: colour.white().copy(),
    "A": lambda: tabulated("a"),
    "F2": lambda: tabulated("f2"),
    "F11": lambda: tabulated("f11"),
    "LED": lambda: tabulated("led"),
    "SODIUM": sodium,
}


def lamp(name: str) -> np.ndarray:
    """Return the spectrum (471,) of a named lamp of `LAMPS`, luminance 1.

    Raises
    ------
    KeyError
        If the name is unknown.
    """
    return LAMPS[name]()
