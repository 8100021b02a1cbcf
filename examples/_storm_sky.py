# SPDX-License-Identifier: GPL-3.0-or-later
"""A sky after a storm, of noise alone: slate clouds in front of the camera, which looks along +y, and light behind it.

The noise lies on a ceiling and not on the dome, so that clouds grow small towards the horizon as real ones do.
"""

from __future__ import annotations

import _scene
import bpy

CLOUDS = (
    (0.40, (0.009, 0.014, 0.027)),
    (0.48, (0.027, 0.037, 0.062)),
    (0.55, (0.075, 0.094, 0.132)),
    (0.61, (0.20, 0.22, 0.25)),
    (0.68, (0.38, 0.38, 0.385)),
)
"""Place on a noise and colour, from the undersides to the rims."""


class _Nodes:
    """A node tree, and the nodes that the sky is made of; each returns what comes out of it."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        self.nodes, self.links = tree.nodes, tree.links

    def math(self, operation: str, *inputs: bpy.types.NodeSocket | float) -> bpy.types.NodeSocket:
        node = self.nodes.new("ShaderNodeMath")
        node.operation = operation
        for socket, value in zip(node.inputs, inputs, strict=False):
            if isinstance(value, bpy.types.NodeSocket):
                self.links.new(value, socket)
            else:
                socket.default_value = value
        return node.outputs[0]

    def ramp(self, value: bpy.types.NodeSocket, *stops: tuple[float, tuple[float, float, float]]) -> bpy.types.NodeSocket:
        node = self.nodes.new("ShaderNodeValToRGB")
        while len(node.color_ramp.elements) < len(stops):
            node.color_ramp.elements.new(0.5)
        for stop, (place, colour) in zip(node.color_ramp.elements, stops, strict=True):
            stop.position, stop.color = place, (*colour, 1.0)
        self.links.new(value, node.inputs["Fac"])
        return node.outputs["Color"]

    def mix(self, factor: bpy.types.NodeSocket, one: bpy.types.NodeSocket, other: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        node = self.nodes.new("ShaderNodeMix")
        node.data_type = "RGBA"
        self.links.new(factor, node.inputs[0])
        for socket, value in zip([socket for socket in node.inputs if socket.type == "RGBA"], (one, other), strict=True):
            self.links.new(value, socket)
        return next(socket for socket in node.outputs if socket.type == "RGBA")

    def noise(self, place: bpy.types.NodeSocket, scale: float, detail: float, distortion: float) -> bpy.types.NodeSocket:
        node = self.nodes.new("ShaderNodeTexNoise")
        node.inputs["Scale"].default_value, node.inputs["Detail"].default_value = scale, detail
        node.inputs["Distortion"].default_value = distortion
        self.links.new(place, node.inputs["Vector"])
        return node.outputs[0]


def build(strength: float) -> bpy.types.World:
    """Make it the scene's world: a ceiling of clouds, a paler strip under them and, behind the camera, where it clears up, light."""
    world = _scene.plain_world((0.1, 0.1, 0.1), strength)
    nodes, links = world.node_tree.nodes, world.node_tree.links
    background = next(node for node in nodes if node.type == "BACKGROUND")
    make = _Nodes(world.node_tree)
    coordinates, parts, ceiling = (nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "SeparateXYZ", "CombineXYZ"))
    links.new(coordinates.outputs["Generated"], parts.inputs[0])
    x, y, z = parts.outputs
    up = make.math("MAXIMUM", z, 0.0)
    distance = make.math("ADD", up, 0.16)
    for axis, socket in zip((x, y), ceiling.inputs, strict=False):
        links.new(make.math("DIVIDE", axis, distance), socket)
    place = ceiling.outputs[0]
    fine, broad = make.noise(place, 2.3, 6.0, 0.3), make.noise(place, 0.7, 3.0, 0.0)
    clouds = make.ramp(make.math("MULTIPLY_ADD", fine, 0.4, make.math("MULTIPLY", broad, 0.6)), *CLOUDS)
    haze = make.math("MULTIPLY", make.math("POWER", make.math("SUBTRACT", 1.0, up), 9.0), 0.7)
    pale = make.ramp(up, (0.0, (0.16, 0.185, 0.215)), (1.0, (0.16, 0.185, 0.215)))
    clearing = make.ramp(up, (0.0, (1.35, 1.1, 0.85)), (0.5, (0.55, 0.72, 1.05)), (1.0, (0.25, 0.33, 0.47)))
    behind = make.math("MULTIPLY", make.math("MAXIMUM", make.math("MULTIPLY", y, -1.0), 0.0), 0.8)
    links.new(make.mix(behind, make.mix(haze, clouds, pale), clearing), background.inputs["Color"])
    return world
