# SPDX-License-Identifier: GPL-3.0-or-later
"""The sheet of rainbows: strips and Lee diagrams in true colour, curves, errors in numbers, and two old mistakes as lessons.

Lee diagrams: Lee, Appl. Opt. 37 (1998) 1506; every row is one drop size, brought to the same brightest luminance.
"""

from __future__ import annotations

import numpy as np

from opal_kernels.optics import rainbow
from opal_kernels.optics.rainbow import airy_function

from . import rainbow_data
from .canvas import Axes, Canvas
from .rainbow_data import FIRST_DEG, LAST_DEG, Sheet

WIDTH, HEIGHT = 1600, 1280
_NAMES = {
    "DESCARTES": ("Descartes", (0.75, 0.60, 0.12)),
    "DESCARTES_SAMPLED": ("Descartes, sampled", (0.80, 0.28, 0.10)),
    "AIRY": ("Airy", (0.15, 0.55, 0.95)),
    "MIE": ("Lorenz-Mie", (0.90, 0.90, 0.90)),
    "DROPLET": ("Droplet", (0.20, 0.75, 0.25)),
}
_TICKS = range(34, 59, 4)
_PEAK = 0.85  # what the primary's brightest value is exposed to


def _degrees(value: float) -> str:
    return f"{value:g}°"


def draw(sheet: Sheet) -> np.ndarray:
    """Return the sheet as a picture (`HEIGHT`, `WIDTH`, 3), linear Rec.709, rows from the top; colours out of gamut are kept."""
    canvas = Canvas(WIDTH, HEIGHT)
    canvas.text(30, 22, f"Rainbows of drops of {sheet.radius_um / 1000:g} mm radius, spread {sheet.spread:.0%}", scale=3)
    canvas.text(30, 54, "Distance from the antisolar point. Light: D65 from the sun's disc. One exposure for all strips.", scale=1)
    _strips(canvas, sheet, 190, 80, 600)
    _curves(canvas, sheet, 190, 500, 600)
    _lee(canvas, sheet, 900, 80, 660)
    _lessons(canvas, sheet, 900, 810, 660)
    _numbers(canvas, sheet, 30, 1070)
    return canvas.pixels


def _stretched(row: np.ndarray, width: int) -> np.ndarray:
    """Columns of a strip by linear interpolation."""
    at = np.linspace(0, len(row) - 1, width)
    return np.stack([np.interp(at, np.arange(len(row)), row[:, c]) for c in range(3)], axis=1).astype(np.float32)


