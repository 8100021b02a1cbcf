# SPDX-License-Identifier: GPL-3.0-or-later
"""The index of refraction of water against wavelength, temperature and salt, absolute or relative to air.

Published indices are relative to vacuum. A drop hangs in air: divide by the index of air, which moves the primary bow out by
0.05 degrees and the secondary in by 0.10.

Sources: Daimon and Masumura, Appl. Opt. 46 (2007) 3811, 20.0 C; IAPWS R9-97 (temperature); Kell, J. Chem. Eng. Data 20 (1975)
97 (density); Quan and Fry, Appl. Opt. 34 (1995) 3477 (salt).
"""

from __future__ import annotations

import numpy as np

from opal_kernels.optics import dispersion

_DAIMON_A = (0.5684027565, 0.1726177391, 0.02086189578, 0.1130748688)
_DAIMON_B = (5.101829712e-3, 1.821153936e-2, 2.620722293e-2, 10.69792721)
_IAPWS = (0.244257733, 9.74634476e-3, -3.73234996e-3, 2.68678472e-4, 1.58920570e-3, 2.45934259e-3, 0.900704920, -1.66626219e-2)


def daimon(wavelengths_nm) -> np.ndarray:
    """Return the absolute index of pure water at 20.0 C, valid for 182-1129 nm."""
    return dispersion.sellmeier(wavelengths_nm, b=_DAIMON_A, c=_DAIMON_B)


def density(celsius: float) -> float:
    """Return the density of pure water at atmospheric pressure, kg/m3 (Kell 1975, 0-100 C)."""
    t = celsius
    top = 999.83952 + t * (16.945176 + t * (-7.9870401e-3 + t * (-46.170461e-6 + t * (105.56302e-9 - 280.54253e-12 * t))))
    return top / (1 + 16.879850e-3 * t)


def iapws(wavelengths_nm, celsius: float, kg_m3: float | None = None) -> np.ndarray:
    """Return the absolute index of pure water (IAPWS R9-97), valid for 200-1100 nm and -12 to 500 C."""
    r = (density(celsius) if kg_m3 is None else kg_m3) / 1000
    t = (celsius + 273.15) / 273.15
    l2 = (np.asarray(wavelengths_nm, float) / 589.0) ** 2
    a = _IAPWS
    ratio = a[0] + a[1] * r + a[2] * t + a[3] * l2 * t + a[4] / l2 + a[5] / (l2 - 0.2292020**2) + a[6] / (l2 - 5.432937**2) + a[7] * r * r
    ratio = ratio * r  # (n^2 - 1)/(n^2 + 2)
    return np.sqrt((1 + 2 * ratio) / (1 - ratio))


def salt_shift(wavelengths_nm, celsius: float, salinity: float) -> np.ndarray:
    """Return by how much sea salt (in parts per thousand by mass) raises the index."""
    nm, t = np.asarray(wavelengths_nm, float), celsius
    return salinity * (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t + 0.01155 / nm)


def index(wavelengths_nm, celsius: float = 20.0, salinity: float = 0.0, in_air: bool = True) -> np.ndarray:
    """Return the index of a drop at wavelengths (nm).

    Parameters
    ----------
    wavelengths_nm : array
        360-830 nm.
    celsius : float
        Temperature, 0-100. At 20.0 exactly Daimon's formula is used, else that of IAPWS; they agree within 1e-5 at 360-830 nm.
    salinity : float
        Parts per thousand; sea water has 35.
    in_air : bool
        Relative to standard air (default) or to vacuum.

    Raises
    ------
    ValueError
        If the temperature or the salinity is out of range.
    """
    if not 0 <= celsius <= 100:
        raise ValueError(f"liquid water needs a temperature of 0 to 100 C, not {celsius}")
    if not 0 <= salinity <= 300:
        raise ValueError(f"a salinity must lie between 0 and 300 parts per thousand, not {salinity}")
    n = daimon(wavelengths_nm) if celsius == 20.0 else iapws(wavelengths_nm, celsius)
    n = n + salt_shift(wavelengths_nm, celsius, salinity)
    return n / dispersion.air(wavelengths_nm) if in_air else n
