# SPDX-License-Identifier: GPL-3.0-or-later
"""The secondary bow as the report of 2013 drew it: from the angle to the sun the index, from the index the wavelength.

Descartes' rays alone: every wavelength is a line at its own angle, red inside. The frame holds the secondary bow's top and, below, the primary.
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
    return _rain.landscape(math.radians(20.0), (0.0, 100.0, 55.0), 35.0, theory="DESCARTES", radius=0.5)


if __name__ == "__main__":
    _scene.run(build, "rainbow_secondary")
