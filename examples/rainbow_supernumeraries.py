# SPDX-License-Identifier: GPL-3.0-or-later
"""Supernumerary arcs: drops of a quarter of a millimetre, nearly all alike, by Airy's theory.

Waves, not rays, make the pastel arcs inside the primary: the smaller the drops the wider they stand apart.
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
    return _rain.landscape(math.radians(20.0), (0.0, 100.0, 34.0), 32.0, theory="AIRY", radius=0.12, spread=0.03)


if __name__ == "__main__":
    _scene.run(build, "rainbow_supernumeraries")
