# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sheet of rainbows shows: each theory's bows in colour, their curves, and how far each is from Lorenz-Mie's.

Angles are distances from the antisolar point, degrees. Light is D65 of luminance 1 from the sun's disc; colours are linear Rec.709 of
the phase function, so 1 is 1/sr. Luminance is its Y.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from opal_kernels.optics import colour, rainbow
from opal_kernels.optics.rainbow import airy_function, sun

FIRST_DEG, LAST_DEG = 34.0, 58.0
_MARGIN, _STEP = 0.4, 0.02  # degrees
_STRIP_NM, _LEE_NM = 10.0, 20.0
_MIE_SIZES = 12
SMALLEST_UM = 10.0
LEE_THEORIES = ("AIRY", "MIE", "DROPLET")

Progress = Callable[[float], bool | None]


@dataclass
class Bow:
    """One theory's bows at one size: radii (n,), colour (n, 3), luminance (n,), degree of polarisation of the luminance (n,)."""

    theory: str
    radius_deg: np.ndarray
    rgb: np.ndarray
    luminance: np.ndarray
    polarisation: np.ndarray


@dataclass
class Sheet:
    """Everything that the sheet shows."""

    radius_um: float
    spread: float
    bows: dict[str, Bow] = field(default_factory=dict)
    lee_radii_um: np.ndarray = field(default_factory=lambda: np.zeros(0))
    lee: dict[str, np.ndarray] = field(default_factory=dict)  # (rows, angles, 3), each row's largest luminance is 1
    mie_deg: np.ndarray = field(default_factory=lambda: np.zeros(0))
    mie_perpendicular: np.ndarray = field(default_factory=lambda: np.zeros(0))
    mie_parallel: np.ndarray = field(default_factory=lambda: np.zeros(0))


def _colours(wavelengths: np.ndarray) -> np.ndarray:
    """Return (3, n): XYZ of D65 that a table linear between these wavelengths scatters."""
    nodes = np.eye(len(wavelengths))
    hats = np.array([np.interp(colour.WAVELENGTHS_NM, wavelengths, node) for node in nodes])
    return colour.observer() / colour.observer()[1].sum() * colour.white() @ hats.T


def _under_the_sun(values: np.ndarray, step_rad: float) -> np.ndarray:
    """Smooth a stretch of a table by the sun's chord profile; a stretch ends in what its last values are."""
    reach = int(np.ceil(sun.MEAN_RADIUS_RAD / step_rad))
    edges = np.clip((np.arange(-reach, reach + 2) - 0.5) * step_rad / sun.MEAN_RADIUS_RAD, -1, 1)
    kernel = np.diff((edges * np.sqrt(1 - edges**2) + np.arcsin(edges)) / np.pi)
    padded = np.pad(values, [(0, 0)] * (values.ndim - 1) + [(reach, reach)], mode="edge")
    return np.apply_along_axis(np.convolve, -1, padded, kernel, "valid")


def bow(
    theory: str,
    radius_um: float,
    spread: float,
    step_nm: float = _STRIP_NM,
    step_deg: float = _STEP,
    sizes: int = _MIE_SIZES,
    progress: Progress | None = None,
) -> Bow:
    """Return one theory's bows between `FIRST_DEG` and `LAST_DEG` from the antisolar point; `progress` as of `rainbow.phase_function`."""
    radius = np.arange(FIRST_DEG - _MARGIN, LAST_DEG + _MARGIN + step_deg / 2, step_deg)
    wavelengths = np.arange(380.0, 780.5, step_nm)
    p = rainbow.phase_function(
        theory, radius_um, wavelengths, np.radians(180 - radius), spread, sizes=sizes if spread > 0 else 1, progress=progress
    )
    p = _under_the_sun(p, np.radians(step_deg))
    xyz = np.einsum("cw,pwa->pac", _colours(wavelengths), p)
    inside = (radius > FIRST_DEG - step_deg / 2) & (radius < LAST_DEG + step_deg / 2)
    xyz, radius = xyz[:, inside], radius[inside]
    luminance = xyz.mean(axis=0)[:, 1]
    polarisation = (xyz[0, :, 1] - xyz[1, :, 1]) / np.maximum(xyz[0, :, 1] + xyz[1, :, 1], 1e-12)
    return Bow(theory, radius, xyz.mean(axis=0) @ colour.rec709_from_xyz().T, luminance, polarisation)


