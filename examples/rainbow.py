# SPDX-License-Identifier: GPL-3.0-or-later
"""A double rainbow over hills: a curtain of drops of 0.4 mm under a low sun, by Airy's theory.

The sun stands 20° high behind the camera, so the bow's top is 22° above the horizon. Between the two bows lies Alexander's dark band, and
inside the first one the sky is brighter: all three come out of one phase function.
"""

import math
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

SUN_HEIGHT = math.radians(20.0)


def hills(material: bpy.types.Material) -> bpy.types.Object:
    """Ground of 3 km, with hills at its far end."""
    n = 160
    x, y = np.meshgrid(np.linspace(-1500.0, 1500.0, n), np.linspace(-300.0, 2700.0, n))
    far = np.clip((y - 150.0) / 900.0, 0.0, 1.0)
    z = far * (45.0 * np.sin(x / 310.0 + 1.0) * np.cos(y / 430.0) + 28.0 * np.sin(x / 140.0 + y / 260.0) + 30.0) - 1.0
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3).tolist()
    faces = [(i, i + 1, i + n + 1, i + n) for r in range(n - 1) for i in range(r * n, r * n + n - 1)]
    return _scene.mesh("Hills", vertices, faces, material, smooth=True)


def rain(material: bpy.types.Material) -> bpy.types.Object:
    """A curtain of drops, 120 m deep, 150 m away."""
    x, z, near, far = 900.0, 420.0, 150.0, 270.0
    vertices = [(i, j, k) for k in (-30.0, z) for j in (near, far) for i in (-x, x)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return _scene.mesh("Rain", vertices, faces, material)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    hills(_scene.matte("Grass", (0.045, 0.070, 0.020)))
    drops = bpy.data.materials.new("Rain")
    drops.opal.kind = "RAINBOW"
    drops.opal.rainbow.radius, drops.opal.rainbow.extinction = 0.4, 0.0018
    rain(drops)
    toward = (0.0, math.cos(SUN_HEIGHT), -math.sin(SUN_HEIGHT))
    _scene.lamp("Sun", "SUN", [-t for t in toward], (0.0, 0.0, 0.0), 4.0, angle=math.radians(0.53))
    _scene.plain_world((0.20, 0.27, 0.38), 0.30)
    _scene.camera((0.0, 0.0, 4.0), (0.0, 100.0, 20.0), 19.0)
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    scene.opal.photons_per_pass = 0
    _scene.limit(scene, 128, 0, 100.0)
    return scene


if __name__ == "__main__":
    _scene.run(build, "rainbow")
