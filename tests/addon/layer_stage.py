# SPDX-License-Identifier: GPL-3.0-or-later
"""A small scene with everything that layers tell apart: ordinary things, a gem that throws a caustic, fog before some of them."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import stage


def principled(name: str, color: Any) -> bpy.types.Material:
    """Blender's default surface in a colour."""
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
    return material


def body(name: str, kind: str) -> bpy.types.Material:
    """A material of one of Opal's kinds, as a person makes it."""
    material = bpy.data.materials.new(name)
    material.opal.kind = kind
    return material


def cube(name: str, material: Any, low: Any, high: Any) -> bpy.types.Object:
    """A box between two corners."""
    corners = [[(low, high)[i >> a & 1][a] for a in range(3)] for i in range(8)]
    faces = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return stage.mesh(name, corners, faces, material=material)


def build(passes: int = 16, width: int = 64, height: int = 48) -> bpy.types.Scene:
    """The scene; its gem is glass, so that its light has no colour noise."""
    scene = stage.scene(width, height, passes, samples=8)
    scene.opal.photons_per_pass = 20_000
    scene.cycles.samples, scene.cycles.device, scene.cycles.seed = 128, "CPU", 3
    stage.plane("Floor", size=12, material=principled("Floor", (0.7, 0.5, 0.3)))
    cube("Cube", principled("Cube", (0.2, 0.5, 0.8)), (-1.9, 0.1, 0), (-0.9, 1.1, 1))
    glass = body("Glass", "GEM")
    glass.opal.gem.species = "CUSTOM"
    glass.opal.gem.dispersion, glass.opal.gem.cauchy_b, glass.opal.gem.cauchy_c = "CAUCHY", 1.5, 0.0
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.7, location=(0.2, -0.2, 0.75))
    bpy.context.object.name = "Ball"
    bpy.context.object.data.materials.append(glass)
    fog = body("Fog", "MEDIUM")
    fog.opal.medium.extinction, fog.opal.medium.albedo = 0.25, (0.8, 0.8, 0.8)
    cube("Fog", fog, (0.45, -1, -0.03), (1.95, 2, 1.97))
    lamp = bpy.data.lights.new("Lamp", "AREA")
    lamp.energy, lamp.size = 300, 0.5
    stage.link("Lamp", lamp, (2, -2.5, 4)).rotation_euler = (0.6, 0.35, 0.5)
    stage.world(strength=0.3)
    stage.camera((0, -6, 2.6), (1.23, 0, 0))
    return scene


def pixels(name: str) -> np.ndarray:
    """An image of the file, (height, width, 4), rows from the bottom up."""
    image = bpy.data.images[name]
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], 4).astype(np.float64)


def blocks(picture: np.ndarray, n: int = 4) -> np.ndarray:
    """Means over n x n blocks of the whole picture, for claims that noise must not blur."""
    height, width = picture.shape[0] // n * n, picture.shape[1] // n * n
    return picture[:height, :width].reshape(n, height // n, n, width // n, -1).mean((1, 3))
