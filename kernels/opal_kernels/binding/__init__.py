# SPDX-License-Identifier: GPL-3.0-or-later
"""The C interface of ``include/opal.h`` by ctypes: one Python function for one C function, and nothing else.

A failure is an `OpalError` with the kernels' sentence. Foreign calls release the interpreter lock.
"""

from .arrays import as_array, program_struct
from .functions import SIGNATURES
from .library import API_VERSION, Cancelled, OpalError, cpu_level, last_error, library
from .render import (
    film_noise,
    film_read,
    render_cancel,
    render_create,
    render_destroy,
    render_get_statistics,
    render_pass,
    render_progress,
)
from .scene import (
    scene_add_grid,
    scene_add_image,
    scene_add_instances,
    scene_add_light,
    scene_add_material,
    scene_add_medium,
    scene_add_mesh,
    scene_add_phase,
    scene_add_spectrum,
    scene_clear_lights,
    scene_commit,
    scene_create,
    scene_destroy,
    scene_get_statistics,
    scene_intersect,
    scene_set_camera,
    scene_set_grid_block,
    scene_set_transforms,
    scene_set_world,
    scene_set_world_medium,
    scene_update_material,
)
from .structures import STRUCTURES

__all__ = [
    "API_VERSION",
    "Cancelled",
    "OpalError",
    "SIGNATURES",
    "STRUCTURES",
    "as_array",
    "cpu_level",
    "film_noise",
    "film_read",
    "last_error",
    "library",
    "program_struct",
    "render_cancel",
    "render_create",
    "render_destroy",
    "render_get_statistics",
    "render_pass",
    "render_progress",
    "scene_add_image",
    "scene_add_instances",
    "scene_add_light",
    "scene_add_material",
    "scene_add_grid",
    "scene_add_medium",
    "scene_add_mesh",
    "scene_add_phase",
    "scene_add_spectrum",
    "scene_clear_lights",
    "scene_commit",
    "scene_create",
    "scene_destroy",
    "scene_get_statistics",
    "scene_intersect",
    "scene_set_camera",
    "scene_set_transforms",
    "scene_set_world",
    "scene_set_grid_block",
    "scene_set_world_medium",
    "scene_update_material",
]
