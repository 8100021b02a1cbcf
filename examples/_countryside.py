# SPDX-License-Identifier: GPL-3.0-or-later
"""Country to put weather over: hills with fields, oaks and hedges of real leaves, tall grass before the camera, and a farmhouse.

The camera stands near the origin and looks along +y. Nothing is smaller than a pixel needs: leaves of a hand's breadth stand for a twig's.
"""

from __future__ import annotations

import math

import _scene
import bpy
import numpy as np


def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Height of the ground, m."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    far = np.clip((y - 150.0) / 900.0, 0.0, 1.0)
    hills = 45.0 * np.sin(x / 310.0 + 1.0) * np.cos(y / 430.0) + 28.0 * np.sin(x / 140.0 + y / 260.0) + 30.0
    near = 0.7 * np.sin(x / 17.0 + 0.4) * np.sin(y / 23.0) + 0.35 * np.sin(x / 7.0 - y / 11.0)
    return far * hills + (1 - far) * near - 1.0


def fields(material: bpy.types.Material) -> bpy.types.Object:
    """Ground of 4 km, fine before the camera and coarse far away."""
    n = 220
    t = np.linspace(-1.0, 1.0, n)
    x, y = np.meshgrid(2200.0 * (0.12 * t + 0.88 * t**3), -60.0 + 2800.0 * np.linspace(0.0, 1.0, n) ** 2.2)
    vertices = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3).tolist()
    faces = [(i, i + 1, i + n + 1, i + n) for r in range(n - 1) for i in range(r * n, r * n + n - 1)]
    return _scene.mesh("Fields", vertices, faces, material, smooth=True)


