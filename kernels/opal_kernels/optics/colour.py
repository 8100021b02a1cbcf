# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour at the two ends: spectra to CIE 1931 XYZ and to linear Rec.709, the white, and Planck's law.

Convention: D65 is the white. A light of RGB (1, 1, 1) emits D65 scaled to luminance 1, and its image is (1, 1, 1).
Normalisation: XYZ = (1 / sum ybar) sum S cmf over 360-830 nm at 1 nm, so S = 1 has Y = 1 and, rightly, a pinkish RGB.

Sources: CIE 018:2019 (observer), CIE S 014-2 (D65), ITU-R BT.709 (primaries), CODATA 2018 (constants).
"""

from __future__ import annotations

from functools import cache

import numpy as np

from opal_kernels import data

FIRST_NM, LAST_NM = 360, 830
WAVELENGTHS_NM = np.arange(FIRST_NM, LAST_NM + 1, dtype=np.float64)
WAVELENGTHS_NM.setflags(write=False)

# Chromaticities of the Rec.709 primaries, ITU-R BT.709-6 table 1.
REC709_PRIMARIES = np.array([[0.640, 0.330], [0.300, 0.600], [0.150, 0.060]])

PLANCK = 6.62607015e-34  # J s
LIGHT_SPEED = 299792458.0  # m/s
BOLTZMANN = 1.380649e-23  # J/K


def observer() -> np.ndarray:
    """Return the CIE 1931 2-degree colour matching functions, shape (3, 471), at `WAVELENGTHS_NM`."""
    return data.array("cie1931_observer")


def d65() -> np.ndarray:
    """Return the relative power of D65, shape (471,), 100 at 560 nm."""
    return data.array("d65")


@cache
def white() -> np.ndarray:
    """Return D65 scaled to luminance 1: the spectrum of a light of RGB (1, 1, 1), shape (471,)."""
    spectrum = d65() / xyz(d65())[1]
    spectrum.setflags(write=False)
    return spectrum


@cache
def rec709_from_xyz() -> np.ndarray:
    """Return the 3x3 matrix from XYZ to linear Rec.709 whose white is exactly the tabulated D65.

    It is the usual matrix with each row scaled (by less than 2e-4) so that the table's own white is (1, 1, 1).
    """
    x, y = REC709_PRIMARIES.T
    primaries = np.array([x / y, np.ones(3), (1 - x - y) / y])
    scale = np.linalg.solve(primaries, xyz(white()))
    return np.linalg.inv(primaries * scale)


@cache
def rec709_response() -> np.ndarray:
    """Return linear Rec.709 per nm of a unit of spectral radiance, shape (3, 471): the film's three sensitivities."""
    response = rec709_from_xyz() @ observer() / observer()[1].sum()
    response.setflags(write=False)
    return response


def xyz(spectrum: np.ndarray) -> np.ndarray:
    """Integrate spectra against the CIE 1931 observer.

    Parameters
    ----------
    spectrum : array (..., 471)
        Radiance (any unit) at `WAVELENGTHS_NM`.

    Returns
    -------
    array (..., 3)
        X, Y, Z; the flat spectrum 1 has Y = 1.
    """
    return np.asarray(spectrum) @ observer().T / observer()[1].sum()


def rec709(spectrum: np.ndarray) -> np.ndarray:
    """Return the linear Rec.709 colour of spectra (..., 471) at `WAVELENGTHS_NM`; `white()` gives (1, 1, 1).

    Saturated spectra lie outside the gamut and come out with negative components; nothing is clamped.
    """
    return np.asarray(spectrum) @ rec709_response().T


def luminance(rgb: np.ndarray) -> np.ndarray:
    """Return Y of linear Rec.709 colours (..., 3)."""
    return np.asarray(rgb) @ np.linalg.inv(rec709_from_xyz())[1]


def resample(wavelengths_nm: np.ndarray, values: np.ndarray, outside: float | None = None) -> np.ndarray:
    """Return a measured curve at `WAVELENGTHS_NM`, linear between its samples.

    Parameters
    ----------
    wavelengths_nm, values : arrays (n,), n >= 1
        The samples, in any order.
    outside : float, optional
        The value outside the measured range; by default the end values hold.

    Raises
    ------
    ValueError
        If there are no samples, lengths differ, or something is not finite.
    """
    nm, values = np.asarray(wavelengths_nm, float), np.asarray(values, float)
    if nm.ndim != 1 or nm.size == 0 or nm.shape != values.shape:
        raise ValueError(f"a curve needs as many values as wavelengths, and at least one; got {values.shape} and {nm.shape}")
    if not (np.isfinite(nm).all() and np.isfinite(values).all()):
        raise ValueError("a curve must be finite at every wavelength")
    order = np.argsort(nm)
    return np.interp(WAVELENGTHS_NM, nm[order], values[order], left=outside, right=outside)


def planck(kelvin: float, wavelengths_nm: np.ndarray = WAVELENGTHS_NM) -> np.ndarray:
    """Return the spectral radiance of a black body, W/(m2 sr nm).

    Raises
    ------
    ValueError
        If the temperature is not above zero.
    """
    if not kelvin > 0:
        raise ValueError(f"a temperature must be above 0 K, not {kelvin}")
    metres = np.asarray(wavelengths_nm, float) * 1e-9
    exponent = np.minimum(PLANCK * LIGHT_SPEED / (metres * BOLTZMANN * kelvin), 700.0)
    return 2e-9 * PLANCK * LIGHT_SPEED**2 / (metres**5 * np.expm1(exponent))


def blackbody_rec709(kelvin: float) -> np.ndarray:
    """Return the linear Rec.709 colour of a black body scaled to luminance 1; 6500 K is not exactly neutral."""
    spectrum = planck(kelvin)
    return rec709(spectrum / xyz(spectrum)[1])
