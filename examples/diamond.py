# SPDX-License-Identifier: GPL-3.0-or-later
"""A carat of diamond on a table: a round brilliant under a small lamp, in an evening room.

The stone lies as a loose brilliant does, on one of its pavilion mains, so that its table faces the camera. The lamp stands behind it and is
3 mm wide: every facet throws its own image of it on the table, split into colours by the diamond's dispersion.
"""

import math
import sys
from pathlib import Path

import bpy

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
    _scene.stage(0.5, _scene.surface("Table", (0.42, 0.40, 0.38), roughness=0.6, specular=0.1), depth=0.10, wall=0.15)
    _scene.lamp("Lamp", "SPOT", (-0.070, -0.010, 0.090), (0.0, 0.0, 0.002), 4.0, shadow_soft_size=0.0012, spot_size=math.radians(3.6), spot_blend=0.1)
    _scene.hdri(_scene.studio_light("interior"), 0.16, math.radians(-60.0))
    _scene.camera((0.006, -0.062, 0.034), (0.0012, -0.0012, 0.0018), 120.0, fstop=22.0, focus=(0.0, -0.002, 0.003))
    scene.render.resolution_x, scene.render.resolution_y = 960, 640
    if hasattr(scene, "opal"):
        scene.opal.passes, scene.opal.photons_per_pass = 128, 400_000
    return scene


if __name__ == "__main__":
    _scene.run(build, "diamond")
