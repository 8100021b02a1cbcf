# SPDX-License-Identifier: GPL-3.0-or-later
"""A beam of white light through a prism in mist: the spectrum hangs in the air.

A lamp behind a card with a slit sends a sheet of light through a prism of dense flint (SF11, 60°) at minimum deviation, where
yellow turns by 66.3°, red by 64.7° and violet by 74.6° (PHYSICS §5.6). What the mist scatters of it is seen from the side.
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
LAMP_DISTANCE, SLIT_DISTANCE = 1.75, 0.62
SLIT_WIDTH, SLIT_HEIGHT = 0.016, 0.10


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


def card_with_slit(material: bpy.types.Material) -> None:
    """Four plates that leave a slit in the beam."""
    x, w, h = -SLIT_DISTANCE, 0.5 * SLIT_WIDTH, 0.5 * SLIT_HEIGHT
    low, high = BEAM_HEIGHT - h, BEAM_HEIGHT + h
    for i, (y0, y1, z0, z1) in enumerate(
        ((-0.30, -w, 0.0, 0.36), (w, 0.30, 0.0, 0.36), (-w, w, 0.0, low), (-w, w, high, 0.36)),
    ):
        _scene.box(f"Card {i}", (x - 0.006, y0, z0), (x, y1, z1), material)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    scene.unit_settings.length_unit = "CENTIMETERS"
    _scene.stage(6.0, _scene.matte("Table", (0.055, 0.055, 0.06)))
    _scene.box("Mist", (-2.2, -2.2, 0.001), (2.2, 1.6, 0.9), _scene.medium("Mist", 0.30, (1.0, 1.0, 1.0), 0.35))
    prism(_scene.gem("Flint glass", "SF11"))
    card_with_slit(_scene.matte("Card", (0.03, 0.03, 0.03)))
    distance = LAMP_DISTANCE - SLIT_DISTANCE
    _scene.lamp(
        "Lamp",
        "SPOT",
        (-LAMP_DISTANCE, 0.0, BEAM_HEIGHT),
        (0.0, 0.0, BEAM_HEIGHT),
        45000.0,
        spot_size=2.0 * math.atan(0.75 * SLIT_HEIGHT / distance),
        spot_blend=0.0,
        shadow_soft_size=0.003,
    )
    _scene.plain_world((0.30, 0.48, 1.0), 0.10)
    _scene.camera((0.20, -1.45, 1.10), (0.10, -0.16, 0.08), 36.0)
    scene.render.resolution_x, scene.render.resolution_y = 640, 360
    _scene.limit(scene, 64, 10_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "prism_in_mist")
