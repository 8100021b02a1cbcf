# SPDX-License-Identifier: GPL-3.0-or-later
"""A bow by sampled wavelengths: each spreads from its angle as rays do, bright at the edge and fading inwards."""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _rain
import _scene


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    return _rain.landscape(math.radians(20.0), (0.0, 100.0, 34.0), 28.0, theory="DESCARTES_SAMPLED", radius=0.5)


if __name__ == "__main__":
    _scene.run(build, "rainbow_sampled")
