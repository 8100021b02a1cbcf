# SPDX-License-Identifier: GPL-3.0-or-later
"""A glass ball and a steel ball in a box: the two caustics that the first photon maps were shown with.

Jensen's box (*Global Illumination using Photon Maps*, 1996): red and blue side walls, a lamp in the ceiling, light gathered by the glass on
floor and wall and thrown about by the mirror.
"""

import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    white = _scene.matte("White", (0.75, 0.75, 0.75))
    red, blue = _scene.matte("Red", (0.65, 0.06, 0.05)), _scene.matte("Blue", (0.08, 0.10, 0.55))
    w, d, h = 0.5, 0.5, 0.8
    for name, corners, material in (
        ("Floor", [(-w, -d, 0), (w, -d, 0), (w, d, 0), (-w, d, 0)], white),
        ("Ceiling", [(-w, -d, h), (-w, d, h), (w, d, h), (w, -d, h)], white),
        ("Back", [(-w, d, 0), (w, d, 0), (w, d, h), (-w, d, h)], white),
        ("Left", [(-w, -d, 0), (-w, d, 0), (-w, d, h), (-w, -d, h)], red),
        ("Right", [(w, -d, 0), (w, -d, h), (w, d, h), (w, d, 0)], blue),
    ):
        _scene.mesh(name, corners, [(0, 1, 2, 3)], material)
    _scene.sphere("Glass ball", (0.22, -0.12, 0.17), 0.1698, _scene.glass("Glass", 1.5, 0.0042))
    _scene.sphere("Steel ball", (-0.22, 0.16, 0.17), 0.1698, _scene.surface("Steel", (0.92, 0.92, 0.92), roughness=0.0, metallic=1.0))
    _scene.lamp("Lamp", "AREA", (0.0, 0.0, h - 0.001), (0.0, 0.0, 0.0), 9.0, shape="SQUARE", size=0.16)
    _scene.plain_world((0.0, 0.0, 0.0), 0.0)
    _scene.camera((0.0, -1.75, 0.42), (0.0, 0.0, 0.385), 46.0)
    scene.render.resolution_x, scene.render.resolution_y = 720, 560
    _scene.limit(scene, 128, 400_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "two_spheres")
