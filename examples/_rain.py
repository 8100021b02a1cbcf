# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scenes with rain share: fields with trees under a dark sky, a low sun behind the camera, and a curtain of drops."""

from __future__ import annotations

import math

import _scene
import bpy
import numpy as np


def fields(material: bpy.types.Material) -> bpy.types.Object:
    """Ground of 3 km, with hills at its far end."""
    n = 160
    x, y = np.meshgrid(np.linspace(-1500.0, 1500.0, n), np.linspace(-300.0, 2700.0, n))
    vertices = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3).tolist()
    faces = [(i, i + 1, i + n + 1, i + n) for r in range(n - 1) for i in range(r * n, r * n + n - 1)]
    return _scene.mesh("Fields", vertices, faces, material, smooth=True)


def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Height of the ground, m."""
    far = np.clip((np.asarray(y) - 150.0) / 900.0, 0.0, 1.0)
    return far * (45.0 * np.sin(x / 310.0 + 1.0) * np.cos(y / 430.0) + 28.0 * np.sin(x / 140.0 + y / 260.0) + 30.0) - 1.0


def trees(material: bpy.types.Material, count: int = 140) -> bpy.types.Object:
    """Round crowns scattered over the near fields and along a hedge, as one mesh."""
    random = np.random.default_rng(5)
    rings, sides = 10, 16
    polar = np.pi * np.arange(rings + 1) / rings
    turn = 2 * np.pi * np.arange(sides) / sides
    unit = np.stack(
        [np.outer(np.sin(polar), np.cos(turn)), np.outer(np.sin(polar), np.sin(turn)), np.outer(np.cos(polar), np.ones(sides))], -1
    ).reshape(-1, 3)
    quads = [(r * sides + s, (r + 1) * sides + s, (r + 1) * sides + (s + 1) % sides, r * sides + (s + 1) % sides)
             for r in range(rings) for s in range(sides)]  # fmt: skip
    vertices: list = []
    faces: list = []
    for number in range(count):
        hedge = number % 3 > 0
        x = random.uniform(-260, 260)
        y = 120 + 0.12 * x + random.uniform(-4, 4) if hedge else random.uniform(70, 145)
        size = random.uniform(1.6, 3.2) if hedge else random.uniform(2.0, 4.5)
        waves = random.uniform(0, 2 * np.pi, 3)
        lumps = np.sin(5 * unit[:, 0] + waves[0]) + np.sin(4 * unit[:, 1] + waves[1]) + np.sin(6 * unit[:, 2] + waves[2])
        lumps = 1 + 0.09 * lumps[:, None]
        place = np.array([x, y, float(height(x, y)) + 0.75 * size])
        faces += [tuple(len(vertices) + i for i in quad) for quad in quads]
        vertices += (unit * lumps * [size, size, 1.1 * size] + place).tolist()
    return _scene.mesh("Trees", vertices, faces, material, smooth=True)


def meadow() -> bpy.types.Material:
    """Grass with drier patches of some metres."""
    material = _scene.matte("Meadow", (0.20, 0.19, 0.055))
    nodes, links = material.node_tree.nodes, material.node_tree.links
    coordinates, noise, ramp = (nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "TexNoise", "ValToRGB"))
    shader = next(node for node in nodes if node.type == "BSDF_DIFFUSE")
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 0.09, 5.0
    for element, place, colour in zip(
        ramp.color_ramp.elements, (0.35, 0.65), ((0.11, 0.13, 0.035, 1.0), (0.27, 0.23, 0.075, 1.0)), strict=True
    ):
        element.position, element.color = place, colour
    links.new(coordinates.outputs["Object"], noise.inputs["Vector"])
    links.new(noise.outputs[0], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], shader.inputs["Color"])
    return material


def sky(low: tuple[float, float, float], high: tuple[float, float, float], strength: float) -> bpy.types.World:
    """A sky that goes from one colour at the horizon to another overhead; black under the ground."""
    world = _scene.plain_world(low, strength)
    nodes, links = world.node_tree.nodes, world.node_tree.links
    coordinates, parts, ramp = (nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "SeparateXYZ", "ValToRGB"))
    background = next(node for node in nodes if node.type == "BACKGROUND")
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (*low, 1.0), (*high, 1.0)
    ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[1].position = 0.0, 0.55
    links.new(coordinates.outputs["Generated"], parts.inputs[0])
    links.new(parts.outputs["Z"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], background.inputs["Color"])
    return world


def sun(height_rad: float, energy: float = 4.0, angle: float = math.radians(0.533)) -> bpy.types.Object:
    """A low sun behind the camera, a little reddened."""
    toward = (0.0, -math.cos(height_rad), math.sin(height_rad))
    return _scene.lamp("Sun", "SUN", toward, (0.0, 0.0, 0.0), energy, angle=angle, color=(1.0, 0.88, 0.72))


def curtain(extinction: float, near: float = 150.0, far: float = 270.0, **drops: object) -> bpy.types.Material:
    """A wall of drops between two distances; settings go to `material.opal.rainbow`."""
    material = bpy.data.materials.new("Rain")
    if hasattr(material, "opal"):
        material.opal.kind = "RAINBOW"
        for name, value in drops.items():
            setattr(material.opal.rainbow, name, value)
        material.opal.rainbow.extinction = extinction
    _scene.box("Rain", (-900.0, near, -30.0), (900.0, far, 420.0), material)
    return material


def everywhere(world: bpy.types.World, extinction: float, scale_height: float, **drops: object) -> None:
    """Drops in all the air, thinning out with height; settings go to `world.opal.rainbow`."""
    if hasattr(world, "opal"):
        world.opal.kind, world.opal.scale_height = "RAINBOW", scale_height
        for name, value in drops.items():
            setattr(world.opal.rainbow, name, value)
        world.opal.rainbow.extinction = extinction


def landscape(sun_height: float, target: tuple[float, float, float], lens: float, **drops: object) -> bpy.types.Scene:
    """Fields, trees, a storm's sky, the sun behind and a curtain of these drops; the camera stands at eye height on a bank."""
    scene = fair_weather(sun_height, target, lens)
    curtain(0.0034, **drops)
    return scene


def fair_weather(sun_height: float, target: tuple[float, float, float], lens: float) -> bpy.types.Scene:
    """The same without rain."""
    scene = _scene.empty()
    fields(meadow())
    trees(_scene.matte("Leaves", (0.060, 0.090, 0.020)))
    sun(sun_height)
    sky((0.075, 0.092, 0.125), (0.028, 0.036, 0.058), 0.8)
    _scene.camera((0.0, 0.0, 5.0), target, lens)
    scene.camera.data.clip_end = 1e5
    scene.view_settings.exposure = 0.7
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    _scene.limit(scene, 6, 0, 50.0)
    return scene
