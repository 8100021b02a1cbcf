# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a comparison: side by side, and the signed difference with a legend.

Arrays have rows from the bottom up; colours of the map are display (sRGB) values.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

# Diverging map: Opal darker, equal, Opal brighter (ColorBrewer's RdBu, reversed).
_ANCHORS = np.array([(5, 48, 97), (67, 147, 195), (247, 247, 247), (214, 96, 77), (103, 0, 31)]) / 255.0
# A font of 3 x 5 dots for the legend's numbers: rows from the top, a bit a dot.
_FONT = {
    "0": (7, 5, 5, 5, 7),
    "1": (2, 6, 2, 2, 7),
    "2": (7, 1, 7, 4, 7),
    "3": (7, 1, 7, 1, 7),
    "4": (5, 5, 7, 1, 1),
    "5": (7, 4, 7, 1, 7),
    "6": (7, 4, 7, 5, 7),
    "7": (7, 1, 2, 2, 2),
    "8": (7, 5, 7, 5, 7),
    "9": (7, 5, 7, 1, 7),
    "+": (0, 2, 7, 2, 0),
    "-": (0, 0, 7, 0, 0),
    ".": (0, 0, 0, 0, 2),
    "%": (5, 1, 2, 4, 5),
}
_GAP = 2


def side_by_side(ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Opal left, Cycles right, a line between; (height, 2 width + 2, 4), scene-linear."""
    line = np.ones((ours.shape[0], _GAP, 4), np.float32)
    return np.concatenate((ours, line, theirs), axis=1).astype(np.float32)


def limit_of(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Where the map's colours end: the difference that 99 of 100 pixels keep below, at least 1 % of the mean brightness."""
    difference = np.abs(ours[..., :3].mean(axis=2) - theirs[..., :3].mean(axis=2))
    return max(float(np.quantile(difference, 0.99)), 0.01 * float(np.abs(theirs[..., :3]).mean()), 1e-6)


def draw(ours: np.ndarray, theirs: np.ndarray, limit: float, boxes: Iterable[Any] = ()) -> np.ndarray:
    """The signed difference of brightness, Opal less Cycles, with a legend below; (height + legend, width, 4) display values.

    Parameters
    ----------
    limit : float
        Linear difference of the deepest colours.
    boxes : iterable of (x0, y0, x1, y1)
        Regions whose outlines are drawn.
    """
    difference = (ours[..., :3].mean(axis=2) - theirs[..., :3].mean(axis=2)) / limit
    picture = _colors(difference)
    for x0, y0, x1, y1 in boxes:
        picture[y0, x0:x1] = picture[y1 - 1, x0:x1] = picture[y0:y1, x0] = picture[y0:y1, x1 - 1] = 0.25
    width = max(picture.shape[1], 64)
    picture = np.pad(picture, ((0, 0), (0, width - picture.shape[1]), (0, 0)), constant_values=1.0)
    scale = max(1, width // 240)
    legend = _legend(width, limit, scale)
    whole = np.concatenate((legend, picture), axis=0)
    return np.concatenate((whole, np.ones((*whole.shape[:2], 1))), axis=2).astype(np.float32)


def _colors(values: np.ndarray) -> np.ndarray:
    place = (np.clip(values, -1.0, 1.0) + 1.0) * 0.5
    nodes = np.linspace(0.0, 1.0, len(_ANCHORS))
    return np.stack([np.interp(place, nodes, _ANCHORS[:, c]) for c in range(3)], axis=-1)


def _legend(width: int, limit: float, scale: int) -> np.ndarray:
    """A bar of the map's colours over the numbers of its ends and middle."""
    text_height, bar = 7 * scale, 6 * scale
    legend = np.ones((text_height + bar, width, 3))
    legend[text_height:] = _colors(np.linspace(-1, 1, width))[None]
    number = f"{limit:.2g}" if limit >= 1e-3 else f"{limit:.5f}"
    for text, align in ((f"-{number}", 0.0), ("0", 0.5), (f"+{number}", 1.0)):
        _write(legend, text, align, scale)
    return legend


def _write(canvas: np.ndarray, text: str, align: float, scale: int) -> None:
    text = "".join(letter for letter in text if letter in _FONT)
    wide = (4 * len(text) - 1) * scale
    x = int(round(align * (canvas.shape[1] - wide - 2 * scale))) + scale
    for letter in text:
        for row, bits in enumerate(_FONT[letter]):
            for column in range(3):
                if bits >> (2 - column) & 1:
                    y = (5 - row) * scale
                    canvas[y : y + scale, x + column * scale : x + (column + 1) * scale] = 0.0
        x += 4 * scale
