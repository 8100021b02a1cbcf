# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a picture is from a reference, in the figures that the field uses.

Pictures are (height, width, 3), linear Rec.709. What is meant for eyes (PSNR, SSIM, FLIP) is taken of the sRGB encoding, clipped to
0 ... 1; what is meant for estimators (relative MSE, mean ratio) of the linear values, unclipped.
"""

from __future__ import annotations

from typing import Any

import numpy as np

# Keeps dark pixels from ruling the relative error (Rousselle, Knaus & Zwicker 2011, "Adaptive Sampling and Reconstruction").
_EPSILON = 1e-2


def srgb(linear: np.ndarray) -> np.ndarray:
    """The sRGB encoding (IEC 61966-2-1) of linear values clipped to 0 ... 1."""
    c = np.clip(linear, 0.0, 1.0)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * np.power(c, 1 / 2.4) - 0.055)


def relative_mse(picture: np.ndarray, reference: np.ndarray) -> float:
    """Mean of (a - b)² / (b² + 0.01) over pixels and channels."""
    a, b = _pair(picture, reference)
    return float(np.mean((a - b) ** 2 / (b**2 + _EPSILON)))


def psnr(picture: np.ndarray, reference: np.ndarray) -> float:
    """Peak signal-to-noise ratio in dB of the sRGB encodings; infinite for equal pictures."""
    a, b = _pair(picture, reference)
    error = float(np.mean((srgb(a) - srgb(b)) ** 2))
    return float("inf") if error == 0 else -10.0 * float(np.log10(error))


def ssim(picture: np.ndarray, reference: np.ndarray) -> float:
    """Mean structural similarity of the encoded luma, -1 to 1 (Wang et al. 2004: Gaussian window of 11 pixels, σ 1.5).

    Raises
    ------
    ValueError
        If a side is shorter than the window.
    """
    a, b = _pair(picture, reference)
    if min(a.shape[:2]) < 11:
        raise ValueError("Structural similarity needs pictures of at least 11 x 11 pixels.")
    luma = np.array([0.2126, 0.7152, 0.0722])
    x, y = srgb(a) @ luma, srgb(b) @ luma
    mx, my = _blurred(x), _blurred(y)
    vx, vy, covariance = _blurred(x * x) - mx**2, _blurred(y * y) - my**2, _blurred(x * y) - mx * my
    c1, c2 = 0.01**2, 0.03**2
    score = (2 * mx * my + c1) * (2 * covariance + c2) / ((mx**2 + my**2 + c1) * (vx + vy + c2))
    return float(score.mean())


def flip(picture: np.ndarray, reference: np.ndarray) -> float | None:
    """Mean LDR-FLIP (Andersson et al. 2020) by the package ``flip_evaluator``; None where it is not installed."""
    try:
        import flip_evaluator
    except ImportError:
        return None
    a, b = _pair(picture, reference)
    _, mean, _ = flip_evaluator.evaluate(np.clip(b, 0, 1).astype(np.float32), np.clip(a, 0, 1).astype(np.float32), "LDR", inputsRGB=False)
    return float(mean)


def mean_ratio(picture: np.ndarray, reference: np.ndarray) -> list[float | None]:
    """Mean of the picture over mean of the reference, a channel; None where the reference is black."""
    a, b = _pair(picture, reference)
    return [float(x / y) if y > 0 else None for x, y in zip(a.mean((0, 1)), b.mean((0, 1)), strict=True)]


def all_of(picture: np.ndarray, reference: np.ndarray) -> dict[str, Any]:
    """Every figure by name, in JSON's types; what cannot be had is None."""
    small = min(picture.shape[:2]) < 11
    noise = psnr(picture, reference)
    return {
        "relative_mse": relative_mse(picture, reference),
        "psnr": noise if np.isfinite(noise) else None,
        "ssim": None if small else ssim(picture, reference),
        "flip": flip(picture, reference),
        "mean_ratio": mean_ratio(picture, reference),
    }


def regions(picture: np.ndarray, reference: np.ndarray, columns: int, rows: int) -> list[dict[str, Any]]:
    """Means of both pictures over a grid of regions, with how sure their ratio is.

    Returns
    -------
    list of dict
        From the bottom left, row by row: ``box`` (x0, y0, x1, y1 in pixels), ``picture`` and ``reference`` (means a channel),
        ``ratio`` (of their sums over channels, None in the dark) and ``error``, the standard error of that ratio from the spread of
        the difference between neighbouring pixels.
    """
    a, b = _pair(picture, reference)
    height, width = a.shape[:2]
    found = []
    for j in range(rows):
        for i in range(columns):
            x0, x1 = i * width // columns, (i + 1) * width // columns
            y0, y1 = j * height // rows, (j + 1) * height // rows
            ours, theirs = a[y0:y1, x0:x1], b[y0:y1, x0:x1]
            total = theirs.mean((0, 1)).sum()
            difference = (ours - theirs).sum(axis=2)
            steps = np.diff(difference, axis=1) if difference.shape[1] > 1 else np.zeros((1, 1))
            noise = np.sqrt(np.mean(steps**2) / 2 / difference.size)
            found.append(
                {
                    "box": [x0, y0, x1, y1],
                    "picture": ours.mean((0, 1)).tolist(),
                    "reference": theirs.mean((0, 1)).tolist(),
                    "ratio": float(ours.mean((0, 1)).sum() / total) if total > 1e-6 else None,
                    "error": float(noise / total) if total > 1e-6 else None,
                }
            )
    return found


def _pair(picture: np.ndarray, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    a, b = np.asarray(picture, np.float64)[..., :3], np.asarray(reference, np.float64)[..., :3]
    if a.shape != b.shape:
        raise ValueError(f"The pictures differ in size: {a.shape[1]} x {a.shape[0]} and {b.shape[1]} x {b.shape[0]} pixels.")
    return a, b


def _blurred(plane: np.ndarray) -> np.ndarray:
    """Gaussian window of 11 pixels and σ 1.5, where it lies wholly inside."""
    taps = np.exp(-0.5 * (np.arange(-5, 6) / 1.5) ** 2)
    taps /= taps.sum()
    for axis in (0, 1):
        size = plane.shape[axis] - 10
        plane = sum(t * np.take(plane, np.arange(k, k + size), axis) for k, t in enumerate(taps))
    return plane