def compute(radius_um: float, spread: float, largest_um: float = 500.0, lee_rows: int = 32, progress: Progress | None = None) -> Sheet:
    """Return the sheet's numbers.

    Parameters
    ----------
    radius_um, spread : float
        Drops of the strips, curves and errors.
    largest_um : float
        The Lee diagrams' largest radius; their smallest is `SMALLEST_UM`.
    lee_rows : int
        Sizes of the Lee diagrams.
    progress : callable, optional
        Called with the fraction done; returning False stops.

    Raises
    ------
    ValueError
        If the drops cannot be, in one sentence.
    opal_kernels.optics.rainbow.Cancelled
        If `progress` returned False.
    """
    if not largest_um > SMALLEST_UM:
        raise ValueError(f"The Lee diagrams' largest radius must be above {SMALLEST_UM:g} µm, not {largest_um:g}.")
    sheet = Sheet(radius_um, spread, lee_radii_um=np.geomspace(SMALLEST_UM, largest_um, lee_rows))
    costs = {"MIE": 12.0}
    steps = [("bow", theory, radius_um, costs.get(theory, 1.0)) for theory in rainbow.THEORIES]
    steps += [("lee", t, r, 0.3 + (r / 150) ** 2 if t == "MIE" else 0.3) for r in sheet.lee_radii_um.tolist() for t in LEE_THEORIES]
    total, done = float(sum(cost for *_, cost in steps)), 0.0
    for what, theory, micrometres, cost in steps:
        within = _within(progress, done / total, cost / total)
        if within is not None and within(0.0) is False:
            raise rainbow.Cancelled("the chart was cancelled")
        if what == "bow":
            sheet.bows[theory] = bow(theory, micrometres, spread, progress=within)
        else:
            one = bow(theory, micrometres, 0.0, _LEE_NM, 2 * _STEP, progress=within)
            row = one.rgb / one.luminance.max()
            sheet.lee.setdefault(theory, np.zeros((0, *row.shape)))
            sheet.lee[theory] = np.concatenate([sheet.lee[theory], row[None]])
        done += cost
    sheet.mie_deg = np.linspace(0, 180, 3601)
    both = rainbow.phase_function("MIE", radius_um, [550.0], np.radians(sheet.mie_deg), 0.0)[:, 0]
    sheet.mie_perpendicular, sheet.mie_parallel = both
    return sheet


def _within(progress: Progress | None, before: float, share: float) -> Progress | None:
    """The progress of one step, which has a share of the whole and something before it."""
    return None if progress is None else lambda done: progress(before + share * done)


# Ranges of radius (degrees) in which each bow's top is looked for, and the dark band between them.
_PRIMARY, _DARK, _SECONDARY = (36.0, 43.5), (44.5, 48.0), (49.5, 57.0)


def _top(bow_: Bow, span: tuple[float, float]) -> tuple[float, float]:
    """Radius and luminance of the brightest place between two radii, by a parabola through three values."""
    inside = np.flatnonzero((bow_.radius_deg >= span[0]) & (bow_.radius_deg <= span[1]))
    i = int(np.clip(inside[bow_.luminance[inside].argmax()], 1, len(bow_.luminance) - 2))
    a, b, c = bow_.luminance[i - 1 : i + 2]
    curvature = a - 2 * b + c
    offset = 0.5 * (a - c) / curvature if curvature < 0 else 0.0
    return float(bow_.radius_deg[i] + offset * (bow_.radius_deg[1] - bow_.radius_deg[0])), float(b - 0.25 * (a - c) * offset)


def errors(sheet: Sheet) -> dict[str, dict[str, float]]:
    """Return each theory's difference from Lorenz-Mie's bows.

    Returns
    -------
    dict by theory of dict by what:
        ``primary_deg``, ``secondary_deg``  shift of the bow's brightest place, degrees
        ``primary``, ``secondary``          its luminance over Mie's, minus 1
        ``band``                            luminance of the dark band over Mie's, minus 1
        ``rms``                             root mean square of the luminance's difference over Mie's peak
        ``polarisation``                    mean of the difference of the degree of polarisation over the primary
    """
    mie = sheet.bows["MIE"]
    band = (mie.radius_deg >= _DARK[0]) & (mie.radius_deg <= _DARK[1])
    primary = (mie.radius_deg >= 38.0) & (mie.radius_deg <= 42.5)
    first, second = _top(mie, _PRIMARY), _top(mie, _SECONDARY)
    result = {}
    for theory, one in sheet.bows.items():
        a, b = _top(one, _PRIMARY), _top(one, _SECONDARY)
        result[theory] = {
            "primary_deg": a[0] - first[0],
            "primary": a[1] / first[1] - 1,
            "secondary_deg": b[0] - second[0],
            "secondary": b[1] / second[1] - 1,
            "band": float(one.luminance[band].mean() / mie.luminance[band].mean() - 1),
            "rms": float(np.sqrt(np.mean((one.luminance - mie.luminance) ** 2)) / first[1]),
            "polarisation": float((one.polarisation - mie.polarisation)[primary].mean()),
        }
    return result


def table(sheet: Sheet) -> str:
    """Return the errors as a table of text, one line a theory."""
    head = f"{'Against Lorenz-Mie':20}{'primary':>18}{'dark band':>12}{'secondary':>18}{'rms':>8}{'polarisation':>14}"
    lines = [head]
    for theory, row in errors(sheet).items():
        lines.append(
            f"{theory:20}{row['primary_deg']:+8.2f}° {row['primary']:+8.1%}{row['band']:+12.1%}"
            f"{row['secondary_deg']:+8.2f}° {row['secondary']:+8.1%}{row['rms']:8.1%}{row['polarisation']:+14.3f}"
        )
    return "\n".join(lines)


def de_morgan(x: np.ndarray, terms: int) -> np.ndarray:
    """Return Ai(-x) by so many terms of its power series (De Morgan's, DLMF 9.4.1): too few bend away from the truth."""
    cube = -(np.asarray(x, float) ** 3)
    f = term_f = np.ones_like(cube)
    g = term_g = -np.asarray(x, float)
    for k in range(1, terms):
        term_f = term_f * cube / ((3 * k - 1) * (3 * k))
        term_g = term_g * cube / ((3 * k) * (3 * k + 1))
        f, g = f + term_f, g + term_g
    return airy_function.AI_0 * f + airy_function.AI_PRIME_0 * g
