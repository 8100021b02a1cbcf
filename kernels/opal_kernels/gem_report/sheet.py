# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of a gem report: the stone face-up, its fire, the curve over the tilt, and the numbers."""

from __future__ import annotations

import numpy as np

from ..charts.canvas import Axes, Canvas
from .measures import Report

_WHITE, _RED, _BLUE, _GREY = (0.8, 0.8, 0.8), (0.9, 0.15, 0.1), (0.15, 0.35, 0.95), (0.35, 0.35, 0.35)
_MARGIN = 24


def rows(report: Report) -> list[tuple[str, float]]:
    """Names and values of a report's numbers, shares as parts of 1, fire in degrees."""
    f = report.face_up
    return [
        ("light return", f.light_return),
        ("glare", report.glare),
        ("head shadow", f.head),
        ("leakage", f.leakage),
        ("absorbed", f.absorbed),
        ("fire (degrees)", report.fire),
        ("fish-eye", report.fish_eye),
        ("nail-head", report.nail_head),
    ]


def table(report: Report, title: str = "Gem report") -> str:
    """The report as text: a line a number, then a line a tilt."""
    lines = [title, ""]
    lines += [f"{name:<16}{value:8.4f}" for name, value in rows(report)]
    lines += ["", f"{'tilt (degrees)':<16}{'return':>8}{'head':>8}{'leakage':>9}{'absorbed':>10}"]
    for tilt, shares in zip(report.tilts, report.tilt_curve, strict=True):
        lines.append(f"{tilt:<16.1f}{shares.light_return:8.4f}{shares.head:8.4f}{shares.leakage:9.4f}{shares.absorbed:10.4f}")
    return "\n".join(lines) + "\n"


def draw(report: Report, picture: np.ndarray, fire: np.ndarray, title: str = "Gem report") -> np.ndarray:
    """The page.

    Parameters
    ----------
    picture, fire : ndarray
        (size, size, 4), of `pictures.face_up` and `pictures.flashes`, at least 128 pixels across.

    Returns
    -------
    ndarray
        (height, width, 3) linear Rec.709, rows from the top.
    """
    size = picture.shape[0]
    plot = max(size, 256)
    width = 2 * size + plot + 4 * _MARGIN + 40
    lines = rows(report)
    height = size + 3 * _MARGIN + 40 + 20 * ((len(lines) + 1) // 2)
    canvas = Canvas(width, height)
    canvas.text(_MARGIN, 12, title, scale=2)
    top = _MARGIN + 20
    for number, (image, name) in enumerate(((picture, "face-up, hemisphere and head"), (fire, "fire: small lamps in the dark"))):
        x = _MARGIN + number * (size + _MARGIN)
        canvas.picture(x, top, _over(image, (0.05, 0.05, 0.05)))
        canvas.text(x, top + size + 6, name, scale=1)
    x = 3 * _MARGIN + 2 * size + 30
    span = (float(report.tilts.min()), float(report.tilts.max())) if len(report.tilts) > 1 else (-1.0, 1.0)
    axes = Axes(canvas, x, top, plot - 30, size, span, (0.0, 1.0))
    step = 10.0 if span[1] - span[0] <= 80 else 30.0
    axes.frame(np.arange(np.ceil(span[0] / step) * step, span[1] + 1e-6, step), (0.0, 0.2, 0.4, 0.6, 0.8, 1.0))
    curves = (
        ("light return", _WHITE, "light_return"),
        ("head", _GREY, "head"),
        ("leakage", _RED, "leakage"),
        ("absorbed", _BLUE, "absorbed"),
    )
    for _, colour, key in curves:
        axes.curve(report.tilts, np.array([getattr(shares, key) for shares in report.tilt_curve]), colour)
    axes.legend([(name, colour) for name, colour, _ in curves])
    canvas.text(x + (plot - 30) // 2, top + size + 20, "tilt, degrees", scale=1, align="middle")
    below = top + size + 36
    for number, (name, value) in enumerate(lines):
        canvas.text(_MARGIN + (number % 2) * (size + _MARGIN), below + 20 * (number // 2), f"{name}: {value:.3f}", scale=2)
    verdicts = [text for seen, text in ((report.has_fish_eye, "fish-eye"), (report.has_nail_head, "nail-head")) if seen]
    canvas.text(x, below, " and ".join(verdicts) or "no fish-eye,", _RED if verdicts else _WHITE, scale=2)
    if not verdicts:
        canvas.text(x, below + 20, "no nail-head", _WHITE, scale=2)
    return canvas.pixels


def _over(image: np.ndarray, background: tuple[float, float, float]) -> np.ndarray:
    """A picture with alpha, rows from the bottom up, over a colour, rows from the top."""
    alpha = np.clip(image[..., 3:4], 0, 1)
    return (image[..., :3] + (1 - alpha) * np.asarray(background, np.float32))[::-1]
