# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that lines, pictures and letters are put on, and axes that know where a value lies on it.

Pixels are linear Rec.709, rows from the top. Coordinates are pixels, x to the right and y down.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from .font import HEIGHT, WIDTH, text_mask

Colour = Sequence[float]
INK, FAINT = (0.80, 0.80, 0.80), (0.10, 0.10, 0.10)


class Canvas:
    """A picture of one colour to begin with."""

    def __init__(self, width: int, height: int, background: Colour = (0.012, 0.012, 0.014)) -> None:
        self.pixels = np.empty((height, width, 3), np.float32)
        self.pixels[:] = background

    def rectangle(self, x: int, y: int, width: int, height: int, colour: Colour) -> None:
        self.pixels[max(y, 0) : max(y + height, 0), max(x, 0) : max(x + width, 0)] = colour

    def picture(self, x: int, y: int, pixels: np.ndarray) -> None:
        """Put a picture (h, w, 3) with its upper left corner at (x, y); it has to fit."""
        height, width = pixels.shape[:2]
        self.pixels[y : y + height, x : x + width] = pixels

    def text(self, x: int, y: int, text: str, colour: Colour = INK, scale: int = 2, align: str = "left") -> None:
        """Write a line: (x, y) is its upper left corner, upper middle or upper right."""
        mask = text_mask(text, scale)
        x -= {"left": 0, "middle": mask.shape[1] // 2, "right": mask.shape[1]}[align]
        top, left = max(0, -y), max(0, -x)
        region = self.pixels[max(y, 0) : max(y + mask.shape[0], 0), max(x, 0) : max(x + mask.shape[1], 0)]
        region[mask[top : top + region.shape[0], left : left + region.shape[1]]] = colour

    def line(self, x: np.ndarray, y: np.ndarray, colour: Colour, width: float = 1.6) -> None:
        """Draw a polyline with soft edges; a value that is not finite leaves a gap."""
        x, y = np.asarray(x, float), np.asarray(y, float)
        rows, columns = self.pixels.shape[:2]
        cover = np.zeros((rows, columns), np.float32)
        for x0, y0, x1, y1 in zip(x[:-1], y[:-1], x[1:], y[1:], strict=True):
            if not np.isfinite([x0, y0, x1, y1]).all():
                continue
            left, right = int(max(min(x0, x1) - 2, 0)), int(min(max(x0, x1) + 3, columns))
            top, bottom = int(max(min(y0, y1) - 2, 0)), int(min(max(y0, y1) + 3, rows))
            if left >= right or top >= bottom:
                continue
            px, py = np.meshgrid(np.arange(left, right) + 0.5, np.arange(top, bottom) + 0.5)
            dx, dy = x1 - x0, y1 - y0
            t = np.clip(((px - x0) * dx + (py - y0) * dy) / max(dx * dx + dy * dy, 1e-12), 0, 1)
            distance = np.hypot(px - x0 - t * dx, py - y0 - t * dy)
            part = cover[top:bottom, left:right]
            np.maximum(part, np.clip(0.5 * width + 0.5 - distance, 0, 1), out=part)
        self.pixels += cover[..., None] * (np.asarray(colour, np.float32) - self.pixels)


@dataclass(frozen=True)
class Axes:
    """A frame on a canvas: where values lie in it, and its ticks.

    Attributes
    ----------
    x, y, width, height : int
        The frame, pixels.
    across, up : (float, float)
        Values at its left and right, and at its bottom and top.
    log : bool
        Whether `up` is logarithmic.
    """

    canvas: Canvas
    x: int
    y: int
    width: int
    height: int
    across: tuple[float, float]
    up: tuple[float, float]
    log: bool = False

    def column(self, value: np.ndarray) -> np.ndarray:
        """Pixels from the left of the canvas."""
        return self.x + (np.asarray(value, float) - self.across[0]) / (self.across[1] - self.across[0]) * self.width

    def row(self, value: np.ndarray) -> np.ndarray:
        """Pixels from the top of the canvas; NaN outside of the frame on a logarithmic axis."""
        value = np.asarray(value, float)
        low, high = self.up
        if self.log:
            with np.errstate(divide="ignore", invalid="ignore"):
                t = np.log(value / low) / np.log(high / low)
            t = np.where(np.isfinite(t), t, -1.0)
        else:
            t = (value - low) / (high - low)
        return self.y + self.height * (1 - np.clip(t, -0.02, 1.02))

    def frame(
        self,
        ticks: Sequence[float] = (),
        rises: Sequence[float] = (),
        tick: Callable[[float], str] = "{:g}".format,
        rise: Callable[[float], str] = "{:g}".format,
    ) -> None:
        """Draw grid lines with their values under (`ticks`) and left (`rises`) of the frame."""
        for value in ticks:
            at = round(float(self.column(value)))
            self.canvas.rectangle(at, self.y, 1, self.height, FAINT)
            self.canvas.text(at, self.y + self.height + 5, tick(value), scale=1, align="middle")
        for value in rises:
            at = round(float(self.row(value)))
            self.canvas.rectangle(self.x, at, self.width, 1, FAINT)
            self.canvas.text(self.x - 5, at - HEIGHT // 2, rise(value), scale=1, align="right")
        for x, y, width, height in (
            (self.x, self.y, self.width, 1),
            (self.x, self.y + self.height, self.width + 1, 1),
            (self.x, self.y, 1, self.height),
            (self.x + self.width, self.y, 1, self.height),
        ):
            self.canvas.rectangle(x, y, width, height, (0.3, 0.3, 0.3))

    def curve(self, across: np.ndarray, up: np.ndarray, colour: Colour, width: float = 1.6) -> None:
        self.canvas.line(self.column(across), self.row(up), colour, width)

    def legend(self, rows: Sequence[tuple[str, Colour]], right: bool = True) -> None:
        """Names in their curves' colours, in an upper corner."""
        for number, (name, colour) in enumerate(rows):
            at = self.x + self.width - 8 if right else self.x + 8
            self.canvas.text(at, self.y + 7 + number * 11, name, colour, 1, "right" if right else "left")


def text_width(text: str, scale: int = 2) -> int:
    """Pixels that a line takes."""
    return len(text) * (WIDTH + 1) * scale
