# SPDX-License-Identifier: GPL-3.0-or-later
"""A thin beam of white light through a prism in mist: the spectrum hangs in the air.

A sheet of light from a slit of 4 mm meets a prism of dense flint (SF11, 60°) at minimum deviation, where yellow turns by 66.3°, red by
64.7° and violet by 74.6° (PHYSICS §5.6). What the mist scatters of it is seen from above, so that a ray of the camera crosses few colours.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

SIDE, HEIGHT = 0.26, 0.34
"""Of the prism's triangle and its length, m."""
INDEX = 1.7845
"""Of SF11 at the D line, which sets the angle of incidence."""
BEAM_HEIGHT = 0.17
SLIT_DISTANCE, SLIT_WIDTH, SLIT_HEIGHT = 0.62, 0.004, 0.04
"""Where the sheet of light leaves the lamp's housing, and how wide and high it is there: the narrower, the purer the colours."""


def prism(material: bpy.types.Material) -> bpy.types.Object:
    """A prism on its end, turned so that light along +x meets the middle of its first face, at the origin, at minimum deviation."""
    facing = math.pi - math.asin(INDEX * math.sin(math.radians(30.0)))
    normal = (math.cos(facing), math.sin(facing))
    along = (normal[1], -normal[0])
    apex = (0.5 * SIDE * along[0], 0.5 * SIDE * along[1])
    back = (-SIDE * math.sqrt(0.75) * normal[0], -SIDE * math.sqrt(0.75) * normal[1])
    corners = [(-apex[0], -apex[1]), back, apex]
    vertices = [(x, y, z) for z in (0.002, HEIGHT) for x, y in corners]
    return _scene.mesh("Prism", vertices, [(2, 1, 0), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)], material)


def slit_lamp(material: bpy.types.Material, window: bpy.types.Material) -> None:
    """A housing that shines a sheet of light at the prism through a window of glass, so that photons bring the sheet as they do the fan."""
    _scene.box("Housing", (-SLIT_DISTANCE - 0.20, -0.022, 0.002), (-SLIT_DISTANCE, 0.022, 0.25), material)
    low, high = BEAM_HEIGHT - 0.6 * SLIT_HEIGHT, BEAM_HEIGHT + 0.6 * SLIT_HEIGHT
    _scene.box("Window", (-SLIT_DISTANCE + 0.002, -0.02, low), (-SLIT_DISTANCE + 0.005, 0.02, high), window)
    place, target = (-SLIT_DISTANCE + 0.001, 0.0, BEAM_HEIGHT), (0.0, 0.0, BEAM_HEIGHT)
    lamp = _scene.lamp("Slit", "AREA", place, target, 75.0, shape="RECTANGLE", size=SLIT_WIDTH, size_y=SLIT_HEIGHT)
    lamp.data.spread = math.radians(0.5)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    scene.unit_settings.length_unit = "CENTIMETERS"
    _scene.stage(3.0, _scene.matte("Table", (0.055, 0.055, 0.06)))
    _scene.box("Mist", (-2.2, -2.2, 0.001), (2.2, 1.6, 0.9), _scene.medium("Mist", 0.06, (1.0, 1.0, 1.0), 0.35))
    prism(_scene.gem("Flint glass", "SF11"))
    slit_lamp(_scene.matte("Housing", (0.03, 0.03, 0.03)), _scene.gem("Crown glass", "BK7"))
    _scene.plain_world((0.30, 0.48, 1.0), 0.4)
    _scene.camera((-0.60, -1.55, 1.80), (0.06, -0.33, 0.10), 36.0)
    scene.render.resolution_x, scene.render.resolution_y = 640, 360
    # Photons bring what scatters twice as well: camera paths would meet the thin fan by chance alone, in specks. Surfaces take many
    # photons cheaply, and media few, each of which is a beam; the two are counted apart and not weighed against each other.
    _scene.limit(
        scene,
        36,
        200_000,
        samples_per_pass=2,
        use_adaptive_sampling=False,
        photons_carry="INDIRECT",
        volume_photons_per_pass=20_000,
        volume_radius=0.004,
    )
    return scene


if __name__ == "__main__":
    _scene.run(build, "prism_in_mist")
