# SPDX-License-Identifier: GPL-3.0-or-later
"""A pane of glass that runs away from the camera: a window where it is near, a mirror where it is far.

Fresnel's equations say how much a boundary reflects: for n = 1.5, 4 % of the light that meets it head on and 61 % at 85° (PHYSICS §2.4). The
blue wall stands behind the pane, the orange balls before it.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    _scene.stage(30.0, _scene.matte("Floor", (0.25, 0.24, 0.23)))
    _scene.box("Pane", (0.0, -2.35, 0.0001), (0.02, 9.0, 1.3), _scene.glass("Glass", 1.5))
    _scene.box("Wall", (1.2, -6.0, 0.0), (1.3, 14.0, 1.6), _scene.checker("Wall", (0.04, 0.10, 0.45), (0.35, 0.50, 0.85), 2.0))
    orange = _scene.surface("Orange", (0.85, 0.25, 0.03), roughness=0.4)
    for i in range(7):
        _scene.sphere(f"Ball {i}", (-0.55, 0.0 + 1.1 * i, 0.3), 0.3, orange)
    _scene.plain_world((0.8, 0.9, 1.0), 0.7)
    _scene.lamp("Sun", "SUN", (-3.0, -2.0, 4.0), (0.0, 0.0, 0.0), 1.2, angle=math.radians(1.0))
    _scene.camera((-0.75, -2.6, 0.75), (0.10, 0.2, 0.50), 24.0)
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    _scene.limit(scene, 128, 500_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "fresnel_wall")
