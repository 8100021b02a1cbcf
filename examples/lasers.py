# SPDX-License-Identifier: GPL-3.0-or-later
"""A beam of three lasers through a prism: it looks white before, and parts into three lines where the sun's would be a spectrum.

The prism of `prism.py`, of dense flint at minimum deviation for yellow. Light of 638, 532 and 450 nm comes along +x and sinks to the
paper, so that it draws its way on it.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene
import prism

LASERS = ((638.0, 0.0030), (532.0, 0.0090), (450.0, 0.0005))
"""Wavelength (nm) and power (W, as bright as white light of it) of each."""
FALL = math.radians(5.0)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    _scene.stage(3.0, _scene.matte("Paper", (0.8, 0.8, 0.8)))
    prism.prism_at_minimum_deviation(_scene.gem("Flint glass", "SF11"))
    far = 0.12
    fall = far * math.tan(FALL)
    for nm, power in LASERS:
        lamp = _scene.lamp(f"Laser {nm:.0f}", "AREA", (-far, 0.0, fall + 0.010), (0.0, 0.0, 0.010), power, shape="RECTANGLE")
        lamp.data.size, lamp.data.size_y, lamp.data.spread = 0.0010, 0.020, 0.0
        if hasattr(lamp.data, "opal"):
            lamp.data.opal.spectrum, lamp.data.opal.laser_wavelength = "LASER", nm
    _scene.plain_world((0.5, 0.6, 1.0), 0.02)
    _scene.camera((0.050, -0.24, 0.27), (0.022, -0.034, 0.0), 58.0, fstop=5.6, focus=(0.0, -0.005, 0.01))
    scene.render.resolution_x, scene.render.resolution_y = 960, 640
    _scene.limit(scene, 128, 400_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "lasers")
