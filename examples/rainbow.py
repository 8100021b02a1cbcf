# SPDX-License-Identifier: GPL-3.0-or-later
"""A full double rainbow with supernumerary arcs over fields: a curtain of even drops 0.28 mm across under a low sun, by Airy's theory.

The sun stands 16° high behind the camera, so the bow's top is 26° above the horizon. Between the two bows lies Alexander's dark band, and
inside the first one the sky is brighter: all three come out of one phase function.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _rain
import _scene

SUN_HEIGHT = math.radians(16.0)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    return _rain.landscape(SUN_HEIGHT, (0.0, 100.0, 22.0), 15.0, theory="AIRY", radius=0.14, spread=0.015)


if __name__ == "__main__":
    _scene.run(build, "rainbow")
