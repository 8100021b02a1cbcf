# SPDX-License-Identifier: GPL-3.0-or-later
"""From what an artist sets on a gem to what the tracer reads: n(λ) and σa(λ), and the numbers a gemmologist knows.

Coefficients are those of the interface: Cauchy n = b + c/λ², Sellmeier n² = 1 + Σ bᵢλ²/(λ² - cᵢ), λ in µm.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .descriptions import wavelengths
from .optics import colour, dispersion, species, uplift

# Metres of stone whose colour is shown where nobody says otherwise.
USUAL_DEPTH = 0.005
# An index above this is no solid's; it would only hide a slip of the hand.
HIGHEST_INDEX = 10.0
# Where the pole of the infrared term of a form that is linear in λ² is put, µm²: far enough to be straight below 1 µm.
_FAR_POLE = 1.0e4
# Infrared resonance of fitted forms, µm²: about that of water.
_INFRARED_POLE = 10.0


@dataclass(frozen=True)
class Settings:
    """What the interface shows of a gem.

    Attributes
    ----------
    dispersion : str
        ``"CAUCHY"`` or ``"SELLMEIER"``.
    cauchy : (float, float)
        b, and c in µm².
    sellmeier_b, sellmeier_c : sequence of 3 floats
        Strengths, and squared resonances in µm².
    absorption_color : sequence of 3 floats
        Linear Rec.709 that D65 becomes along ``absorption_depth`` metres.
    absorption_curve : sequence of (float, float), optional
        Wavelength (nm) and absorption (1/mm), in place of colour and depth; the ends hold outside.
    """

    dispersion: str
    cauchy: tuple[float, float]
    sellmeier_b: Sequence[float]
    sellmeier_c: Sequence[float]
    absorption_color: Sequence[float] = (1.0, 1.0, 1.0)
    absorption_depth: float = USUAL_DEPTH
    absorption_curve: Sequence[tuple[float, float]] | None = None


@dataclass(frozen=True)
class ReadOut:
    """Numbers by which a stone is known: index at the D line, Abbe number, B-G dispersion, critical angle (radians)."""

    n_d: float
    abbe: float
    b_to_g: float
    critical_angle: float


def index_at(settings: Settings, wavelengths_nm: np.ndarray) -> np.ndarray:
    """n at wavelengths (nm), same shape; NaN where the formula has no real value."""
    if settings.dispersion == "CAUCHY":
        return dispersion.cauchy(wavelengths_nm, settings.cauchy[0], settings.cauchy[1])
    return dispersion.sellmeier(wavelengths_nm, settings.sellmeier_b, settings.sellmeier_c)


def index(settings: Settings) -> np.ndarray:
    """n at 360, 361, ... 830 nm, shape (471,)."""
    return index_at(settings, wavelengths())


def refusal(settings: Settings) -> str:
    """One sentence that says why these settings cannot be rendered; empty where they can."""
    n = index(settings)
    if not np.isfinite(n).all():
        nm = wavelengths()[~np.isfinite(n)]
        return f"The index of refraction has no value from {nm[0]:.0f} to {nm[-1]:.0f} nm with these coefficients."
    if n.min() < 1.0:
        return f"The index of refraction would fall to {n.min():.3f} at {wavelengths()[n.argmin()]:.0f} nm; it has to be 1 or more."
    if n.max() > HIGHEST_INDEX:
        return (
            f"The index of refraction would rise to {n.max():.4g} at {wavelengths()[n.argmax()]:.0f} nm; {HIGHEST_INDEX:.0f} is the most."
        )
    return ""


def absorption_refusal(settings: Settings) -> str:
    """One sentence that says why an absorption cannot be rendered; empty where it can."""
    if settings.absorption_curve is not None:
        return _curve_refusal(settings.absorption_curve)
    tint, depth = settings.absorption_color, settings.absorption_depth
    if not all(math.isfinite(c) and 0.0 <= c <= 1.0 for c in tint):
        return (
            f"An absorption color of {', '.join(f'{c:.3g}' for c in tint)} would take negative absorption or none that is finite; "
            "each component has to lie between 0 and 1."
        )
    if not (math.isfinite(depth) and depth > 0):
        return f"An absorption depth of {depth:g} m would mean negative absorption; it has to be above 0."
    return ""


def _curve_refusal(curve: Sequence[tuple[float, float]]) -> str:
    if not len(curve):
        return "The absorption curve is empty; import one or add samples first."
    for nm, value in curve:
        if not (math.isfinite(nm) and nm > 0):
            return f"The absorption curve has a sample at {nm:g} nm; wavelengths have to be above 0."
        if not (math.isfinite(value) and value >= 0):
            return f"The absorption curve has {value:g} per mm at {nm:g} nm; absorption cannot be negative."
    return ""


def absorption(settings: Settings) -> np.ndarray | None:
    """σa (1/m) at 360 ... 830 nm from a curve, or from colour and depth; None for a clear stone."""
    if settings.absorption_curve is not None:
        nm, per_mm = np.asarray(settings.absorption_curve, float).reshape(-1, 2).T
        sigma = 1e3 * colour.resample(nm, per_mm)
        return sigma if sigma.any() else None
    if min(settings.absorption_color) >= 1.0:
        return None
    return uplift.absorption(np.clip(settings.absorption_color, 0.0, 1.0), settings.absorption_depth)


def read_out(settings: Settings) -> ReadOut:
    """The numbers of a stone whose settings `refusal` accepts."""
    return _read_out(lambda nm: index_at(settings, nm))


def read_out_of_species(name: str) -> ReadOut:
    """The numbers of a species' own formula; KeyError for an unknown name."""
    return _read_out(lambda nm: species.index(name, nm))


