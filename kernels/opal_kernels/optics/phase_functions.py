# SPDX-License-Identifier: GPL-3.0-or-later
"""Phase functions: how a medium turns light. Closed forms, and tables sampled by inverse cumulative distribution.

Convention: the angle is between propagation directions (cosine 1 is straight on); values are per steradian and integrate to 1
over the sphere. Sources: Henyey and Greenstein, ApJ 93 (1941) 70; Rayleigh 1871, unpolarised and without anisotropy.
"""

from __future__ import annotations

import numpy as np


def isotropic(cosine) -> np.ndarray:
    """Return 1/(4 pi), 1/sr."""
    return np.full(np.shape(cosine), 1 / (4 * np.pi))


def henyey_greenstein(cosine, anisotropy: float) -> np.ndarray:
    """Return the Henyey-Greenstein phase function (1/sr) of mean cosine `anisotropy`, in (-1, 1)."""
    g = anisotropy
    return (1 - g * g) / (4 * np.pi * (1 + g * g - 2 * g * np.asarray(cosine, float)) ** 1.5)


def rayleigh(cosine) -> np.ndarray:
    """Return Rayleigh's phase function (1/sr): 3/(16 pi) (1 + cos^2)."""
    return 3 / (16 * np.pi) * (1 + np.asarray(cosine, float) ** 2)


def sample_isotropic(u) -> np.ndarray:
    """Return the cosine drawn by u in [0, 1]; u = 1 is straight on."""
    return 2 * np.asarray(u, float) - 1


def sample_henyey_greenstein(u, anisotropy: float) -> np.ndarray:
    """Return the cosine drawn by u in [0, 1]; u = 1 is straight on."""
    u, g = np.asarray(u, float), anisotropy
    if abs(g) < 1e-4:  # the inverse divides by g; this is its series, exact to g^2
        return 2 * u - 1 + 6 * g * u * (1 - u)
    s = (1 - g * g) / (1 - g + 2 * g * u)
    return (1 + g * g - s * s) / (2 * g)


def sample_rayleigh(u) -> np.ndarray:
    """Return the cosine drawn by u in [0, 1]: the real root of c^3 + 3 c + 4 - 8 u = 0 (Frisvad, JOSA A 28 (2011) 2436)."""
    half = 2 * (2 * np.asarray(u, float) - 1)
    root = np.cbrt(half + np.sqrt(half * half + 1))
    return root - 1 / root


class Table:
    """A phase function given at angles: linear in the cosine between them, normalised, sampled exactly.

    Parameters
    ----------
    angles_rad : array (n,)
        Scattering angles from 0 to pi, ascending, n >= 2.
    values : array (n,)
        In any unit, not negative, not all zero.

    Raises
    ------
    ValueError
        If angles do not ascend from 0 to pi, or values are negative, not finite or all zero.
    """

    def __init__(self, angles_rad: np.ndarray, values: np.ndarray) -> None:
        angles, values = np.asarray(angles_rad, float), np.asarray(values, float)
        if angles.ndim != 1 or angles.size < 2 or angles.shape != values.shape:
            raise ValueError(f"a phase table needs as many values as angles, at least two; got {values.shape}, {angles.shape}")
        if abs(angles[0]) > 1e-9 or abs(angles[-1] - np.pi) > 1e-6 or not (np.diff(angles) > 0).all():
            raise ValueError("the angles of a phase table must ascend from 0 to pi")
        if not np.isfinite(values).all() or (values < 0).any() or not values.any():
            raise ValueError("the values of a phase table must be finite, not negative and not all zero")
        self._cosines = np.cos(angles)[::-1].copy()
        self._cosines[[0, -1]] = -1, 1
        reversed_values = values[::-1]
        mass = np.diff(self._cosines) * (reversed_values[1:] + reversed_values[:-1]) / 2
        self._values = reversed_values / (2 * np.pi * mass.sum())
        self._cumulative = np.append(0, np.cumsum(mass)) / mass.sum()

    def value(self, cosine) -> np.ndarray:
        """Return the phase function, 1/sr."""
        return np.interp(cosine, self._cosines, self._values)

    def sample(self, u) -> np.ndarray:
        """Return the cosine drawn by u in [0, 1]: the distribution's inverse, a quadratic in each interval."""
        u = np.asarray(u, float)
        i = np.clip(np.searchsorted(self._cumulative, u, side="right") - 1, 0, len(self._cosines) - 2)
        start, width = self._cosines[i], self._cosines[i + 1] - self._cosines[i]
        a, b = self._values[i], self._values[i + 1]
        wanted = np.clip((u - self._cumulative[i]) / (2 * np.pi * width), 0, None)  # in [0, (a + b)/2]
        root = np.sqrt(np.clip(a * a + 2 * (b - a) * wanted, 0, None))
        with np.errstate(invalid="ignore", divide="ignore"):
            t = np.where(a + root > 0, 2 * wanted / (a + root), 0.0)
        return start + width * np.clip(t, 0, 1)

    def mean_cosine(self) -> float:
        """Return the asymmetry g, the mean of the cosine, exact for the piecewise linear table."""
        c0, c1, a, b = self._cosines[:-1], self._cosines[1:], self._values[:-1], self._values[1:]
        return float((2 * np.pi * (c1 - c0) * (a * (2 * c0 + c1) + b * (c0 + 2 * c1)) / 6).sum())


