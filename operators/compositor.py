# SPDX-License-Identifier: GPL-3.0-or-later
"""Compositor nodes that lay Opal's layers over the base, each with an exposure of its own.

The nodes are a group named “Opal Composite”, which waits in the Add menu and in the compositor's list of trees. It shows pictures of one
frame, so that it is the scene's compositor only if the artist asks for that: every render would be that still. A compositor that the
artist made is never changed.

Blender 5 replaced the scene's node tree by a node group and the compositor's Mix, Math and Composite nodes by those of shaders and
by a group output.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import bpy

from . import layer_names, own_images

NAME = "Opal Composite"
_IS_GROUP = bpy.app.version >= (5, 0, 0)
# What Blender 4.5 puts into a new compositor.
_DEFAULT = {"CompositorNodeRLayers", "CompositorNodeComposite", "CompositorNodeViewer", "NodeReroute"}


def build(images: Mapping[str, Any], owner: str) -> Any:
    """Builds an owner's group (see `own_images`) from images by identifier (``BASE`` and layers); exposures that he set stay.

    Returns
    -------
    bpy.types.NodeTree
    """
    tree = _own(owner)
    if tree is None:
        tree = bpy.data.node_groups.new(own_images.name_for(NAME, owner, bpy.data.node_groups), "CompositorNodeTree")
        tree.use_fake_user = True  # it is kept with the file, used or not
    tree[own_images.NAME_KEY], tree[own_images.OWNER_KEY] = NAME, owner
    kept = {node.name: node.inputs["Exposure"].default_value for node in tree.nodes if node.bl_idname == "CompositorNodeExposure"}
    tree.nodes.clear()
    tree.interface.clear()
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    _fill(tree, images, kept)
    return tree


def _own(owner: str) -> Any:
    made = [t for t in bpy.data.node_groups if t.library is None and t.get(own_images.NAME_KEY) == NAME]
    return next((t for t in made if t[own_images.OWNER_KEY] == owner), next((t for t in made if own_images.belongs(t, owner)), None))


def _fill(tree: Any, images: Mapping[str, Any], exposures: Mapping[str, float]) -> None:
    made = _Nodes(tree)
    color = made.picture("Base", images["BASE"], 0)
    alpha = made.alpha(color)
    row = 1
    if "TRANSMITTANCE" in images:
        through = made.picture(layer_names.LABELS["TRANSMITTANCE"], images["TRANSMITTANCE"], row)
        color = made.mix("MULTIPLY", color, through, "Attenuation")
        alpha = made.math("MULTIPLY", alpha, made.alpha(through))
        row += 1
    for identifier in layer_names.ADDED:
        if identifier not in images:
            continue
        label = layer_names.LABELS[identifier]
        picture = made.picture(label, images[identifier], row)
        color = made.mix("ADD", color, made.exposed(label, picture, exposures.get(f"{label} Exposure", 0.0), row), f"Add {label}")
        alpha = made.math("ADD", alpha, made.alpha(picture))
        row += 1
    made.finish(color, made.math("MINIMUM", alpha, None, 1.0))


class _Nodes:
    """Adds nodes from left to right, in the words of the running version of Blender."""

    def __init__(self, tree: Any) -> None:
        self.tree = tree
        self._column = 0

    def _new(self, kind: str, name: str, x: int, y: int) -> Any:
        node = self.tree.nodes.new(kind)
        node.name = node.label = name
        node.location = (x, y)
        return node

    def _step(self) -> int:
        self._column += 1
        return 500 + 200 * self._column

    def picture(self, name: str, image: Any, row: int) -> Any:
        node = self._new("CompositorNodeImage", name, 0, -320 * row)
        node.image = image
        return node.outputs["Image"]

    def exposed(self, label: str, picture: Any, stops: float, row: int) -> Any:
        node = self._new("CompositorNodeExposure", f"{label} Exposure", 250, -320 * row)
        node.inputs["Exposure"].default_value = stops
        self.tree.links.new(picture, node.inputs["Image"])
        return node.outputs["Image"]

    def mix(self, blend: str, a: Any, b: Any, name: str) -> Any:
        if _IS_GROUP:
            node = self._new("ShaderNodeMix", name, self._step(), 0)
            node.data_type, node.blend_type = "RGBA", blend
            node.clamp_result = False
            sockets = [s for s in node.inputs if s.enabled]
            factor, first, second = (next(s for s in sockets if s.name == n) for n in ("Factor", "A", "B"))
            out = next(s for s in node.outputs if s.enabled)
        else:
            node = self._new("CompositorNodeMixRGB", name, self._step(), 0)
            node.blend_type = blend
            factor, first, second = node.inputs[0], node.inputs[1], node.inputs[2]
            out = node.outputs[0]
        factor.default_value = 1.0
        self.tree.links.new(a, first)
        self.tree.links.new(b, second)
        return out

    def math(self, operation: str, a: Any, b: Any, value: float = 0.0) -> Any:
        node = self._new("ShaderNodeMath" if _IS_GROUP else "CompositorNodeMath", operation.title(), self._step(), -400)
        node.operation = operation
        self.tree.links.new(a, node.inputs[0])
        if b is None:
            node.inputs[1].default_value = value
        else:
            self.tree.links.new(b, node.inputs[1])
        return node.outputs[0]

    def alpha(self, picture: Any) -> Any:
        node = self._new("CompositorNodeSeparateColor", "Alpha", self._step(), -700)
        self.tree.links.new(picture, node.inputs[0])
        return node.outputs["Alpha"]

    def finish(self, color: Any, alpha: Any) -> None:
        parts = self._new("CompositorNodeSeparateColor", "Light", self._step(), 0)
        whole = self._new("CompositorNodeCombineColor", "With Alpha", self._step(), 0)
        self.tree.links.new(color, parts.inputs[0])
        for channel in ("Red", "Green", "Blue"):
            self.tree.links.new(parts.outputs[channel], whole.inputs[channel])
        self.tree.links.new(alpha, whole.inputs["Alpha"])
        output = self._new("NodeGroupOutput", "Output", self._step(), 0)
        self.tree.links.new(whole.outputs[0], output.inputs[0])


def show(scene: Any, tree: Any) -> bool:
    """Makes the group the scene's compositor where that takes nothing away; returns whether it is."""
    if _IS_GROUP:
        if scene.compositing_node_group is None:
            scene.compositing_node_group = tree
        return scene.compositing_node_group == tree
    scene.use_nodes = True
    nodes, links = scene.node_tree.nodes, scene.node_tree.links
    group = next((n for n in nodes if n.bl_idname == "CompositorNodeGroup" and n.node_tree == tree), None)
    output = next((n for n in nodes if n.bl_idname == "CompositorNodeComposite"), None)
    untouched = {n.bl_idname for n in nodes if n != group} <= _DEFAULT
    if group is None:
        group = nodes.new("CompositorNodeGroup")
        group.node_tree = tree
        group.name = group.label = tree.name
        group.location = (0, 300)
    if untouched:
        if output is None:
            output = nodes.new("CompositorNodeComposite")
            output.location = (400, 300)
        links.new(group.outputs[0], output.inputs[0])
    return output is not None and output.inputs[0].is_linked and output.inputs[0].links[0].from_node == group
