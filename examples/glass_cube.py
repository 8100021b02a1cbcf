# SPDX-License-Identifier: GPL-3.0-or-later
"""A cube of glass before a pink ball: the part of the ball that is seen through the cube stands beside itself.

A plate with parallel faces moves what is behind it by d·sin(i − r)/cos r without turning it. Light that enters one face of a cube of
n > √2 cannot leave by the face beside it, where it is totally reflected: those faces are mirrors from inside.
"""

import math
import sys
from pathlib import Path

import bpy
from mathutils import Matrix

sys.path.append(str(Path(__file__).resolve().parent))
import _scene


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    _scene.stage(1.0, _scene.checker("Table", (0.75, 0.75, 0.75), (0.45, 0.45, 0.45), 40.0), depth=0.5, wall=0.5)
    cube = _scene.box("Cube", (-0.03, -0.03, 0.0), (0.03, 0.03, 0.06), _scene.gem("Glass", "BK7"))
    cube.matrix_world = Matrix.Translation((0.0, 0.0, 1e-5)) @ Matrix.Rotation(math.radians(32.0), 4, "Z")
    _scene.sphere("Pink ball", (0.022, 0.11, 0.04), 0.04, _scene.surface("Pink", (0.85, 0.18, 0.35), roughness=0.35))
    _scene.lamp("Lamp", "AREA", (-0.25, -0.05, 0.35), (0.0, 0.03, 0.0), 4.0, shape="DISK", size=0.03)
    _scene.hdri(_scene.studio_light("interior"), 0.35, math.radians(40.0))
    _scene.camera((0.03, -0.34, 0.15), (0.006, 0.03, 0.032), 70.0, fstop=11.0, focus=(0.0, 0.0, 0.03))
    scene.render.resolution_x, scene.render.resolution_y = 840, 600
    _scene.limit(scene, 128, 300_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "glass_cube")
