# SPDX-License-Identifier: GPL-3.0-or-later
"""The error of a picture, and the time at which it would be small enough.

Relative MSE is mean((I - R)² / (R² + 0.1 mean(R)²)) over pixels and channels, without the worst 0.1 % of pixels; R is a converged
reference of the renderer's own, so that it is noise which is measured and not a difference of opinion.
"""

from __future__ import annotations

import numpy as np


def relative_mse(image: np.ndarray, reference: np.ndarray, only: np.ndarray | None = None) -> float:
    """Relative MSE of a picture; both (height, width, 3), ``only`` an optional (height, width) mask of the pixels
    that count: the mean of the reference, too, is theirs, so that black ground does not decide."""
    if only is not None:
        image, reference = image[only], reference[only]
    squares = np.sort(((image - reference) ** 2 / (reference**2 + 0.1 * reference.mean() ** 2)).mean(axis=-1).ravel())
    return float(squares[: max(1, int(len(squares) * 0.999))].mean())


def bright(reference: np.ndarray) -> np.ndarray:
    """The caustic's pixels: brighter than 5 % of the 99.5 percentile."""
    luminance = reference.mean(axis=-1)
    return luminance > 0.05 * np.quantile(luminance, 0.995)


def time_to(error: float, seconds: np.ndarray, errors: np.ndarray) -> float:
    """Seconds from which on the error is reached: between two snapshots by a power law, beyond them as an unbiased mean falls, by 1/t.

    What counts is the last snapshot above it: a picture that lacks its rare, strong paths looks better before the first of them.
    """
    t, e = np.asarray(seconds, float), np.asarray(errors, float)
    above = np.flatnonzero(e > error)
    if len(above) == 0:
        return float(t[0] * e[0] / error)
    i = above[-1]
    if i == len(e) - 1:
        return float(t[-1] * e[-1] / error)
    part = np.log(e[i] / error) / np.log(e[i] / e[i + 1])
    return float(t[i] * (t[i + 1] / t[i]) ** part)
