# SPDX-License-Identifier: GPL-3.0-or-later
"""What kind of thing an edit has touched, by what Blender's dependency graph says of its last evaluation.

Blender tags generously: a colour tags the objects that wear the material, a new relation tags every object. So a tag only says
where to look; whether anything has become different is found by reading it again and comparing (`viewport_sync`). What
is expensive to read, shapes and pictures, is taken as changed when it is tagged.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from .identity import key_of

# Objects whose own geometry is rendered, as a mesh or as voxels.
_SHAPES = {"MESH", "CURVE", "SURFACE", "META", "FONT", "CURVES", "POINTCLOUD", "VOLUME", "GREASEPENCIL"}
# Data-blocks that are seen through others, which are tagged as well where it matters.
_INDIRECT = {"ACTION", "ARMATURE", "KEY", "LATTICE", "LIGHT_PROBE", "SPEAKER", "BRUSH", "LINESTYLE", "SCREEN", "WORKSPACE", "WINDOWMANAGER"}


@dataclass
class Changes:
    """Where to look.

    Attributes
    ----------
    everything : bool
        A shape, a picture or something unknown: the scene has to be built anew.
    objects : bool
        Which objects and lamps are seen, where they stand, what they look like apart from their materials.
    moved : bool
        Something stands elsewhere, a camera included, so that coordinates in node trees may be others.
    world : bool
        Which world is shown.
    all_materials : bool
        Some materials, it is not said which: Blender tells a 3D view of an edited material so.
    materials, worlds, trees : set
        Keys (`identity.key_of`) of materials, worlds and shader node trees.
    """

    everything: bool = False
    objects: bool = False
    moved: bool = False
    world: bool = False
    all_materials: bool = False
    materials: set[Any] = field(default_factory=set)
    worlds: set[Any] = field(default_factory=set)
    trees: set[Any] = field(default_factory=set)


def changes_of(depsgraph: Any) -> Changes:
    """What the last evaluation of a depsgraph has touched; all but shapes where it does not say."""
    found = Changes()
    updates = list(depsgraph.updates)
    if not updates:
        found.objects = found.world = found.moved = found.all_materials = True
    for update in updates:
        _note(update, update.id, found)
    return found


def _note(update: Any, block: Any, found: Changes) -> None:
    kind = block.id_type
    if kind == "OBJECT":
        found.moved |= update.is_updated_transform
        found.everything |= update.is_updated_geometry and block.type in _SHAPES
        if block.type == "CAMERA":
            found.moved |= update.is_updated_geometry
        else:
            found.objects = True
    elif kind == "CAMERA":
        found.moved = True
    elif kind == "MESH":
        found.everything |= update.is_updated_geometry or update.is_updated_transform
    elif kind == "MATERIAL":
        found.materials.add(key_of(block))
    elif kind == "NODETREE":
        if block.bl_idname == "ShaderNodeTree":
            found.trees.add(key_of(block))
    elif kind == "WORLD":
        found.worlds.add(key_of(block))
    elif kind in {"LIGHT", "COLLECTION"}:
        found.objects = True
    elif kind == "SCENE":
        found.objects = found.world = True
    elif kind not in _INDIRECT:
        found.everything = True
