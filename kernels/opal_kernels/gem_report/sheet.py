# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of a gem report: the stone face-up, its fire, the curve over the tilt, and the numbers."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import numpy as np

from ..charts.canvas import Axes, Canvas, text_width
from .measures import FISH_EYE, NAIL_HEAD, Report

_WHITE, _RED, _BLUE, _GREY = (0.8, 0.8, 0.8), (0.9, 0.15, 0.1), (0.15, 0.35, 0.95), (0.35, 0.35, 0.35)
_MARGIN = 24
# Pixels from one line of a note to the next.
_LINE = 14


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


def verdicts(report: Report) -> list[tuple[str, bool]]:
    """The faults of a pavilion, each with the share from which it is called so, and whether this stone has it."""
    faults = (("fish-eye", FISH_EYE, report.has_fish_eye), ("nail-head", NAIL_HEAD, report.has_nail_head))
    return [(f"{name} (over {least:g})" if seen else f"no {name} (up to {least:g})", seen) for name, least, seen in faults]


def table(report: Report, title: str = "Gem report", notes: Sequence[str] = ()) -> str:
    """The report as text: a line a number, a line a tilt, then what the numbers leave out."""
    lines = [title, ""]
    lines += [f"{name:<16}{value:8.4f}" for name, value in rows(report)]
    lines += ["", *(text for text, _ in verdicts(report))]
    lines += ["", f"{'tilt (degrees)':<16}{'return':>8}{'head':>8}{'leakage':>9}{'absorbed':>10}"]
    for tilt, shares in zip(report.tilts, report.tilt_curve, strict=True):
        lines.append(f"{tilt:<16.1f}{shares.light_return:8.4f}{shares.head:8.4f}{shares.leakage:9.4f}{shares.absorbed:10.4f}")
    lines += ["", *notes] if notes else []
    return "\n".join(lines) + "\n"


def draw(report: Report, picture: np.ndarray, fire: np.ndarray, title: str = "Gem report", notes: Sequence[str] = ()) -> np.ndarray:
    """The page.

    Parameters
    ----------
    picture, fire : ndarray
        (size, size, 4), of `pictures.face_up` and `pictures.flashes`, at least 128 pixels across.
    notes : sequence of str
        Sentences on what the numbers leave out, below them.

    Returns
    -------
    ndarray
        (height, width, 3) linear Rec.709, rows from the top.
    """
    size = picture.shape[0]
    plot = max(size, 256)
    width = 2 * size + plot + 4 * _MARGIN + 40
    lines = rows(report)
    small = [line for note in notes for line in textwrap.wrap(note, (width - 2 * _MARGIN) // text_width(" ", 1))]
    height = size + 3 * _MARGIN + 40 + 20 * ((len(lines) + 1) // 2) + _LINE * len(small)
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
    scale = 2 if size >= text_width("light return: 0.000") else 1
    for number, (name, value) in enumerate(lines):
        canvas.text(_MARGIN + (number % 2) * (size + _MARGIN), below + 20 * (number // 2), f"{name}: {value:.3f}", scale=scale)
    for number, (text, seen) in enumerate(verdicts(report)):
        canvas.text(x, below + 20 * number, text, _RED if seen else _WHITE, scale=2)
    below += 20 * ((len(lines) + 1) // 2)
    for number, line in enumerate(small):
        canvas.text(_MARGIN, below + _LINE * number, line, scale=1)
    return canvas.pixels


def _over(image: np.ndarray, background: tuple[float, float, float]) -> np.ndarray:
    """A picture with alpha, rows from the bottom up, over a colour, rows from the top."""
    alpha = np.clip(image[..., 3:4], 0, 1)
    return (image[..., :3] + (1 - alpha) * np.asarray(background, np.float32))[::-1]
