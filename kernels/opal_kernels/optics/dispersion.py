# SPDX-License-Identifier: GPL-3.0-or-later
"""Index of refraction against wavelength, and what jewellers and opticians read from it.

Wavelengths are nm at every door and µm inside the formulas. Formulas take coefficients by keyword, as `data/species.toml`
names them; `FORMULAS` holds them by name, so a new one is one function and one row.

Sources: Born and Wolf, Principles of Optics, 2.3.4 (Sellmeier, Cauchy); Schott TIE-29 (Abbe number); lines after Fraunhofer.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

# Fraunhofer lines, nm. Gemmology quotes dispersion between B and G, optics between F and C.
LINE_A, LINE_B, LINE_C, LINE_D, LINE_LOWER_D, LINE_F, LINE_G = 759.4, 686.7, 656.27, 589.3, 587.56, 486.13, 430.8

Index = Callable[[np.ndarray], np.ndarray]


def _squared_um(wavelengths_nm) -> np.ndarray:
    return (np.asarray(wavelengths_nm, float) * 1e-3) ** 2


def cauchy(wavelengths_nm, a: float, b: float = 0.0, c: float = 0.0) -> np.ndarray:
    """Return n = a + b/l^2 + c/l^4, l in µm (b in µm^2, c in µm^4)."""
    l2 = _squared_um(wavelengths_nm)
    return a + b / l2 + c / l2**2


def sellmeier(wavelengths_nm, b: Sequence[float], c: Sequence[float], c0: float = 0.0) -> np.ndarray:
    """Return n with n^2 = 1 + c0 + sum b_i l^2/(l^2 - c_i), l in µm (c_i in µm^2); NaN where n^2 is negative."""
    l2 = _squared_um(wavelengths_nm)[..., None]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(1 + c0 + (np.asarray(b, float) * l2 / (l2 - np.asarray(c, float))).sum(axis=-1))


def pole(wavelengths_nm, a: float, b: float, c: float, d: float) -> np.ndarray:
    """Return n with n^2 = a + b/(l^2 - c) - d l^2, l in µm: the form given for silicon carbide."""
    l2 = _squared_um(wavelengths_nm)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(a + b / (l2 - c) - d * l2)


FORMULAS = {"CAUCHY": cauchy, "SELLMEIER": sellmeier, "POLE": pole}


def air(wavelengths_nm) -> np.ndarray:
    """Return the index of standard air (15 C, 101325 Pa, 450 ppm CO2): Ciddor, Appl. Opt. 35 (1996) 1566, eq. 1."""
    s2 = 1 / _squared_um(wavelengths_nm)
    return 1 + 1e-8 * (5792105 / (238.0185 - s2) + 167917 / (57.362 - s2))


def cauchy_from_handbook(n_d: float, b_to_g: float) -> tuple[float, float]:
    """Return (a, b in µm^2) of the two-term Cauchy formula through n_D and the B-G dispersion that handbooks list."""
    b = b_to_g / (1 / _squared_um(LINE_G) - 1 / _squared_um(LINE_B))
    return float(n_d - b / _squared_um(LINE_D)), float(b)


def abbe_number(index: Index) -> float:
    """Return V_d = (n_d - 1)/(n_F - n_C); infinite without dispersion."""
    d, f, c = (float(n) for n in index(np.array([LINE_LOWER_D, LINE_F, LINE_C])))
    return (d - 1) / (f - c) if f != c else np.inf


def b_to_g(index: Index) -> float:
    """Return n_G - n_B, the dispersion that gemmologists quote."""
    g, b = index(np.array([LINE_G, LINE_B]))
    return float(g - b)


def critical_angle(n: float, n_outside: float = 1.0) -> float:
    """Return the angle inside, radians, beyond which all light is reflected; pi/2 where there is none."""
    return float(np.arcsin(min(n_outside / n, 1.0)))


def brewster_angle(n: float, n_outside: float = 1.0) -> float:
    """Return the angle outside, radians, at which the parallel component is not reflected."""
    return float(np.arctan2(n, n_outside))


def minimum_deviation(n: float, apex: float) -> float:
    """Return the least deviation of a prism, radians: n sin(A/2) = sin i, deviation 2i - A.

    Raises
    ------
    ValueError
        If no ray passes symmetrically, which is when n sin(A/2) exceeds 1 (diamond at 60 degrees).
    """
    sine = n * np.sin(apex / 2)
    if sine > 1:
        raise ValueError(f"no ray passes a prism of index {n:.4f} and apex {np.degrees(apex):.1f} degrees symmetrically")
    return float(2 * np.arcsin(sine) - apex)
