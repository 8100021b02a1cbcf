# SPDX-License-Identifier: GPL-3.0-or-later
"""The sun is a disc: a phase function seen under it is smoothed by the disc's chord profile.

The profile sqrt(s^2 - u^2) holds where the bow is straight over the sun's width. Fold the disc in here or sample it as a light,
never both. Mean angular radius 15.99 arc minutes, 0.262-0.271 degrees over the year.
"""

from __future__ import annotations

import numpy as np

MEAN_RADIUS_RAD = np.radians(0.2666)


def smooth(values: np.ndarray, radius_rad: float) -> np.ndarray:
    """Smooth tables over scattering angle by a uniform disc.

    Parameters
    ----------
    values : array (..., n)
        At n equally spaced angles from 0 to pi, both ends included; continued evenly beyond them.
    radius_rad : float
        Angular radius of the disc; 0 returns the values.

    Raises
    ------
    ValueError
        If the radius is negative or above 0.2 rad.
    """
    if not 0 <= radius_rad <= 0.2:
        raise ValueError(f"the sun's angular radius must lie between 0 and 0.2 rad, not {radius_rad:g}")
    values = np.asarray(values, float)
    n = values.shape[-1]
    step = np.pi / (n - 1)
    if radius_rad < 0.05 * step:
        return values
    # Exact mass of the profile in each cell, from its antiderivative.
    edges = np.clip((np.arange(-n + 1, n) - 0.5) * step / radius_rad, -1, 1)
    primitive = (edges * np.sqrt(1 - edges**2) + np.arcsin(edges)) / np.pi
    kernel = np.diff(primitive)  # cells around -(n - 1) .. n - 2
    kernel = np.roll(kernel, -(n - 1))  # cell 0 first, on a circle of 2 (n - 1)
    circle = np.concatenate([values, values[..., -2:0:-1]], axis=-1)
    length = circle.shape[-1]
    smoothed = np.fft.irfft(np.fft.rfft(circle) * np.fft.rfft(kernel, n=length), n=length)
    return smoothed[..., :n]