def _read_out(index_function: dispersion.Index) -> ReadOut:
    n_d = float(index_function(np.array([dispersion.LINE_D]))[0])
    return ReadOut(
        n_d=n_d,
        abbe=float(dispersion.abbe_number(index_function)),
        b_to_g=dispersion.b_to_g(index_function),
        critical_angle=dispersion.critical_angle(n_d) if n_d >= 1 else math.pi / 2,
    )


def tint_along(sigma: np.ndarray, depth: float) -> tuple[float, float, float]:
    """Linear Rec.709 in [0, 1] that D65 becomes along `depth` metres of absorption `sigma`, 1/m at 360 ... 830 nm, shape (471,)."""
    tint = np.clip(colour.rec709(colour.white() * np.exp(-sigma * depth)), 0.0, 1.0)
    return tuple(float(v) for v in tint)


def settings_of_species(name: str, depth: float = USUAL_DEPTH) -> Settings:
    """What the interface shows once a species is chosen.

    Parameters
    ----------
    name : str
        A name of `optics.species.table`.
    depth : float
        Metres of stone whose colour is shown.

    Raises
    ------
    KeyError
        If there is no such species.
    """
    row = species.get(name)

    def exact(nm: np.ndarray) -> np.ndarray:
        return species.index(name, nm)

    if row.formula == "CAUCHY" and not row.coefficients.get("c"):
        kind, cauchy = "CAUCHY", (row.coefficients["a"], row.coefficients.get("b", 0.0))
    else:
        kind, cauchy = "SELLMEIER", _cauchy_through(exact)
    b, c = _three_terms(row.formula, row.coefficients) or _fitted_terms(exact)
    sigma = species.absorption(name, wavelengths())
    curve = list(zip(wavelengths().tolist(), (1e-3 * sigma).tolist(), strict=True)) if sigma.any() else None
    return Settings(kind, cauchy, b, c, tint_along(sigma, depth), depth, curve)


def _three_terms(formula: str, coefficients: dict) -> tuple[Sequence[float], Sequence[float]] | None:
    """A formula as three Sellmeier terms, None where it has more: a constant is a term with its pole at 0, -dλ² one with
    its pole far away."""
    if formula == "POLE":
        a, b, c, d = (coefficients[k] for k in "abcd")
        return (a - 1 - b / c, b / c, d * _FAR_POLE), (0.0, c, _FAR_POLE)
    if formula != "SELLMEIER":
        return None
    constant = coefficients.get("c0", 0.0)
    b = [*coefficients["b"], *([constant] if constant else [])]
    c = [*coefficients["c"], *([0.0] if constant else [])]
    missing = 3 - len(b)
    return (b + [0.0] * missing, c + [0.0] * missing) if missing >= 0 else None


def _fitted_terms(index_function: dispersion.Index) -> tuple[Sequence[float], Sequence[float]]:
    """A constant, one ultraviolet and one infrared resonance by least squares; the ultraviolet pole is the best of many."""
    nm = wavelengths()
    l2 = (nm * 1e-3) ** 2
    target = index_function(nm) ** 2 - 1.0
    best: tuple[float, Sequence[float], Sequence[float]] | None = None
    for pole in np.linspace(0.002, 0.06, 117):
        poles = (0.0, float(pole), _INFRARED_POLE)
        terms = np.stack([l2 / (l2 - p) for p in poles], axis=1)
        strengths, *_ = np.linalg.lstsq(terms, target, rcond=None)
        error = float(np.abs(terms @ strengths - target).max())
        if best is None or error < best[0]:
            best = error, tuple(float(v) for v in strengths), poles
    assert best is not None
    return best[1], best[2]


def _cauchy_through(index_function: dispersion.Index) -> tuple[float, float]:
    """b, c of n = b + c/λ² through the F and C lines."""
    f, c_line = dispersion.LINE_F * 1e-3, dispersion.LINE_C * 1e-3
    n_f, n_c = (float(n) for n in index_function(np.array([dispersion.LINE_F, dispersion.LINE_C])))
    slope = (n_f - n_c) / (f**-2 - c_line**-2)
    return n_f - slope * f**-2, slope
