# SPDX-License-Identifier: GPL-3.0-or-later
"""The arithmetic between a photographer's camera and the tracer's: lens, sensor, shift, f-number, border.

The tracer's camera has a *window*: left, right, bottom and top of the full frame, at distance 1 for perspective and in metres
for orthographic projection (``opal_camera_desc``). Conventions are Blender's: sensors and lenses in millimetres, shift in
units of the sensor side that fits, the aperture radius half of lens / f-number.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

Window = tuple[float, float, float, float]
# Left, right, bottom and top in fractions of a frame or a view.
Border = tuple[float, float, float, float]


def fits_horizontally(sensor_fit: str, width: float, height: float) -> bool:
    """Whether the sensor's size spans the frame's width (else its height).

    Parameters
    ----------
    sensor_fit : {'AUTO', 'HORIZONTAL', 'VERTICAL'}
        AUTO takes the longer side.
    width, height : float
        Of the frame, in pixels times pixel aspect.
    """
    return sensor_fit == "HORIZONTAL" or (sensor_fit == "AUTO" and width > height)


def window(
    width: int,
    height: int,
    *,
    pixel_aspect: tuple[float, float] = (1.0, 1.0),
    lens: float = 50.0,
    sensor_width: float = 36.0,
    sensor_height: float = 24.0,
    sensor_fit: str = "AUTO",
    shift: tuple[float, float] = (0.0, 0.0),
    ortho_scale: float | None = None,
    zoom: float = 1.0,
    offset: tuple[float, float] = (0.0, 0.0),
) -> Window:
    """The frame's window.

    Parameters
    ----------
    width, height : int
        Pixels of the full frame.
    pixel_aspect : tuple of float
        Width and height of a pixel in any common unit.
    lens, sensor_width, sensor_height : float
        Millimetres.
    sensor_fit : {'AUTO', 'HORIZONTAL', 'VERTICAL'}
        Which side of the frame the sensor's size spans.
    shift : tuple of float
        Of the lens, in units of the fitted side.
    ortho_scale : float, optional
        Orthographic: metres across the fitted side. None is perspective.
    zoom : float
        Widens the window about the centre of the unshifted frame (3D views).
    offset : tuple of float
        Moves the window by this many of its unzoomed sizes (3D views).

    Returns
    -------
    tuple of float
        Left, right, bottom, top.

    Raises
    ------
    ValueError
        If a size is not positive.
    """
    x, y = width * pixel_aspect[0], height * pixel_aspect[1]
    horizontal = fits_horizontally(sensor_fit, x, y)
    if ortho_scale is None:
        side = (sensor_height if sensor_fit == "VERTICAL" else sensor_width) / lens if lens > 0 else 0.0
    else:
        side = ortho_scale
    if not (x > 0 and y > 0 and side > 0 and math.isfinite(side)):
        raise ValueError(f"A camera needs a frame and a field of view: {width} x {height} pixels, side {side}.")
    frame_x, frame_y = (side, side * y / x) if horizontal else (side * x / y, side)
    centre_x = shift[0] * side + 2 * offset[0] * frame_x
    centre_y = shift[1] * side + 2 * offset[1] * frame_y
    half_x, half_y = 0.5 * zoom * frame_x, 0.5 * zoom * frame_y
    return centre_x - half_x, centre_x + half_x, centre_y - half_y, centre_y + half_y


def aperture_radius(fstop: float, lens: float | None = None) -> float:
    """Radius in metres of the aperture of a lens (mm) at an f-number; without a lens (orthographic) of one of 1 m."""
    return (1.0 if lens is None else lens * 1e-3) / (2.0 * max(fstop, 1e-5))


def rigid(matrix: Sequence[Sequence[float]]) -> np.ndarray:
    """A matrix without its scale, float64 of shape (3, 4).

    Axes without length become those of the identity, so that an object scaled to nothing still looks somewhere.
    """
    m = np.array(matrix, dtype=np.float64)[:3, :4].copy()
    for axis in range(3):
        size = np.linalg.norm(m[:, axis])
        m[:, axis] = m[:, axis] / size if size > 0 and np.isfinite(size) else np.eye(3)[axis]
    return m


def depth_along_axis(matrix: Sequence[Sequence[float]], point: Sequence[float]) -> float:
    """Distance of a point from a camera, measured along its axis: what focusing on it means."""
    m = rigid(matrix)
    return float(abs(np.dot(m[:, 2], m[:, 3] - np.asarray(point, dtype=np.float64)[:3])))


def border_region(width: int, height: int, border: Border) -> tuple[int, int, int, int]:
    """Pixels x0, y0, x1, y1 (y up, ends excluded) of a border; at least one.

    Blender multiplies in single precision: in double, 0.58 of 300 would be 173 and not 174 pixels.
    """
    left, right, bottom, top = (np.float32(min(max(b, 0.0), 1.0)) for b in border)
    across, up = np.float32(width), np.float32(height)
    x0, y0 = min(int(left * across), width - 1), min(int(bottom * up), height - 1)
    return x0, y0, max(int(right * across), x0 + 1), max(int(top * up), y0 + 1)


def border_in_view(border: Border, frame: Window, view: Window) -> Border:
    """A border of a camera's frame as one of a 3D view that looks through that camera, which may reach beyond the view.

    Parameters
    ----------
    border : tuple of float
        In fractions of the frame.
    frame, view : tuple of float
        Windows (`window`) of the camera's frame and of the view.
    """

    def along(part: float, axis: int) -> float:
        low, high = frame[axis : axis + 2]
        start, end = view[axis : axis + 2]
        return (low + part * (high - low) - start) / (end - start)

    return along(border[0], 0), along(border[1], 0), along(border[2], 2), along(border[3], 2)


def window_of_region(window: Window, width: int, height: int, region: tuple[int, int, int, int]) -> Window:
    """The window of some pixels (x0, y0, x1, y1; ends excluded) of a frame of so many pixels."""

    def along(pixel: int, pixels: int, axis: int) -> float:
        part = pixel / pixels
        return window[axis] * (1 - part) + window[axis + 1] * part  # to the bit the window's own at both its ends

    x0, y0, x1, y1 = region
    return along(x0, width, 0), along(x1, width, 0), along(y0, height, 2), along(y1, height, 2)


def view_zoom(view_camera_zoom: float) -> float:
    """What the zoom of a 3D view that looks through its camera makes of the window, from Blender's -30 to 600."""
    return 2.0 / (math.sqrt(2.0) + view_camera_zoom / 50.0) ** 2
