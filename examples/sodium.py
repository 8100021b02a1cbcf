# SPDX-License-Identifier: GPL-3.0-or-later
"""A sodium lamp kills fire: one diamond under daylight (left) and under the yellow doublet at 589 nm (right).

Both lamps are as bright. The stone under daylight throws spectra; under sodium the same facets flash, and every flash is yellow.
"""

import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _booth
import _scene


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    from opal_kernels.cuts import round_brilliant

    return _booth.booth(round_brilliant(), "DIAMOND", left={"spectrum": "D65"}, right={"spectrum": "SODIUM"})


if __name__ == "__main__":
    _scene.run(build, "sodium")
