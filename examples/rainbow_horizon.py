# SPDX-License-Identifier: GPL-3.0-or-later
"""Rain to the horizon: a double bow whose feet stand in the fields, from drops in all the air, thinning out with height.

Nothing is placed: the world itself holds the drops. Its density falls to 37 % in 400 m; what scatters only once is summed along each ray in
closed form, and the sun reaches each place through the rain above it.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _rain
import _scene


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _rain.fair_weather(math.radians(16.0), (0.0, 100.0, 22.0), 15.0)
    _rain.everywhere(scene.world, 0.0005, 400.0, theory="AIRY", radius=0.22, spread=0.03)
    return scene


if __name__ == "__main__":
    _scene.run(build, "rainbow_horizon")
