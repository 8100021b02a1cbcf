# SPDX-License-Identifier: GPL-3.0-or-later
"""Small pictures of curves against wavelength: the area under the curve in the colours of the spectrum, the curve on top.

Pictures are float32 RGBA, rows from the bottom up, in display values (sRGB) and premultiplied by nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..descriptions import wavelengths
from ..optics import colour

# What a chart shows: the eye sees next to nothing outside.
FIRST_NM, LAST_NM = 380.0, 730.0


@dataclass(frozen=True)
class Chart:
    """A curve over `FIRST_NM` to `LAST_NM`.

    Attributes
    ----------
    caption : str
        What the axes say.
    values : ndarray
        (471,) at 360 ... 830 nm.
    low, high : float
        Values at the picture's lower and upper edge.
    """

    caption: str
    values: np.ndarray
    low: float
    high: float


def _visible(values: np.ndarray) -> np.ndarray:
    nm = wavelengths()
    return values[(nm >= FIRST_NM) & (nm <= LAST_NM)]


def index_chart(index: np.ndarray) -> Chart:
    """n(λ), (471,), between its least and its greatest value."""
    seen = _visible(index)
    low, high = float(seen.min()), float(seen.max())
    caption = f"n {seen[0]:.4f} at {FIRST_NM:.0f} nm, {seen[-1]:.4f} at {LAST_NM:.0f} nm"
    margin = 0.15 * (high - low) or 0.01
    return Chart(caption, index, low - 2 * margin, high + margin)


def absorption_chart(per_metre: np.ndarray) -> Chart:
    """σa(λ) in 1/m, (471,), from zero to its greatest value."""
    highest = float(_visible(per_metre).max())
    return Chart(f"0 to {1e-3 * highest:.3g} per mm, {FIRST_NM:.0f} to {LAST_NM:.0f} nm", per_metre, 0.0, 1.1 * highest or 1.0)


def power_chart(power: np.ndarray) -> Chart:
    """Relative spectral power of a lamp, (471,); lines are drawn 5 nm wide, as a picture of so few pixels would miss them."""
    wide = np.max([np.roll(power, shift) for shift in range(-2, 3)], axis=0)
    highest = float(_visible(wide).max())
    nm = wavelengths()
    peak = float(nm[np.argmax(np.where((nm >= FIRST_NM) & (nm <= LAST_NM), power, -1.0))])
    return Chart(f"Most at {peak:.0f} nm, {FIRST_NM:.0f} to {LAST_NM:.0f} nm", wide, 0.0, 1.1 * highest or 1.0)


def picture(chart: Chart, size: int = 128) -> np.ndarray:
    """The chart as (size, size, 4)."""
    nm = np.linspace(FIRST_NM, LAST_NM, size)
    heights = np.interp(nm, wavelengths(), (chart.values - chart.low) / (chart.high - chart.low)) * (size - 1)
    rows = np.arange(size)[:, None]
    out = np.zeros((size, size, 4), np.float32)
    under = rows <= heights[None, :]
    out[..., :3] = np.where(under[..., None], spectrum_colours(nm)[None], 0.1)
    out[..., 3] = np.where(under, 0.85, 0.35)
    # The curve is two pixels thick whatever its slope: the distance to it is measured across.
    slope = np.gradient(heights)
    near = np.abs(rows - heights[None, :]) <= 1.2 * np.sqrt(1 + slope**2)[None, :]
    out[near] = (1.0, 1.0, 1.0, 1.0)
    return out


def spectrum_colours(nm: np.ndarray) -> np.ndarray:
    """Display colours (n, 3) of single wavelengths, desaturated just enough to be shown, dim towards the ends."""
    response = colour.rec709_response()
    rgb = np.stack([np.interp(nm, wavelengths(), channel) for channel in response], axis=-1)
    rgb = rgb - np.minimum(rgb.min(axis=-1, keepdims=True), 0.0)
    brightest = rgb.max(axis=-1, keepdims=True)
    fade = np.clip(brightest / (0.1 * brightest.max()), 0.15, 1.0)
    linear = rgb / np.maximum(brightest, 1e-12) * fade
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