def _cards(places: np.ndarray, normals: np.ndarray, sizes: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Corners (n, 4, 3) of square leaves across their normals, each turned about it at random."""
    across = np.cross(normals, random.normal(size=normals.shape))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    along = np.cross(normals, across)
    corners = [(-1, -0.7), (1, -0.7), (1, 0.7), (-1, 0.7)]
    return np.stack([places + 0.5 * sizes[:, None] * (a * across + b * along) for a, b in corners], axis=1)


def crown(seed: int, spread: float, leaves: int) -> tuple[np.ndarray, list]:
    """Vertices and faces of the leaves of a tree one high whose crown is `spread` wide: boughs are balls of leaves, thickest outside."""
    random = np.random.default_rng(seed)
    boughs = 22
    turn = random.uniform(0, 2 * np.pi, boughs) + 2.4 * np.arange(boughs)
    level = np.linspace(0.30, 0.86, boughs)
    reach = 0.5 * spread * np.sqrt(np.clip(1 - ((level - 0.50) / 0.42) ** 2, 0.02, 1)) * random.uniform(0.45, 0.75, boughs)
    centres = np.stack([reach * np.cos(turn), reach * np.sin(turn), level], axis=1)
    radii = spread * random.uniform(0.13, 0.22, boughs)
    bough = random.integers(0, boughs, leaves)
    out = random.normal(size=(leaves, 3))
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    flat = np.array([1.0, 1.0, 0.72])
    places = centres[bough] + flat * out * (radii[bough] * random.uniform(0.55, 1.0, leaves) ** 0.4)[:, None]
    normals = out + 0.75 * random.normal(size=(leaves, 3)) + [0, 0, 0.35]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    corners = _cards(places, normals, spread * random.uniform(0.009, 0.021, leaves), random)
    return corners.reshape(-1, 3), np.arange(4 * leaves).reshape(-1, 4).tolist()


def trunk(spread: float) -> tuple[np.ndarray, list]:
    """Vertices and faces of a trunk that widens at its foot and forks into the crown."""
    sides = 8
    turn = 2 * np.pi * np.arange(sides) / sides
    rings = [(-0.05, 0.045, 0.0), (0.03, 0.028, 0.0), (0.25, 0.020, 0.01), (0.45, 0.014, 0.02), (0.75, 0.004, 0.03)]
    vertices = [(lean + r * math.cos(a), r * math.sin(a), z) for z, r, lean in rings for a in turn]
    faces = [
        (r * sides + s, r * sides + (s + 1) % sides, (r + 1) * sides + (s + 1) % sides, (r + 1) * sides + s)
        for r in range(len(rings) - 1)
        for s in range(sides)
    ]
    for a in 2.1 * np.arange(6) + 0.3:  # boughs
        first, last = (
            np.array([0.0, 0.0, 0.22]),
            np.array([0.3 * spread * math.cos(a), 0.3 * spread * math.sin(a), 0.48 + (0.04 * a) % 0.2]),
        )
        across = np.array([-math.sin(a), math.cos(a), 0.0]) * 0.009
        up = np.array([0.0, 0.0, 0.009])
        start = len(vertices)
        vertices += [tuple(p) for p in (first - across, first + across, last, first - up, first + up, last)]
        faces += [(start, start + 1, start + 2), (start + 3, start + 4, start + 5)]
    return np.array(vertices), faces


def trees(leaves: bpy.types.Material, bark: bpy.types.Material) -> list[bpy.types.Object]:
    """Oaks in the meadow, a hedge across it and woods on the hills, all of a few kinds that share their meshes."""
    random = np.random.default_rng(5)
    kinds = []
    for seed, (spread, count) in enumerate(((1.05, 20000), (0.9, 18000), (1.2, 22000), (0.75, 16000))):
        foliage, cards = crown(seed, spread, count)
        wood, sides = trunk(spread)
        data = bpy.data.meshes.new(f"Oak {seed + 1}")
        data.from_pydata(np.concatenate([foliage, wood]).tolist(), [], cards + [tuple(len(foliage) + i for i in face) for face in sides])
        data.materials.append(leaves)
        data.materials.append(bark)
        data.polygons.foreach_set("material_index", [0] * len(cards) + [1] * len(sides))
        kinds.append(data)
    # Place and height: single oaks, the hedge, copses, and woods far away.
    stands = [(-34.0, 66.0, 15.0), (44.0, 88.0, 13.0), (58.0, 97.0, 10.0), (-74.0, 102.0, 11.0), (9.0, 128.0, 9.0)]
    for x in np.arange(-230.0, 235.0, 5.0):
        stands.append((x + random.uniform(-2, 2), 138 + 0.1 * x + random.uniform(-2, 2), random.uniform(2.2, 6.5)))
    for _ in range(46):
        stands.append((random.uniform(-320, 320), random.uniform(160, 320), random.uniform(5.0, 11.0)))
    for x, y in ((-330, 430), (-120, 520), (160, 470), (420, 560), (60, 760), (-420, 800), (640, 900)):
        for _ in range(46):
            stands.append((x + random.normal(0, 60), y + random.normal(0, 26), random.uniform(8.0, 15.0)))
    objects = []
    for number, (x, y, size) in enumerate(stands):
        obj = bpy.data.objects.new(f"Tree {number + 1}", kinds[(number + 2) % len(kinds)])
        obj.location = (x, y, float(height(x, y)) - 0.02 * size)
        obj.rotation_euler.z = random.uniform(0, 2 * np.pi)
        obj.scale = (size * random.uniform(0.9, 1.15), size * random.uniform(0.9, 1.15), size)
        bpy.context.scene.collection.objects.link(obj)
        objects.append(obj)
    return objects


def grass(material: bpy.types.Material, blades: int = 120_000) -> bpy.types.Object:
    """Blades of tall grass from 8 to 110 m before the camera, evenly over the picture, in tufts."""
    random = np.random.default_rng(11)
    y = 1.0 / random.uniform(1 / 110.0, 1 / 8.0, blades)
    x = 1.35 * y * random.uniform(-1, 1, blades)
    x, y = x + 0.25 * np.sin(3.1 * y + 2.0 * x), y + 0.25 * np.sin(2.7 * x)  # tufts
    tall = (0.16 + 0.30 * random.uniform(0, 1, blades) ** 2) * (0.75 + 0.35 * np.sin(x / 3.1) * np.sin(y / 4.3))
    wide = 0.006 + 0.0011 * y * random.uniform(0.6, 1.2, blades)
    turn, lean = random.uniform(0, 2 * np.pi, blades), random.normal(0.25, 0.3, blades) * tall
    foot = np.stack([x, y, height(x, y) - 0.03], axis=1)
    across = np.stack([np.cos(turn), np.sin(turn), np.zeros(blades)], axis=1) * wide[:, None]
    tip = foot + np.stack([lean, 0.4 * lean * np.cos(turn), tall], axis=1)
    vertices = np.stack([foot - across, foot + across, tip], axis=1).reshape(-1, 3)
    return _scene.mesh("Grass", vertices.tolist(), np.arange(3 * blades).reshape(-1, 3).tolist(), material)


def farmhouse(walls: bpy.types.Material, roof: bpy.types.Material, x: float, y: float, turn: float) -> list[bpy.types.Object]:
    """Two whitewashed buildings with gables, 12 m and 8 m long."""
    made = []
    for (dx, dy), length, width, tall, ridge, angle in (((0, 0), 12.0, 6.5, 3.6, 3.2, turn), ((11, 5), 8.0, 5.5, 2.8, 2.6, turn + 1.3)):
        a, b = length / 2, width / 2
        foot, e = -1.5, 0.35
        corners = [(s * a, t * b, z) for z in (foot, tall) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        corners += [(-a, 0, tall + ridge), (a, 0, tall + ridge)]
        sides = [(0, 1, 5, 4), (1, 2, 6, 9, 5), (2, 3, 7, 6), (3, 0, 4, 8, 7)]
        fall = e * ridge / b
        eaves = [(s * (a + e), t * (b + e), tall - fall) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        eaves += [(-a - e, 0, tall + ridge + 0.05), (a + e, 0, tall + ridge + 0.05)]
        parts = (("Walls", corners, sides, walls), ("Roof", eaves, [(0, 1, 5, 4), (2, 3, 4, 5)], roof))
        for name, vertices, faces, material in parts:
            obj = _scene.mesh(name, vertices, faces, material)
            obj.location = (x + dx, y + dy, float(height(x + dx, y + dy)))
            obj.rotation_euler.z = angle
            made.append(obj)
    return made


# Materials ---------------------------------------------------------------------------------------------------------------------------


def _ramp(nodes: bpy.types.Nodes, stops: tuple) -> bpy.types.Node:
    ramp = nodes.new("ShaderNodeValToRGB")
    while len(ramp.color_ramp.elements) < len(stops):
        ramp.color_ramp.elements.new(0.5)
    for stop, (place, colour) in zip(ramp.color_ramp.elements, stops, strict=True):
        stop.position, stop.color = place, (*colour, 1.0)
    return ramp


def mottled(name: str, scale: float, stops: tuple, detail: float = 6.0) -> bpy.types.Material:
    """A matte surface whose colour follows a noise of so many cells a metre."""
    material = _scene.matte(name, (0.1, 0.1, 0.1))
    nodes, links = material.node_tree.nodes, material.node_tree.links
    coordinates, noise, ramp = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeTexNoise"), _ramp(nodes, stops)
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = scale, detail
    links.new(coordinates.outputs["Object"], noise.inputs["Vector"])
    links.new(noise.outputs[0], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], next(node for node in nodes if node.type == "BSDF_DIFFUSE").inputs["Color"])
    return material


def foliage(name: str, stops: tuple) -> bpy.types.Material:
    """Leaves, each tree of its own tint."""
    material = _scene.matte(name, (0.1, 0.1, 0.1))
    nodes, links = material.node_tree.nodes, material.node_tree.links
    info, ramp = nodes.new("ShaderNodeObjectInfo"), _ramp(nodes, stops)
    links.new(info.outputs["Random"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], next(node for node in nodes if node.type == "BSDF_DIFFUSE").inputs["Color"])
    return material


def build() -> None:
    """All of it, in the current scene."""
    fields(mottled("Meadow", 0.05, ((0.34, (0.070, 0.105, 0.022)), (0.5, (0.16, 0.15, 0.042)), (0.66, (0.26, 0.20, 0.062))), 9.0))
    grass(mottled("Grass", 0.35, ((0.36, (0.085, 0.125, 0.026)), (0.52, (0.19, 0.19, 0.05)), (0.68, (0.36, 0.27, 0.10)))))
    tints = ((0.0, (0.038, 0.078, 0.016)), (0.6, (0.066, 0.105, 0.020)), (0.85, (0.12, 0.115, 0.022)), (1.0, (0.22, 0.115, 0.022)))
    leaves = foliage("Leaves", tints)
    trees(leaves, _scene.matte("Bark", (0.07, 0.052, 0.038)))
    farmhouse(_scene.matte("Whitewash", (0.72, 0.69, 0.62)), _scene.matte("Slates", (0.16, 0.075, 0.055)), 31.0, 118.0, 0.35)
