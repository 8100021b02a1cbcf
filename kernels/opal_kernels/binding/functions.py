# SPDX-License-Identifier: GPL-3.0-or-later
"""The functions of ``include/opal.h``: what each returns and takes."""

from __future__ import annotations

from ctypes import POINTER, c_char_p, c_double, c_float, c_int32, c_int64, c_void_p
from typing import Any

from .structures import (
    CameraStruct,
    FloatPointer,
    GridFaultsStruct,
    GridStruct,
    ImageStruct,
    InstancesStruct,
    IntPointer,
    LightStruct,
    MaterialStruct,
    MediumStruct,
    MeshStruct,
    PhaseStruct,
    PlacesStruct,
    ProgramStruct,
    RenderSettingsStruct,
    RenderStatisticsStruct,
    SceneStatisticsStruct,
    TablesStruct,
    WorldStruct,
)

SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "opal_last_error": (c_char_p, []),
    "opal_api_version": (c_int32, []),
    "opal_cpu_level": (c_int32, []),
    "opal_scene_create": (c_void_p, [POINTER(TablesStruct), c_char_p, c_int32]),
    "opal_scene_destroy": (None, [c_void_p]),
    "opal_scene_add_image": (c_int32, [c_void_p, POINTER(ImageStruct)]),
    "opal_scene_add_spectrum": (c_int32, [c_void_p, FloatPointer]),
    "opal_scene_set_spectrum": (c_int32, [c_void_p, c_int32, FloatPointer]),
    "opal_scene_add_phase": (c_int32, [c_void_p, POINTER(PhaseStruct)]),
    "opal_scene_add_medium": (c_int32, [c_void_p, POINTER(MediumStruct)]),
    "opal_scene_add_grid": (c_int32, [c_void_p, POINTER(GridStruct)]),
    "opal_scene_set_grid_block": (
        c_int32,
        [c_void_p, c_int32, IntPointer, IntPointer, FloatPointer, POINTER(GridFaultsStruct)],
    ),
    "opal_scene_set_medium_layer": (c_int32, [c_void_p, c_int32, c_int32]),
    "opal_scene_set_world_medium": (c_int32, [c_void_p, c_int32]),
    "opal_scene_add_material": (c_int32, [c_void_p, POINTER(MaterialStruct)]),
    "opal_scene_update_material": (c_int32, [c_void_p, c_int32, POINTER(MaterialStruct)]),
    "opal_scene_evaluate": (c_int32, [c_void_p, POINTER(ProgramStruct), POINTER(PlacesStruct), FloatPointer]),
    "opal_scene_add_mesh": (c_int32, [c_void_p, POINTER(MeshStruct), IntPointer]),
    "opal_scene_add_instances": (c_int32, [c_void_p, POINTER(InstancesStruct)]),
    "opal_scene_set_transforms": (c_int32, [c_void_p, c_int32, c_int32, FloatPointer, FloatPointer, FloatPointer]),
    "opal_scene_add_light": (c_int32, [c_void_p, POINTER(LightStruct)]),
    "opal_scene_clear_lights": (c_int32, [c_void_p]),
    "opal_scene_set_world": (c_int32, [c_void_p, POINTER(WorldStruct)]),
    "opal_scene_set_camera": (c_int32, [c_void_p, POINTER(CameraStruct)]),
    "opal_scene_commit": (c_int32, [c_void_p]),
    "opal_scene_cancel": (None, [c_void_p]),
    "opal_scene_get_statistics": (c_int32, [c_void_p, POINTER(SceneStatisticsStruct)]),
    "opal_scene_intersect": (c_int32, [c_void_p, c_int64, FloatPointer, FloatPointer, FloatPointer, IntPointer, IntPointer, FloatPointer]),
    "opal_render_create": (c_void_p, [c_void_p, POINTER(RenderSettingsStruct)]),
    "opal_render_destroy": (None, [c_void_p]),
    "opal_render_pass": (c_int32, [c_void_p, c_int32]),
    "opal_render_cancel": (None, [c_void_p]),
    "opal_render_progress": (c_float, [c_void_p]),
    "opal_film_read": (c_int32, [c_void_p, c_int32, FloatPointer]),
    "opal_film_read_sums": (c_int32, [c_void_p, c_int32, POINTER(c_double)]),
    "opal_film_depth_pass": (c_int32, [c_void_p]),
    "opal_film_noise": (c_float, [c_void_p]),
    "opal_render_get_statistics": (c_int32, [c_void_p, POINTER(RenderStatisticsStruct)]),
}