def _strips(canvas: Canvas, sheet: Sheet, x: int, y: int, width: int) -> None:
    height, gap = 64, 10
    exposure = _PEAK / max(bow.rgb.max() for name, bow in sheet.bows.items() if name in {"AIRY", "MIE", "DROPLET"})
    for number, theory in enumerate(rainbow.THEORIES):
        top = y + number * (height + gap)
        canvas.text(x - 10, top + height // 2 - 4, _NAMES[theory][0], _NAMES[theory][1], 1, "right")
        canvas.picture(x, top, np.repeat(_stretched(exposure * sheet.bows[theory].rgb, width)[None], height, axis=0))
    bottom = y + len(rainbow.THEORIES) * (height + gap) - gap
    Axes(canvas, x, bottom, width, 1, (FIRST_DEG, LAST_DEG), (0, 1)).frame(_TICKS, tick=_degrees)


def _curves(canvas: Canvas, sheet: Sheet, x: int, y: int, width: int) -> None:
    largest = max(bow.luminance.max() for bow in sheet.bows.values())
    top = 10 ** (np.ceil(np.log10(largest) * 2) / 2)
    axes = Axes(canvas, x, y, width, 250, (FIRST_DEG, LAST_DEG), (3e-4, float(top)), log=True)
    axes.frame(_TICKS, [1e-3, 1e-2, 1e-1], _degrees)
    canvas.text(30, y + 6, "Luminance", scale=1)
    canvas.text(30, y + 20, "1/sr", scale=1)
    polar = Axes(canvas, x, y + 285, width, 220, (FIRST_DEG, LAST_DEG), (-0.2, 1.0))
    polar.frame(_TICKS, [0, 0.25, 0.5, 0.75, 1.0], _degrees, "{:.0%}".format)
    canvas.text(30, y + 291, "Polarisation", scale=1)
    for theory in rainbow.THEORIES:
        bow = sheet.bows[theory]
        axes.curve(bow.radius_deg[::2], bow.luminance[::2], _NAMES[theory][1])
        polar.curve(bow.radius_deg[::2], bow.polarisation[::2], _NAMES[theory][1])
    axes.legend([_NAMES[theory] for theory in rainbow.THEORIES])


def _lee(canvas: Canvas, sheet: Sheet, x: int, y: int, width: int) -> None:
    height, gap = 200, 32
    radii = sheet.lee_radii_um
    for number, (theory, rows) in enumerate(sheet.lee.items()):
        top = y + number * (height + gap)
        at = np.linspace(len(rows) - 1, 0, height)  # the largest drops on top
        below = np.clip(at.astype(int), 0, len(rows) - 2)
        part = (at - below)[:, None, None]
        picture = np.stack([_stretched(row, width) for row in rows])
        canvas.picture(x, top, _PEAK * ((1 - part) * picture[below] + part * picture[below + 1]))
        axes = Axes(canvas, x, top, width, height, (FIRST_DEG, LAST_DEG), (radii[0] / 1000, radii[-1] / 1000), log=True)
        for value in (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0):
            if radii[0] <= value * 1000 * 1.001 and value * 1000 <= radii[-1] * 1.001:
                canvas.text(x - 5, min(round(float(axes.row(value))) - 3, top + height - 14), f"{value:g} mm", scale=1, align="right")
        for value in _TICKS:
            canvas.text(round(float(axes.column(value))), top + height + 5, _degrees(value), scale=1, align="middle")
        canvas.text(x + 8, top + 8, f"Lee diagram: {_NAMES[theory][0]}", scale=1)


def _lessons(canvas: Canvas, sheet: Sheet, x: int, y: int, width: int) -> None:
    half = (width - 70) // 2
    series = Axes(canvas, x, y, half, 190, (-3.0, 12.0), (-0.05, 0.5))
    series.frame(range(-2, 13, 2), [0, 0.1, 0.2, 0.3, 0.4])
    at = np.linspace(-3, 12, 601)
    rows = [
        ("Airy's intensity", (0.9, 0.9, 0.9)),
        ("6 terms", (0.8, 0.25, 0.1)),
        ("12 terms", (0.8, 0.6, 0.1)),
        ("24 terms", (0.2, 0.6, 0.9)),
    ]
    for terms, (_, colour) in zip((6, 12, 24), rows[1:], strict=True):
        value = rainbow_data.de_morgan(at, terms) ** 2
        series.curve(at, np.where(value < 0.55, value, np.nan), colour)
    series.curve(at, airy_function.airy(-at)[0] ** 2, rows[0][1])
    series.legend(rows)
    canvas.text(x, y - 14, "Too few terms of De Morgan's series", scale=1)

    left = x + half + 70
    both = (sheet.mie_perpendicular + sheet.mie_parallel) / 2
    low, high = 10.0 ** np.floor(np.log10(np.maximum(both.min(), 1e-7))), 10.0 ** np.ceil(np.log10(both.max()))
    mie = Axes(canvas, left, y, half, 190, (0.0, 180.0), (float(low), float(high)), log=True)
    decades = np.arange(round(np.log10(low)), round(np.log10(high)) + 1, 2)
    mie.frame(range(0, 181, 30), 10.0**decades, _degrees, "{:.0e}".format)
    mie.curve(sheet.mie_deg[::2], sheet.mie_perpendicular[::2], (0.25, 0.55, 0.9), 1.0)
    mie.curve(sheet.mie_deg[::2], sheet.mie_parallel[::2], (0.8, 0.35, 0.15), 1.0)
    mie.legend([("perpendicular", (0.25, 0.55, 0.9)), ("parallel", (0.8, 0.35, 0.15))])
    canvas.text(left, y - 14, "Lorenz-Mie, one size, 550 nm, against angle", scale=1)


def _numbers(canvas: Canvas, sheet: Sheet, x: int, y: int) -> None:
    for number, line in enumerate(rainbow_data.table(sheet).splitlines()):
        canvas.text(x, y + number * 26, line, (0.8, 0.8, 0.8) if number == 0 else _NAMES[line.split()[0]][1], 2)


def encode(pixels: np.ndarray) -> np.ndarray:
    """Return a linear picture as sRGB values in [0, 1]; what the gamut does not hold is clipped here, in the view alone."""
    clipped = np.clip(pixels, 0, 1)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055).astype(np.float32)
