# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own panels that make sense with Opal: they join through `COMPAT_ENGINES` and leave again."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

_ENGINE = "OPAL"
_EXTENSION = __package__.rpartition(".")[0]

# Panels for every engine that Opal replaces or cannot honour.
_LEFT_OUT = {
    "DATA_PT_light",
    "DATA_PT_preview",
    "NODE_DATA_PT_light",
    "RENDER_PT_gpencil",
    "RENDER_PT_simplify",
    "RENDER_PT_simplify_greasepencil",
    "RENDER_PT_simplify_render",
    "RENDER_PT_simplify_viewport",
    "RENDER_PT_stereoscopy",
}

# Panels of other engines that say what Opal reads.
_BORROWED = {
    "DATA_PT_EEVEE_light",
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_WORLD_PT_surface",
    "MATERIAL_PT_preview",
    "NODE_DATA_PT_EEVEE_light",
    "VIEWLAYER_PT_override",
}


def _panels(base: Any = bpy.types.Panel) -> Iterator[Any]:
    """Every registered panel that says which engines it is for."""
    for panel in base.__subclasses__():
        if "COMPAT_ENGINES" in panel.__dict__:
            yield panel
        yield from _panels(panel)


def _fits(panel: Any) -> bool:
    name = panel.__name__
    general = "BLENDER_RENDER" in panel.COMPAT_ENGINES and name not in _LEFT_OUT and "freestyle" not in name
    return general or name in _BORROWED


def register() -> None:
    for panel in _panels():
        if _fits(panel):
            panel.COMPAT_ENGINES.add(_ENGINE)


def unregister() -> None:
    for panel in _panels():
        if not panel.__module__.startswith(_EXTENSION):  # Opal's own keep it
            panel.COMPAT_ENGINES.discard(_ENGINE)
