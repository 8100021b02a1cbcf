# SPDX-License-Identifier: GPL-3.0-or-later
"""How large the drops are: size distributions as a few radii with weights.

Weights are numbers of drops and sum to 1; what a drop contributes to the sky grows with its cross-section, which each theory
brings in itself. Radii are spaced evenly in the logarithm. Sources: Marshall and Palmer, J. Meteorol. 5 (1948) 165; Deirmendjian
1969 (gamma); log-normal and normal by their definitions.
"""

from __future__ import annotations

import numpy as np

DISTRIBUTIONS = ("NORMAL", "LOG_NORMAL", "GAMMA", "MARSHALL_PALMER", "TWO_SIZES")
SMALL_SHARE = 0.45  # radius of the smaller of two sizes over the larger: round where those of a millimetre across are flat
LARGEST_SPREAD = 1.0
SMALLEST_UM, LARGEST_UM = 0.1, 5000.0


def quadrature(radius_um: float, spread: float, distribution: str = "LOG_NORMAL", count: int = 31) -> tuple[np.ndarray, np.ndarray]:
    """Return radii (µm) and number weights (which sum to 1) that stand for a distribution.

    Parameters
    ----------
    radius_um : float
        Mean radius, 0.1 to 5000 µm; of the larger drops with ``TWO_SIZES``.
    spread : float
        Standard deviation over the mean, 0 to 1; 0 is a single size. Marshall-Palmer's is 1 whatever is given, if not 0.
    distribution : str
        One of `DISTRIBUTIONS`.
    count : int
        How many radii.

    Raises
    ------
    ValueError
        If the radius, the spread, the name or the count is out of range.
    """
    if not SMALLEST_UM <= radius_um <= LARGEST_UM:
        raise ValueError(f"a drop's radius must lie between {SMALLEST_UM} and {LARGEST_UM:g} µm, not {radius_um:g}")
    if not 0 <= spread <= LARGEST_SPREAD:
        raise ValueError(f"the spread of drop sizes must lie between 0 and {LARGEST_SPREAD:g}, not {spread:g}")
    if distribution not in DISTRIBUTIONS:
        raise ValueError(f"no size distribution {distribution!r}; there are {', '.join(DISTRIBUTIONS)}")
    if count < 1:
        raise ValueError(f"at least one size is needed, not {count}")
    if distribution == "TWO_SIZES":
        return _two_sizes(radius_um, spread, count)
    if spread == 0 or count == 1:
        return np.array([float(radius_um)]), np.ones(1)
    low, high = _range(spread, distribution)
    edges = np.clip(radius_um * np.geomspace(low, high, count + 1), SMALLEST_UM, LARGEST_UM)
    edges = np.unique(edges)
    radii, steps = np.sqrt(edges[1:] * edges[:-1]), np.diff(edges)
    t = radii / radius_um
    if distribution == "NORMAL":
        number = np.exp(-0.5 * ((t - 1) / spread) ** 2)
    elif distribution == "LOG_NORMAL":
        log_spread = np.sqrt(np.log1p(spread**2))
        number = np.exp(-0.5 * ((np.log(t) + log_spread**2 / 2) / log_spread) ** 2) / t
    elif distribution == "GAMMA":
        shape = 1 / spread**2
        exponent = (shape - 1) * np.log(t) - shape * t
        number = np.exp(exponent - exponent.max())
    else:
        number = np.exp(-t)
    weights = number * steps
    return radii, weights / weights.sum()


def count_for(spread: float, distribution: str, step: float) -> int:
    """Return how many radii a distribution needs for neighbours to differ by a share `step`."""
    if not 0 < spread <= LARGEST_SPREAD:
        return 1 if distribution != "TWO_SIZES" else 2
    low, high = _range(spread, "LOG_NORMAL" if distribution == "TWO_SIZES" else distribution)
    return int(np.ceil(np.log(high / low) / step)) * (2 if distribution == "TWO_SIZES" else 1)


def _range(spread: float, distribution: str) -> tuple[float, float]:
    """Least and greatest radius over the mean."""
    if distribution == "MARSHALL_PALMER":
        return 0.02, 12.0
    if distribution == "NORMAL":
        return max(1 - 3.5 * spread, 0.02), 1 + 3.5 * spread
    reach = 3.5 * np.sqrt(np.log1p(spread**2))
    # A gamma distribution's lower tail is longer than a log-normal's.
    return max(np.exp(-1.5 * reach), 0.01) if distribution == "GAMMA" else np.exp(-reach), np.exp(reach)


def _two_sizes(radius_um: float, spread: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Two log-normal populations of equal cross-section, as a shower has that grows out of another (twinned bows: Haussmann 2015)."""
    halves = [
        quadrature(max(radius, SMALLEST_UM), spread, "LOG_NORMAL", max(1, count // 2)) for radius in (SMALL_SHARE * radius_um, radius_um)
    ]
    weights = np.concatenate([w / (w * r**2).sum() for r, w in halves])
    return np.concatenate([r for r, _ in halves]), weights / weights.sum()


def marshall_palmer_mean_radius(rain_mm_h: float) -> float:
    """Return the mean radius (µm) of rain of a rate (mm/h): 1/(2 Lambda), Lambda = 4.1 R^-0.21 per mm of diameter.

    Raises
    ------
    ValueError
        If the rate is not above zero.
    """
    if not rain_mm_h > 0:
        raise ValueError(f"a rain rate must be above 0 mm/h, not {rain_mm_h}")
    return 1000 / (2 * 4.1 * rain_mm_h**-0.21)


def marshall_palmer_extinction(rain_mm_h: float) -> float:
    """Return the extinction coefficient of rain, 1/m: (pi/4) Q N0 times the second moment 2/Lambda^3, with Q = 2, N0 = 8000."""
    slope = 500 / marshall_palmer_mean_radius(rain_mm_h)  # Lambda in 1/mm
    return np.pi * 8000 / slope**3 * 1e-6
