# SPDX-License-Identifier: GPL-3.0-or-later
"""A diamond, a ruby, an emerald, a sapphire and an amethyst in the light of one small lamp.

Each stone lies on a facet of its own pavilion, as loose stones do. The lamp is 4 mm wide and stands low behind them, so that what passes
through each stone falls in front of it: its colour, and the diamond's spectra. The render ends after its time limit at the latest.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

# Species, cut, the facet it lies on, width (m), place (m), and the azimuth (degrees) towards which its table leans.
STONES = (
    ("DIAMOND", "BRILLIANT", "main", 0.0065, (0.0000, -0.0030), -80),
    ("RUBY", "HEART", "main", 0.0060, (-0.0092, 0.0010), -60),
    ("EMERALD", "EMERALD", "pavilion 2", 0.0056, (0.0098, 0.0016), -110),
    ("SAPPHIRE_BLUE", "CUSHION", "main", 0.0058, (-0.0044, 0.0105), -75),
    ("AMETHYST", "PEAR", "main", 0.0056, (0.0062, 0.0125), -95),
)
TIME_LIMIT = 140.0
"""Of the render, s."""


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    from opal_kernels.cuts import CUTS

    scene = _scene.empty()
    for species, cut_name, facet, width, place, facing in STONES:
        cut = CUTS[cut_name].build()
        stone = _scene.stone(f"{species.title()} {cut_name.title()}", cut, width, _scene.gem(species.title(), species))
        _scene.rest_on_facet(stone, cut.names.index(facet), place, math.radians(facing))
    _scene.stage(0.5, _scene.matte("Table", (0.33, 0.32, 0.31)), depth=0.08, wall=0.15)
    _scene.lamp("Lamp", "AREA", (-0.050, 0.100, 0.046), (0.0, 0.0, 0.0), 0.52, shape="DISK", size=0.004)
    _scene.hdri(_scene.studio_light("interior"), 0.12, math.radians(-60.0))
    _scene.camera((0.006, -0.080, 0.062), (0.0010, 0.0008, 0.0012), 104.0, fstop=22.0, focus=(0.0, -0.004, 0.002))
    scene.render.resolution_x, scene.render.resolution_y = 720, 480
    scene.view_settings.exposure = 0.25
    _scene.limit(scene, 256, 400_000, TIME_LIMIT)
    return scene


if __name__ == "__main__":
    _scene.run(build, "stones")
