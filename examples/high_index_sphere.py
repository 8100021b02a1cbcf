# SPDX-License-Identifier: GPL-3.0-or-later
"""Spheres of rising index before a window: what a ball shows of the world behind it.

A ball's focus lies n/(2(n − 1)) radii from its centre (PHYSICS §5.8): outside for n below 2, on its back at 2, inside above. From left to
right n = 1.1, 1.5, 2.0, 4.0: the picture of the window turns over, shrinks, and sinks into the ball, which grows ever more like a mirror:
a boundary of n = 4 reflects 36 % head on.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

INDICES = (1.1, 1.5, 2.0, 4.0)
RADIUS = 0.02


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    _scene.stage(2.0, _scene.matte("Table", (0.30, 0.29, 0.28)))
    for i, index in enumerate(INDICES):
        place = (0.052 * (i - 1.5), 0.0, RADIUS + 1e-5)
        _scene.sphere(f"n = {index}", place, RADIUS, _scene.glass(f"n = {index}", index))
    panes = ((0.9, 0.35, 0.2), (0.95, 0.8, 0.3), (0.3, 0.7, 0.9), (0.25, 0.35, 0.85))
    for i, colour in enumerate(panes):
        x, z = 0.17 * (i % 2) - 0.165, 0.17 * (1 - i // 2) + 0.02
        pane = _scene.surface(f"Pane {i}", (0.0, 0.0, 0.0))
        shader = next(node for node in pane.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
        shader.inputs["Emission Color"].default_value = (*colour, 1.0)
        shader.inputs["Emission Strength"].default_value = 3.0
        _scene.mesh(f"Pane {i}", [(x, 0.5, z), (x + 0.16, 0.5, z), (x + 0.16, 0.5, z + 0.16), (x, 0.5, z + 0.16)], [(0, 1, 2, 3)], pane)
    _scene.hdri(_scene.studio_light("courtyard"), 0.12, math.radians(40.0))
    _scene.camera((0.0, -0.30, 0.075), (0.0, 0.0, 0.021), 49.0, fstop=8.0)
    scene.render.resolution_x, scene.render.resolution_y = 960, 480
    _scene.limit(scene, 128, 300_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "high_index_sphere")
