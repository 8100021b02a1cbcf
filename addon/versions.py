# SPDX-License-Identifier: GPL-3.0-or-later
"""Files saved by other versions of Opal: what was renamed or moved is brought to its new place when a file is opened.

A file carries the number of its layout in the custom property ``opal_layout`` of its scenes, written when it is saved; 0 is a file from before there was one. A
change that old files must not feel adds a function to `_STEPS`; steps run in order, each once a file.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
from bpy.app.handlers import persistent

KEY = "opal_layout"


def _twins_of_files_without(_scenes: list[Any]) -> None:
    """Layout 1: materials have twins. Those whose tree is Blender's default get theirs."""
    from . import twins

    for owner in twins.worlds_and_materials():
        twins.follow(owner.opal)


def _species_of_31_bits(_scenes: list[Any]) -> None:
    """Layout 2: species are numbers that a keyframe can hold."""
    from . import presets

    presets.renumber_species([material.opal.gem for material in bpy.data.materials])


# What brings a file from layout n to n + 1, n being the position.
_STEPS: list[Callable[[list[Any]], None]] = [_twins_of_files_without, _species_of_31_bits]


def current() -> int:
    """The layout that this version writes."""
    return len(_STEPS)


def migrate() -> str:
    """Brings the open file to the current layout; returns what to tell the artist, empty where there is nothing."""
    scenes = [scene for scene in bpy.data.scenes if scene.library is None]
    if not scenes or not _used(scenes):
        return ""
    found = min(scene.get(KEY, 0) for scene in scenes)
    if found > current():
        return "This file was saved by a newer version of Opal: settings that this version does not know are ignored, and kept."
    for step in _STEPS[found:]:
        step(scenes)
    for scene in scenes:
        scene[KEY] = current()
    return ""


def _used(scenes: list[Any]) -> bool:
    """Whether the file has anything of Opal's in it: a file of other engines is none of Opal's business, and stays without its mark."""
    return (
        any(scene.render.engine == "OPAL" for scene in scenes)
        or any(material.opal.kind != "SURFACE" for material in bpy.data.materials)
        or any(world.opal.kind != "NONE" for world in bpy.data.worlds)
        or any(light.opal.spectrum != "COLOR" for light in bpy.data.lights)
        or any(camera.opal.polarizer for camera in bpy.data.cameras)
    )


@persistent
def _on_load(_path: str = "", _other: Any = None) -> None:
    if sentence := migrate():
        from . import report

        report.start(bpy.context.scene).add("", sentence)


@persistent
def _on_save(_path: str = "", _other: Any = None) -> None:
    scenes = [scene for scene in bpy.data.scenes if scene.library is None]
    if not _used(scenes):
        return
    for scene in scenes:
        if scene.get(KEY, 0) < current():
            scene[KEY] = current()


def register() -> None:
    bpy.app.handlers.load_post.append(_on_load)
    bpy.app.handlers.save_pre.append(_on_save)


def unregister() -> None:
    bpy.app.handlers.save_pre.remove(_on_save)
    bpy.app.handlers.load_post.remove(_on_load)
