# SPDX-License-Identifier: GPL-3.0-or-later
"""A gemmologist's light booth: two grey compartments side by side, the same stone in both, and a lamp of another spectrum over each."""

import math
from collections.abc import Mapping

import _scene
import bpy

WIDTH, DEPTH, HEIGHT = 0.017, 0.016, 0.022
"""Inside of a compartment, m."""
WALL = 0.0008


def _lamp(name: str, place, target, energy: float, size: float, spectrum: Mapping[str, object]) -> None:
    lamp = _scene.lamp(name, "AREA", place, target, energy, shape="DISK", size=size)
    for key, value in spectrum.items():
        if hasattr(lamp.data, "opal"):
            setattr(lamp.data.opal, key, value)


def booth(
    cut,
    species: str,
    left: Mapping[str, object],
    right: Mapping[str, object],
    width: float = 0.0065,
    grey: float = 0.25,
    fill: float = 0.0,
    lens: float = 160.0,
) -> bpy.types.Scene:
    """The scene.

    Parameters
    ----------
    cut : opal_kernels.cuts.Stone
        The stone that lies in both compartments.
    species : str
        Its `material.opal.gem.species`.
    left, right : mapping
        Settings of `light.opal` for the lamps of each compartment.
    width : float
        Of the stone, m.
    grey : float
        Reflectance of the walls.
    fill : float
        Power of each of two more panels before each compartment, W, above and under the camera's line of sight.
    lens : float
        Focal length of the camera, mm.
    """
    scene = _scene.empty()
    wall = _scene.matte("Booth", (grey, grey, grey))
    total = 2 * WIDTH + WALL
    floor = [(-total, -0.05, 0.0), (total, -0.05, 0.0), (total, DEPTH, 0.0), (-total, DEPTH, 0.0)]
    _scene.mesh("Floor", floor, [(0, 1, 2, 3)], wall)
    _scene.box("Back", (-total, DEPTH, 0.0), (total, DEPTH + WALL, HEIGHT), wall)
    _scene.box("Divider", (-0.5 * WALL, -0.05, 0.0), (0.5 * WALL, DEPTH, 2 * HEIGHT), wall)
    material = _scene.gem(species.title(), species)
    main = cut.names.index("main")
    for side, spectrum in ((-1, left), (1, right)):
        x = side * 0.5 * (WIDTH + WALL)
        name = "Left" if side < 0 else "Right"
        stone = _scene.stone(f"{name} stone", cut, width, material)
        _scene.rest_on_facet(stone, main, (x, 0.004), math.radians(-90.0 + side * 8.0))
        # A panel that shows the stone's colour, and a small lamp for its fire and the light under it.
        _lamp(f"{name} panel", (x, 0.011, 1.6 * HEIGHT), (x, 0.004, 0.0), 0.010, 0.012, spectrum)
        _lamp(f"{name} spot", (x + side * 0.010, -0.014, 1.5 * HEIGHT), (x, 0.004, 0.002), 0.008, 0.0012, spectrum)
        if fill:
            for place in ((x, -0.026, 0.050), (x, -0.044, 0.010)):
                _lamp(f"{name} fill", place, (x, 0.004, 0.003), fill, 0.016, spectrum)
    _scene.plain_world((1.0, 1.0, 1.0), 0.0)
    _scene.camera((0.0, -0.130, 0.075), (0.0, 0.004, 0.0025), lens, fstop=32.0)
    scene.render.resolution_x, scene.render.resolution_y = 720, 400
    _scene.limit(scene, 128, 200_000)
    return scene
