# SPDX-License-Identifier: GPL-3.0-or-later
"""A carat of diamond on a table: a round brilliant under a small lamp, in a dark studio.

The stone lies as a loose brilliant does, on one of its pavilion mains, so that its table faces the camera. A lamp of 0.6 mm radius shines on
nothing but the stone, through its crown; the pavilion turns the light round, and every facet it leaves by throws its own image of the lamp on
the table, split into colours by the diamond's dispersion.
"""

import math
import sys
from pathlib import Path

import bpy
from mathutils import Vector

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

WIDTH = 0.0065
"""Girdle diameter of one carat, m."""


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    from opal_kernels.cuts import round_brilliant

    scene = _scene.empty()
    cut = round_brilliant()
    diamond = _scene.stone("Diamond", cut, WIDTH, _scene.gem("Diamond", "DIAMOND"))
    _scene.rest_on_facet(diamond, cut.names.index("main"), (0.0, 0.0), facing=math.radians(-75.0))
    _scene.stage(0.5, _scene.surface("Table", (0.13, 0.14, 0.16), roughness=0.6, specular=0.1), depth=0.10, wall=0.15)
    _scene.lamp(
        "Lamp",
        "SPOT",
        (-0.056, -0.034, 0.094),
        diamond.matrix_world @ Vector((0.0, 0.0, 0.0006)),
        22.0,
        shadow_soft_size=0.0006,
        spot_size=math.radians(1.5),
        spot_blend=0.15,
    )
    _scene.hdri(_scene.studio_light("studio"), 1.1, math.radians(150.0))
    _scene.camera((0.006, -0.062, 0.038), (-0.0008, -0.0022, 0.0010), 98.0, fstop=32.0, focus=(0.0, -0.002, 0.003))
    scene.render.resolution_x, scene.render.resolution_y = 960, 640
    scene.view_settings.exposure = 0.8
    _scene.limit(scene, 256, 400_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "diamond")
