# SPDX-License-Identifier: GPL-3.0-or-later
"""When a twin is made, updated or left alone.

The custom property ``opal_twin`` of a material or world holds the fingerprint of the tree as Opal left it. A tree with another
fingerprint was edited and belongs to the artist; Blender's own default tree, or none, belongs to nobody.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum
from typing import Any

import bpy

from .. import units
from .plan import Plan, fingerprint
from .trees import filling, gem

KEY = "opal_twin"
_FRAME = "Opal Twin"
_FRAME_LABEL = "Managed by Opal: edit, and it is yours"


class Result(Enum):
    """What became of a twin."""

    NONE = "has no twin: it is a surface"
    UPDATED = "follows Opal's settings"
    EDITED = "was edited and is left alone"
    LINKED = "is linked from a library and cannot be changed here"


# Fingerprints of the trees that new materials and worlds come with, by type of owner.
_default: dict[str, str] = {}


def plan_of(owner: Any, scene: Any = None) -> Plan | None:
    """The twin's plan of a material or world in a scene's units (without one, the context's); None for what has none."""
    metres = units.here() if scene is None else units.metres_per_unit(scene)
    kind = owner.opal.kind
    if kind == "GEM":
        return gem(owner.opal.gem, metres)
    if kind in {"MEDIUM", "RAINBOW"}:
        return filling(owner.opal, isinstance(owner, bpy.types.World), metres)
    return None


def is_managed(owner: Any) -> bool:
    """Whether the tree is a twin as Opal left it."""
    return owner.node_tree is not None and owner.get(KEY) == fingerprint(owner.node_tree)


def update(material: Any, overwrite: bool = False, scene: Any = None) -> Result:
    """Makes a material's twin follow its settings.

    Parameters
    ----------
    material : bpy.types.Material
    overwrite : bool
        Also where the tree was made or edited by hand.
    scene : bpy.types.Scene, optional
        Whose units the twin's coefficients are by; the context's without one.
    """
    plan = plan_of(material, scene)
    if plan is None:
        return Result.NONE
    if material.library is not None or material.override_library is not None:
        return Result.LINKED
    if not (overwrite or is_managed(material) or _is_nobodys(material)):
        return Result.EDITED
    tree = _tree(material)
    _apply(tree, plan, tree.nodes)
    material[KEY] = fingerprint(tree)
    return Result.UPDATED


def update_world(world: Any, overwrite: bool = False, scene: Any = None) -> Result:
    """The same of a world: its volume follows, its background stays the artist's."""
    if world.opal.kind == "NONE":
        return Result.NONE
    if world.library is not None or world.override_library is not None:
        return Result.LINKED
    tree = _tree(world)
    output = tree.get_output_node("ALL") or tree.nodes.new("ShaderNodeOutputWorld")
    volume = output.inputs["Volume"]
    own = {name: tree.nodes.get(_PREFIX + name) for name in ("Interior",)}
    if volume.is_linked and volume.links[0].from_node != own["Interior"] and not overwrite:
        return Result.EDITED
    plan = plan_of(world, scene)
    plan.nodes.pop("Output")
    plan.links = [link for link in plan.links if link[2] != "Output"]
    _drop_others(tree, plan, [node for node in tree.nodes if node.name.startswith(_PREFIX)], _PREFIX)
    nodes = plan.apply(tree, _PREFIX)
    interior = next(node for node in nodes if node.name == _PREFIX + "Interior")
    if not (volume.is_linked and volume.links[0].from_node == interior):
        tree.links.new(interior.outputs[0], volume)
    _frame(tree, nodes)
    world[KEY] = fingerprint(tree)
    return Result.UPDATED


_PREFIX = "Opal "


def follow(settings: Any, context: Any = None) -> None:
    """Update callback of every setting that a twin shows: settings of a material or world."""
    owner = settings.id_data
    if owner.is_evaluated or owner.library is not None:
        return
    scene = getattr(context, "scene", None)
    if isinstance(owner, bpy.types.World):
        update_world(owner, scene=scene)
    elif isinstance(owner, bpy.types.Material):
        update(owner, scene=scene)


def worlds_and_materials() -> Iterator[Any]:
    """Everything in the file that can have a twin."""
    yield from bpy.data.materials
    yield from bpy.data.worlds


def _tree(owner: Any) -> Any:
    if owner.node_tree is None:
        owner.use_nodes = True
    return owner.node_tree


def _is_nobodys(material: Any) -> bool:
    tree = material.node_tree
    if tree is None or not tree.nodes:
        return True
    if len(tree.nodes) != 2 or material.get(KEY) is not None:
        return False
    if "default" not in _default:
        other = bpy.data.materials.new("Opal default")
        try:
            _default["default"] = fingerprint(_tree(other))
        finally:
            bpy.data.materials.remove(other)
    return fingerprint(tree) == _default["default"]


def _apply(tree: Any, plan: Plan, candidates: Any) -> None:
    _drop_others(tree, plan, list(candidates))
    _frame(tree, plan.apply(tree))


def _drop_others(tree: Any, plan: Plan, nodes: list[Any], prefix: str = "") -> None:
    """Removes nodes that the plan has not, and links that it has not."""
    for node in nodes:
        row = plan.nodes.get(node.name[len(prefix) :])
        if (row is None or row.kind != node.bl_idname) and node.name != _FRAME:
            tree.nodes.remove(node)
    wanted = {(prefix + target, socket) for _, _, target, socket in plan.links}
    for link in list(tree.links):
        node, socket = link.to_node, link.to_socket
        if not node.name.startswith(prefix) or node.name[len(prefix) :] not in plan.nodes:
            continue
        index = next(i for i, s in enumerate(node.inputs) if s == socket)
        if (node.name, socket.name) not in wanted and (node.name, index) not in wanted:
            tree.links.remove(link)


def _frame(tree: Any, nodes: list[Any]) -> None:
    """A frame round the twin that says whose it is."""
    frame = tree.nodes.get(_FRAME)
    if frame is None:
        frame = tree.nodes.new("NodeFrame")
        frame.name = _FRAME
    frame.label = _FRAME_LABEL
    for node in nodes:
        if node.parent != frame:
            node.parent = frame
