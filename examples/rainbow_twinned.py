# SPDX-License-Identifier: GPL-3.0-or-later
"""A twinned bow: small round and larger flattened drops in one shower make two bows that part at the top and join at the feet.

By the traced wavefront (Sadeghi et al. 2012) of drops in the shape that falling gives them; the table takes about ten seconds when it is first computed.
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
    return _rain.landscape(math.radians(18.0), (0.0, 100.0, 30.0), 26.0, preset="TWINNED")


if __name__ == "__main__":
    _scene.run(build, "rainbow_twinned")
