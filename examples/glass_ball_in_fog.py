# SPDX-License-Identifier: GPL-3.0-or-later
"""A spotlight through a ball of glass in fog: the volumetric caustic that path tracers do not find.

The ball is a lens of index 1.5, so light meets at 1.5 radii from its centre (PHYSICS §5.8) and parts again beyond: in fog the
whole cone can be seen, with the brightest place where it is narrowest, and its foot on the table is a caustic too.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

RADIUS = 0.32
"""Of the ball, m."""
CENTRE = (-0.10, 0.0, 1.12)
LAMP = (-1.25, 0.0, 2.55)
SPOT_ANGLE = math.radians(14.0)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    scene.unit_settings.length_unit = "METERS"
    _scene.stage(8.0, _scene.matte("Table", (0.34, 0.27, 0.20)))
    _scene.box("Fog", (-3.8, -2.0, 0.002), (3.8, 3.0, 3.2), _scene.medium("Fog", 0.055, (0.97, 0.98, 1.0), 0.2))
    _scene.sphere("Ball", CENTRE, RADIUS, _scene.glass("Glass", 1.5))
    lamp = _scene.lamp("Spot", "SPOT", LAMP, CENTRE, 16000.0, spot_size=SPOT_ANGLE * 1.35, spot_blend=0.15, shadow_soft_size=0.012)
    lamp.data.color = (1.0, 0.90, 0.74)
    _scene.plain_world((0.10, 0.25, 0.80), 0.02)
    _scene.camera((0.6, -5.0, 1.30), (0.22, 0.0, 0.86), 43.0)
    scene.render.resolution_x, scene.render.resolution_y = 640, 360
    # Photons bring what scatters twice as well: camera paths would meet the narrow focus by chance alone, in specks. Surfaces take many
    # photons cheaply, and the fog few, each of which is a beam; the two are counted apart and not weighed against each other.
    _scene.limit(
        scene,
        44,
        300_000,
        samples_per_pass=2,
        use_adaptive_sampling=False,
        photons_carry="INDIRECT",
        volume_photons_per_pass=6_000,
    )
    return scene


if __name__ == "__main__":
    _scene.run(build, "glass_ball_in_fog")
