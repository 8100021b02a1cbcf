# SPDX-License-Identifier: GPL-3.0-or-later
"""Descartes' bow: rays only. Two ways of turning an angle into a colour, as a report of 2013 did.

`solved_table`   from the angle to the index that has its caustic there, from the index to the wavelength: every wavelength is a
                 line at its own caustic angle, with the light that rays bring to within a degree of it.
`sampled_table`  every wavelength spreads from its caustic as rays do, by the inverse root of the distance.

Any order k is in `geometric.py`; the tables hold k = 1 and 2 and the geometric background. No supernumeraries: rays do not
interfere. Source: Descartes, Les Meteores (1637); van de Hulst 1957, 13.2.
"""

from __future__ import annotations

import numpy as np

from opal_kernels.optics.rainbow import background, geometric

_LINE_HALF_WIDTH = np.radians(0.1)
_BOW_WIDTH = np.radians(1.0)


def wavelength_at(angle_rad: np.ndarray, k: int, wavelengths_nm: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Return the wavelength (nm) whose bow of order k lies at an angle; NaN where none does.

    Parameters
    ----------
    angle_rad : array
        Deviation D, radians: pi - radius for the primary, pi + radius for the secondary.
    k : int
        Order, 1 and up.
    wavelengths_nm, index : arrays (n,)
        The liquid's index, falling with ascending wavelength.
    """
    n = geometric.index_of_deviation(angle_rad, k)
    order = np.argsort(index)
    return np.interp(n, np.asarray(index)[order], np.asarray(wavelengths_nm)[order], left=np.nan, right=np.nan)


def sampled_table(n: float) -> np.ndarray:
    """Return the density (2, 3600) at `background.CENTRES` of all rays, 1/sr per unit of light on the drop."""
    densities = background.orders(n)
    bows = sum(densities[k] for k in background.BOWS)
    return bows + background.closed(densities, bows)


def solved_table(n: float) -> np.ndarray:
    """Return the density (2, 3600) with each bow's light within a degree of its caustic drawn to a line there."""
    densities = background.orders(n)
    bows = np.zeros_like(densities[1])
    for k in background.BOWS:
        caustic = float(geometric.fold(geometric.caustic_deviation(n, k)))
        if np.isnan(caustic):  # an index above k + 1 has no bow of this order
            bows += densities[k]
            continue
        near = np.abs(background.CENTRES - caustic) < _BOW_WIDTH
        power = (densities[k] * near * background.SOLID_ANGLES).sum(axis=1, keepdims=True)
        line = np.sqrt(np.clip(1 - ((background.CENTRES - caustic) / _LINE_HALF_WIDTH) ** 2, 0, None))
        bows += densities[k] * ~near + power * line / (line * background.SOLID_ANGLES).sum()
    return bows + background.closed(densities, bows)
