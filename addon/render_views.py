# SPDX-License-Identifier: GPL-3.0-or-later
"""The views of a stereo or multi-view render: what they are called, and where the camera of each stands, which Blender knows."""

from __future__ import annotations

from typing import Any, NamedTuple


class View(NamedTuple):
    """One picture of a frame.

    Attributes
    ----------
    name : str
        As in Blender's list of views; empty where there is one view only.
    suffix : str
        Ending of the names of its files.
    """

    name: str = ""
    suffix: str = ""


class Place(NamedTuple):
    """Where a view's camera stands at one time: camera to world, and its shift in x, None for the lens's own."""

    matrix: Any
    shift_x: float | None = None


def views_of(render: Any) -> list[View]:
    """The views that Blender renders, at least one.

    Parameters
    ----------
    render : bpy.types.RenderSettings
    """
    if not render.use_multiview:
        return [View()]
    views = render.stereo_views if render.views_format == "STEREO_3D" else render.views
    return [View(view.name, view.file_suffix) for view in views if view.use] or [View()]


def choose(engine: Any, view: View) -> None:
    """Makes a view the one whose camera `engine.camera_override` is."""
    if view.name:
        engine.active_view_set(view.name)


def place(engine: Any, view: View, camera: Any) -> Place:
    """Where the camera of the chosen view stands.

    Parameters
    ----------
    engine : bpy.types.RenderEngine
    view : View
    camera : bpy.types.Object
        Evaluated.
    """
    if not view.name:
        return Place(camera.matrix_world.copy())
    return Place(engine.camera_model_matrix(camera).copy(), engine.camera_shift_x(camera))


def put(result: Any, view: View, name: str, pixels: Any) -> None:
    """Hands a pass of a view to Blender.

    Parameters
    ----------
    result : bpy.types.RenderResult
        Of one layer.
    name : str
        The pass's.
    pixels : ndarray
        (height, width, channels) float32, rows from the bottom up.
    """
    number = result.views.find(view.name)
    for candidate in result.layers[0].passes:
        if candidate.name == name and (not view.name or candidate.view_id == number):
            candidate.rect.foreach_set(pixels.reshape(-1))
