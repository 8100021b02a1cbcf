# SPDX-License-Identifier: GPL-3.0-or-later
"""Newton's experiment on a sheet of paper: a beam through a prism of dense flint, and its spectrum.

A low sun shines through a slit in a card. The sheet of light that passes sinks slowly towards the paper, so it draws its whole way on
it: white up to the prism, and fanned out by colour after it. The prism (SF11, 60°) stands on its end at minimum deviation for yellow,
where the index n gives sin i = n sin 30° and the light turns by 2i − 60° (PHYSICS §5.6: 64.7° for red, 74.6° for violet).
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

SIDE = 0.030
"""Length of the prism's sides, m."""
HEIGHT = 0.032
INDEX = 1.7845
"""Of SF11 at the D line (PHYSICS §2.1), which sets the angle of incidence."""
SUN_HEIGHT = math.radians(6.0)
SLIT_WIDTH, SLIT_HEIGHT, SLIT_DISTANCE = 0.0035, 0.034, 0.090


def prism_at_minimum_deviation(material: bpy.types.Material) -> bpy.types.Object:
    """The prism, turned so that light along +x meets its first face, at the origin, at minimum deviation for the D line."""
    incidence = math.asin(INDEX * math.sin(math.radians(30.0)))
    # The first face's outward normal points back along the beam, turned by the angle of incidence; the apex lies to its left (+y).
    facing = math.pi - incidence
    normal = (math.cos(facing), math.sin(facing))
    along = (normal[1], -normal[0])
    apex = (0.5 * SIDE * along[0], 0.5 * SIDE * along[1])
    foot = (-apex[0], -apex[1])
    back = (-SIDE * math.sqrt(0.75) * normal[0], -SIDE * math.sqrt(0.75) * normal[1])
    corners = [foot, back, apex]
    vertices = [(x, y, z) for z in (1e-5, HEIGHT) for x, y in corners]
    return _scene.mesh("Prism", vertices, [(2, 1, 0), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)], material)


def card_with_slit(material: bpy.types.Material) -> bpy.types.Object:
    """A wall across the beam with a slit on the paper: it keeps the sun off everything else."""
    w, h, x, wide, high = 0.5 * SLIT_WIDTH, SLIT_HEIGHT, -SLIT_DISTANCE, 3.0, 0.8
    vertices = [
        (x, y, z) for y, z in ((-wide, 0), (-w, 0), (-w, h), (-wide, h), (w, 0), (wide, 0), (wide, h), (w, h), (-wide, high), (wide, high))
    ]
    return _scene.mesh("Card", vertices, [(0, 1, 2, 3), (4, 5, 6, 7), (3, 2, 7, 6, 9, 8)], material)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    _scene.stage(3.0, _scene.matte("Paper", (0.8, 0.8, 0.8)))
    card_with_slit(_scene.matte("Card", (0.02, 0.02, 0.02)))
    prism_at_minimum_deviation(_scene.gem("Flint glass", "SF11"))
    toward = (math.cos(SUN_HEIGHT), 0.0, -math.sin(SUN_HEIGHT))
    _scene.lamp("Sun", "SUN", [-t for t in toward], (0.0, 0.0, 0.0), 90.0, angle=math.radians(0.2))
    _scene.plain_world((0.5, 0.6, 1.0), 0.02)
    _scene.lamp("Window", "AREA", (0.10, 0.35, 0.30), (0.0, 0.0, 0.0), 0.20, shape="RECTANGLE", size=0.30, size_y=0.12)
    _scene.camera((0.050, -0.24, 0.27), (0.022, -0.034, 0.0), 58.0, fstop=5.6, focus=(0.0, -0.005, 0.01))
    scene.render.resolution_x, scene.render.resolution_y = 960, 640
    _scene.limit(scene, 256, 400_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "prism")
