# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender's cameras and 3D views to the tracer's camera. The arithmetic is ``opal_kernels.camera``'s."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from opal_kernels import camera as optics
from opal_kernels.descriptions import Camera, CameraType

from ..finiteness import all_finite, matrix_is_finite, misplaced_by
from ..identity import Named

Report = Callable[..., None]  # `report.Report.add`

# Numbers of a camera that make its window and its clipping: property, label.
_NUMBERS = (
    ("lens", "Focal Length"),
    ("sensor_width", "Sensor Width"),
    ("sensor_height", "Sensor Height"),
    ("shift_x", "Shift X"),
    ("shift_y", "Shift Y"),
    ("ortho_scale", "Orthographic Scale"),
    ("clip_start", "Clip Start"),
    ("clip_end", "Clip End"),
)


def _ignore(*_what: Any) -> None:
    pass


def focus_distance(camera_object: Any, matrix: Any) -> float:
    """Distance in metres along the camera's axis of what it focuses on: an object, one of its bones, or a number."""
    dof = camera_object.data.dof
    target = dof.focus_object
    if target is None:
        return dof.focus_distance
    place = target.matrix_world
    bone = target.pose.bones.get(dof.focus_subtarget) if target.pose and dof.focus_subtarget else None
    if bone is not None:
        place = place @ bone.matrix
    return optics.depth_along_axis(matrix, place.translation)


def _lens(camera_object: Any, scene: Any, matrix: Any, report: Report) -> tuple[dict[str, Any], dict[str, Any]]:
    """Arguments for ``optics.window`` and fields of ``Camera`` that an object looked through gives."""
    data = camera_object.data
    if getattr(data, "bl_rna", None) is not None and data.bl_rna.identifier != "Camera":  # looking through a lamp
        spot = getattr(data, "spot_size", math.pi / 2)
        return {"lens": 16.0 / math.tan(0.5 * spot)}, {
            "clip_start": 1e-5,
            "clip_end": 1e5,
        }
    orthographic = data.type == "ORTHO"
    if data.type not in {"PERSP", "ORTHO"}:
        report(
            Named(camera_object),
            "Opal has no panoramic or custom cameras: this one is rendered as perspective",
            "Lens Type",
        )
    window = {
        "lens": data.lens,
        "sensor_width": data.sensor_width,
        "sensor_height": data.sensor_height,
        "sensor_fit": data.sensor_fit,
        "shift": (data.shift_x, data.shift_y),
        "ortho_scale": data.ortho_scale if orthographic else None,
    }
    fields: dict[str, Any] = {
        "type": CameraType.ORTHOGRAPHIC if orthographic else CameraType.PERSPECTIVE,
        "clip_start": data.clip_start,
        "clip_end": data.clip_end,
    }
    opal = getattr(data, "opal", None)
    if opal is not None and opal.polarizer:
        fields |= {"polarizer": 1, "polarizer_angle": opal.polarizer_angle}
    if data.dof.use_dof:
        fields |= {
            "aperture_radius": optics.aperture_radius(data.dof.aperture_fstop, None if orthographic else data.lens),
            "focus_distance": max(focus_distance(camera_object, matrix), 1e-5),
            "blades": data.dof.aperture_blades,
            "blade_rotation": data.dof.aperture_rotation,
            "aperture_ratio": data.dof.aperture_ratio,
        }
    return window, fields


def _refuse_what_is_not_finite(camera_object: Any, matrices: Iterable[Any], fields: dict[str, Any]) -> None:
    data = camera_object.data
    wrong = [misplaced_by(camera_object) for m in matrices if not matrix_is_finite(m)]
    wrong += [label for name, label in _NUMBERS if not all_finite([getattr(data, name, 0.0)])]
    if wrong or not all_finite(fields.values()):
        wrong.append("Depth of Field")
        raise ValueError(f"The camera “{camera_object.name}” cannot be rendered from: its {wrong[0]} is not finite.")


def camera_from_object(
    camera_object: Any,
    scene: Any,
    width: int,
    height: int,
    *,
    matrix: Any = None,
    matrix_ends: Sequence[Any] = (),
    shift_x: float | None = None,
    report: Report = _ignore,
) -> Camera:
    """The camera of a final render.

    Parameters
    ----------
    camera_object : bpy.types.Object
        Evaluated camera (or lamp looked through).
    scene : bpy.types.Scene
        Gives the pixel aspect.
    width, height : int
        Pixels of the full frame, resolution percentage applied.
    matrix : Matrix, optional
        Camera to world, in the middle of the shutter; the object's own by default.
    matrix_ends : sequence of Matrix
        The same at shutter open and close, or nothing: it stands still.
    shift_x : float, optional
        Of an eye of a stereo camera, instead of the lens's own.
    report : callable
        Takes a name and a sentence for what cannot be kept.

    Raises
    ------
    ValueError
        If the frame or the field of view is empty, or a number of the camera is not finite.
    """
    matrix = camera_object.matrix_world if matrix is None else matrix
    window, fields = _lens(camera_object, scene, matrix, report)
    if shift_x is not None and "shift" in window:
        window["shift"] = (shift_x, window["shift"][1])
    _refuse_what_is_not_finite(camera_object, (matrix, *matrix_ends), fields)
    aspect = (scene.render.pixel_aspect_x, scene.render.pixel_aspect_y)
    start, end = map(optics.rigid, matrix_ends) if matrix_ends else (None, None)
    return Camera(
        transform=optics.rigid(matrix),
        transform_start=start,
        transform_end=end,
        window=optics.window(width, height, pixel_aspect=aspect, **window),
        **fields,
    )


def looked_through(scene: Any, space: Any, region_data: Any) -> Any:
    """The object that a 3D view looks through; None where it looks through none."""
    if region_data.view_perspective != "CAMERA":
        return None
    return space.camera if space.use_local_camera else scene.camera


def camera_from_view(
    scene: Any,
    space: Any,
    region_data: Any,
    width: int,
    height: int,
    report: Report = _ignore,
) -> Camera:
    """The camera of a 3D view.

    Parameters
    ----------
    scene : bpy.types.Scene
        Its camera is used where the view looks through one.
    space : bpy.types.SpaceView3D
        Gives lens, clipping and the local camera.
    region_data : bpy.types.RegionView3D
        Gives the view's matrix, perspective, zoom and offset.
    width, height : int
        Pixels of the region.
    """
    matrix = region_data.view_matrix.inverted()
    zoom = 2.0
    window: dict[str, Any] = {"lens": space.lens}
    fields: dict[str, Any] = {
        "clip_start": space.clip_start,
        "clip_end": space.clip_end,
    }
    if (camera_object := looked_through(scene, space, region_data)) is not None:
        window, fields = _lens(camera_object, scene, matrix, report)
        zoom = 2.0 * optics.view_zoom(region_data.view_camera_zoom)
        window["offset"] = tuple(region_data.view_camera_offset)
    elif region_data.view_perspective == "ORTHO":
        reach = 0.5 * space.clip_end
        window["ortho_scale"] = region_data.view_distance * 36.0 / space.lens
        fields = {
            "type": CameraType.ORTHOGRAPHIC,
            "clip_start": -reach,
            "clip_end": reach,
        }
    return Camera(
        transform=optics.rigid(matrix),
        window=optics.window(width, height, zoom=zoom, **window),
        **fields,
    )
