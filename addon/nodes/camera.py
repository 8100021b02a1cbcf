# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera as node trees see it: matrices for camera and window coordinates.

Node trees count depth as positive in front of the camera: their camera space is Blender's with z turned round.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

Rows = tuple[tuple[float, float, float, float], ...]


class CameraMatrices(NamedTuple):
    """Three rows of four each: world to camera, camera to world, and world to window.

    The third row of ``to_window`` is what the first two are divided by.
    """

    from_world: Rows
    to_world: Rows
    to_window: Rows
    position: tuple[float, float, float]


def _rows(matrix: np.ndarray) -> Rows:
    return tuple(tuple(float(x) for x in row) for row in matrix[:3])


def camera_matrices(context: Any) -> CameraMatrices | None:
    """The matrices of the render's camera; None where there is no scene or camera."""
    depsgraph = getattr(context, "depsgraph", None)
    scene = getattr(depsgraph, "scene", None)
    camera = getattr(scene, "camera", None)
    if camera is None:
        return None
    camera = camera.evaluated_get(depsgraph)
    placed = np.array(camera.matrix_world.normalized(), np.float64)
    to_world = placed @ np.diag([1.0, 1.0, -1.0, 1.0])
    from_world = np.linalg.inv(to_world)
    render = scene.render
    scale = render.resolution_percentage / 100
    projection = np.array(
        camera.calc_matrix_camera(
            depsgraph,
            x=max(1, int(render.resolution_x * scale)),
            y=max(1, int(render.resolution_y * scale)),
            scale_x=render.pixel_aspect_x,
            scale_y=render.pixel_aspect_y,
        ),
        np.float64,
    )
    clip = projection @ np.linalg.inv(placed)  # x and y in -w..w
    window = np.array([(clip[0] + clip[3]) / 2, (clip[1] + clip[3]) / 2, clip[3]])
    return CameraMatrices(_rows(from_world), _rows(to_world), _rows(window), tuple(float(x) for x in placed[:3, 3]))
