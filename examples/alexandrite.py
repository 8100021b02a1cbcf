# SPDX-License-Identifier: GPL-3.0-or-later
"""The alexandrite effect: one stone, green by day and red by candle light.

Its chromium absorbs yellow and lets blue-green and red through. Daylight (D65, left) has more blue-green, a filament of 2800 K (right)
has far more red, and the eye takes the stone's colour from what is left. An eye adapts itself to either light; the picture has one white
balance for both, between the two. Panels before the stones, beside the lamps over them, keep facets from showing a dark room.
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

    candle = {"spectrum": "BLACKBODY", "temperature": 2800.0}
    scene = _booth.booth(
        round_brilliant(), "ALEXANDRITE", left={"spectrum": "D65"}, right=candle, width=0.0065, grey=0.5, fill=0.015, lens=180.0
    )
    view = scene.view_settings
    view.look, view.exposure = "AgX - Punchy", 1.1
    view.use_white_balance, view.white_balance_temperature = True, 4800.0
    return scene


if __name__ == "__main__":
    _scene.run(build, "alexandrite")
