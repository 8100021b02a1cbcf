# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a 3D view that is rendered: all of it, or what a border (Ctrl B) leaves. Cycles takes the same pixels."""

from __future__ import annotations

from typing import Any

from opal_kernels import camera as optics

from .translate.camera import camera_from_object, looked_through


def region_of_view(scene: Any, space: Any, region_data: Any, width: int, height: int, window: optics.Window) -> tuple[int, int, int, int]:
    """Pixels x0, y0, x1, y1 (y up, ends excluded); at least one.

    Parameters
    ----------
    scene : bpy.types.Scene
        Its border counts where the view looks through a camera.
    space : bpy.types.SpaceView3D
        Its border counts in any other view.
    region_data : bpy.types.RegionView3D
    width, height : int
        Pixels of the view.
    window : tuple of float
        Of the view's camera.
    """
    border = _border_of_camera(scene, space, region_data, window) if region_data.view_perspective == "CAMERA" else _border_of_space(space)
    return (0, 0, width, height) if border is None else optics.border_region(width, height, border)


def _border_of_space(space: Any) -> optics.Border | None:
    if not space.use_render_border:
        return None
    return space.render_border_min_x, space.render_border_max_x, space.render_border_min_y, space.render_border_max_y


def _border_of_camera(scene: Any, space: Any, region_data: Any, window: optics.Window) -> optics.Border | None:
    render, camera_object = scene.render, looked_through(scene, space, region_data)
    if camera_object is None or not render.use_border:
        return None
    frame = camera_from_object(camera_object, scene, render.resolution_x, render.resolution_y).window
    border = render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y
    return optics.border_in_view(border, frame, window)
