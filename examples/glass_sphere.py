# SPDX-License-Identifier: GPL-3.0-or-later
"""One ball of glass by a window: the reflections inside it, one behind the other.

The room stands on its head in the light that goes through twice; over it lie the window's reflection on the front, upright, and its reflection
on the back, seen from inside and upside down; each further one is weaker by R, 4 % at n = 1.5.
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
    _scene.stage(2.0, _scene.checker("Table", (0.65, 0.62, 0.58), (0.12, 0.12, 0.13), 25.0))
    _scene.sphere("Ball", (0.0, 0.0, 0.04 + 1e-5), 0.04, _scene.glass("Glass", 1.5, 0.0042))
    _scene.lamp("Window", "AREA", (-0.30, 0.05, 0.35), (0.0, 0.0, 0.04), 6.0, shape="RECTANGLE", size=0.12, size_y=0.18)
    _scene.hdri(_scene.studio_light("courtyard"), 0.5, math.radians(20.0))
    _scene.camera((0.05, -0.30, 0.13), (0.004, 0.0, 0.035), 75.0, fstop=8.0, focus=(0.0, -0.035, 0.04))
    scene.render.resolution_x, scene.render.resolution_y = 840, 600
    _scene.limit(scene, 128, 300_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "glass_sphere")