def draine(cosine, anisotropy: float, alpha: float) -> np.ndarray:
    """Return Draine's phase function (1/sr; ApJ 598 (2003) 1017): alpha 0 is Henyey-Greenstein, g = 0 and alpha = 1 is Rayleigh.

    Parameters
    ----------
    cosine : array_like
    anisotropy : float
        g in (-1, 1); the mean cosine only where alpha is 0.
    alpha : float
        Not negative.
    """
    cosine = np.asarray(cosine, float)
    return henyey_greenstein(cosine, anisotropy) * (1 + alpha * cosine**2) / (1 + alpha * (1 + 2 * anisotropy**2) / 3)


def fournier_forand(cosine, index: float, backscatter: float) -> np.ndarray:
    """Return the phase function of sea water (1/sr; Fournier and Jonasz, SPIE 3761 (1999)): particles of hyperbolic sizes.

    Parameters
    ----------
    cosine : array_like
    index : float
        Of refraction of the particles in the water, above 1.
    backscatter : float
        Fraction of light sent backwards, in (0, 0.5); it fixes the slope of the sizes (Mobley et al., Appl. Opt. 41 (2002) 1035).
    """
    scale = 4 / (3 * (index - 1) ** 2)
    half = scale / 2  # delta at 90 degrees
    # Backscatter = 1 - (1 - half x - (1 - x)/2) / ((1 - half) x) with x = half^nu, solved for x.
    x = 0.5 / ((1 - backscatter) * (1 - half) - 0.5 + half)
    nu = np.log(x) / np.log(half)
    sin2 = np.maximum((1 - np.asarray(cosine, float)) / 2, 1e-12)  # of half the angle
    delta = scale * sin2
    near_one = np.abs(delta - 1) < 1e-4
    delta = np.where(near_one, 1 + 1e-4, delta)
    power = delta**nu
    first = nu * (1 - delta) - (1 - power) + (delta * (1 - power) - nu * (1 - delta)) / sin2
    back = scale**nu
    return first / (4 * np.pi * (1 - delta) ** 2 * power) + (1 - back) / (16 * np.pi * (scale - 1) * back) * (
        3 * np.asarray(cosine, float) ** 2 - 1
    )


def fog(cosine, diameter_um: float) -> np.ndarray:
    """Return the phase function of water drops (1/sr) by the fit of Jendersie and d'Eon, SIGGRAPH Talks 2023: two lobes.

    Parameters
    ----------
    cosine : array_like
    diameter_um : float
        Of the drops, micrometres; taken within 0 to 50, where the fit was made.
    """
    d = float(np.clip(diameter_um, 1e-3, 50.0))
    log = np.log(d)
    if d <= 0.1:
        g, g_draine, alpha = 13.8 * d * d, 1.1456 * d * np.sin(9.29044 * d), 250.0
        weight = 0.252977 - 312.983 * d**4.3
    elif d < 1.5:
        g, alpha = 0.862 - 0.143 * log * log, 250.0
        inner = np.cos((log - 0.238604) * (log + 1.00667) / (0.507522 - 0.15677 * log))
        g_draine = 0.379685 * np.cos(1.19692 * inner + 1.37932 * log + 0.0625835) + 0.344213
        weight = 0.146209 * np.cos(3.38707 * log + 2.11193) + 0.316072 + 0.0778917 * log
    elif d < 5.0:
        twice = np.log(log)
        g, alpha = 0.0604931 * twice + 0.940256, 7.30354 * log + 6.31675
        g_draine = 0.500411 - 0.081287 / (-2 * log + np.tan(log) + 1.27551)
        weight = 0.026914 * (log - np.cos(5.68947 * (twice - 0.0292149))) + 0.376475
    else:
        g = np.exp(-0.0990567 / (d - 1.67154))
        g_draine = np.exp(-2.20679 / (d + 3.91029) - 0.428934)
        alpha = np.exp(3.62489 - 8.29288 / (d + 5.52825))
        weight = np.exp(-0.599085 / (d - 0.641583) - 0.665888)
    return (1 - weight) * henyey_greenstein(cosine, g) + weight * draine(cosine, g_draine, alpha)


def table_angles(n: int = 1801) -> np.ndarray:
    """Return angles from 0 to pi, as dense in front as sharp forward lobes need: steps grow with the angle."""
    x = np.linspace(0, 1, n)
    return np.pi * x**2
