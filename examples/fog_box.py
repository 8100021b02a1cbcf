# SPDX-License-Identifier: GPL-3.0-or-later
"""The Cornell box full of fog under a directed light, as three pictures of one render: the things alone, the medium alone, and both.

The fog box of the report of 2013, extinction 0.5 and a light that goes straight down. Its pictures come from the render's passes: what the
fog scatters first is in the pass Medium, everything else in Combined less Medium. The walls' red and green bleed into the fog.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

SIDE = 2.0
"""Of the box, m."""
EXTINCTION = 0.5


def room() -> None:
    """White, red and green walls, open to the camera."""
    white, red, green = (
        _scene.matte(name, colour)
        for name, colour in (("White", (0.75, 0.75, 0.75)), ("Red", (0.63, 0.06, 0.05)), ("Green", (0.12, 0.48, 0.10)))
    )
    w = 0.5 * SIDE
    for name, corners, material in (
        ("Floor", [(-w, -w, 0), (w, -w, 0), (w, w, 0), (-w, w, 0)], white),
        ("Ceiling", [(-w, -w, SIDE), (-w, w, SIDE), (w, w, SIDE), (w, -w, SIDE)], white),
        ("Back", [(-w, w, 0), (w, w, 0), (w, w, SIDE), (-w, w, SIDE)], white),
        ("Left", [(-w, -w, 0), (-w, w, 0), (-w, w, SIDE), (-w, -w, SIDE)], red),
        ("Right", [(w, -w, 0), (w, -w, SIDE), (w, w, SIDE), (w, w, 0)], green),
    ):
        _scene.mesh(name, corners, [(0, 1, 2, 3)], material)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    scene.unit_settings.length_unit = "METERS"
    room()
    inside = 0.5 * SIDE - 1e-3
    fog = _scene.medium("Fog", EXTINCTION, (0.95, 0.95, 0.95))
    _scene.box("Fog", (-inside, -inside, 1e-3), (inside, inside, SIDE - 1e-3), fog)
    _scene.sphere("Glass ball", (0.42, -0.28, 0.36), 0.35, _scene.glass("Glass", 1.5))
    block = _scene.box("Block", (-0.30, -0.30, 0.0), (0.30, 0.30, 1.15), _scene.matte("Block", (0.75, 0.75, 0.75)))
    block.location, block.rotation_euler = (-0.38, 0.36, 2e-3), (0.0, 0.0, math.radians(20.0))
    _scene.lamp(
        "Directed light", "SPOT", (0.0, 0.0, SIDE - 0.02), (0.0, 0.0, 0.0), 220.0, spot_size=math.radians(70), spot_blend=0.1, shadow_soft_size=0.05
    )
    _scene.plain_world((0.0, 0.0, 0.0), 0.0)
    _scene.camera((0.0, -5.2, 1.0), (0.0, 0.0, 1.0), 60.0)
    scene.render.resolution_x, scene.render.resolution_y = 640, 360
    _scene.limit(scene, 32, 10_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "fog_box")
