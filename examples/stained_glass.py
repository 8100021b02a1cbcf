# SPDX-License-Identifier: GPL-3.0-or-later
"""Sun through a stained-glass window into a dim, dusty church: every pane throws a shaft of its colour.

Panes are real glass of index 1.5, so no shadow ray gets through them and the shafts are caustics in air, found by photons that
the sun sends at the panes alone.
"""

import math
import sys
from collections.abc import Iterator
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

PANE, LEAD, THICKNESS = 0.30, 0.045, 0.012
"""Width of a pane, of the lead between two, and thickness of the glass, m."""
LANCETS = ((-1.75, 7), (0.0, 10), (1.75, 7))
"""Middle of each window along the wall (m) and its rows of panes; three panes a row."""
SILL = 1.3
WALL, HALF, TOP = 3.0, 3.4, 5.6
"""Where the wall stands (x), half its length and its height, m."""
COLOURS = {
    "Ruby": (0.80, 0.02, 0.03),
    "Cobalt": (0.02, 0.07, 0.75),
    "Gold": (0.95, 0.55, 0.04),
    "Green": (0.04, 0.50, 0.10),
    "Violet": (0.35, 0.05, 0.60),
    "Sky": (0.25, 0.60, 0.90),
}
PATTERN = ("Ruby", "Cobalt", "Gold", "Cobalt", "Green", "Violet", "Ruby", "Sky", "Gold", "Cobalt")


def panes() -> Iterator[tuple[float, float, str]]:
    """(y, z) of each pane's lower left corner, and its colour."""
    for i, (middle, rows) in enumerate(LANCETS):
        for row in range(rows):
            for column in range(3):
                y = middle + (column - 1.5) * (PANE + LEAD) + 0.5 * LEAD
                name = PATTERN[(row + i + (3 if column == 1 else 0)) % len(PATTERN)]
                yield y, SILL + row * (PANE + LEAD), name


def wall_with_holes(material: bpy.types.Material) -> None:
    """The wall as bars between the holes: stone where no pane is."""
    holes = sorted((y, z) for y, z, _ in panes())
    columns = sorted({y for y, _ in holes})
    depth = (WALL, WALL + 0.10)

    def bar(y0: float, y1: float, z0: float, z1: float) -> None:
        _scene.box("Stone", (depth[0], y0, z0), (depth[1], y1, z1), material)

    left = -HALF
    for y in columns:
        bar(left, y, 0.0, TOP)
        low = 0.0
        for z in [z for at, z in holes if at == y]:
            bar(y, y + PANE, low, z)
            low = z + PANE
        bar(y, y + PANE, low, TOP)
        left = y + PANE
    bar(left, HALF, 0.0, TOP)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    scene.unit_settings.length_unit = "METERS"
    stone = _scene.matte("Stone", (0.34, 0.31, 0.28))
    wall_with_holes(stone)
    _scene.mesh("Floor", [(-4.2, -HALF, 0.0), (WALL, -HALF, 0.0), (WALL, HALF, 0.0), (-4.2, HALF, 0.0)], [(0, 1, 2, 3)], stone)
    _scene.box("Back wall", (-4.2, HALF, 0.0), (WALL, HALF + 0.1, TOP), stone)
    _scene.box("Front wall", (-4.2, -HALF - 0.1, 0.0), (WALL + 0.1, -HALF, TOP), stone)
    _scene.box("Ceiling", (-4.2, -HALF, TOP), (WALL + 0.1, HALF + 0.1, TOP + 0.1), stone)
    _scene.box("Far wall", (-4.3, -HALF, 0.0), (-4.2, HALF, TOP), stone)
    glass = {name: _scene.glass(name, 1.5, colour=colour, depth=THICKNESS) for name, colour in COLOURS.items()}
    x, lap = WALL + 0.04, 0.01
    for y, z, name in panes():
        _scene.box("Pane", (x, y - lap, z - lap), (x + THICKNESS, y + PANE + lap, z + PANE + lap), glass[name])
    _scene.box(
        "Dust", (-4.15, -HALF + 0.02, 0.005), (WALL - 0.02, HALF - 0.02, TOP - 0.02), _scene.medium("Dust", 0.035, (0.95, 0.94, 0.92), 0.2)
    )
    _scene.lamp("Sun", "SUN", (6.0, -1.6, 5.2), (0.0, 0.0, 0.6), 260.0, angle=math.radians(0.53))
    _scene.plain_world((0.45, 0.60, 1.0), 0.01)
    _scene.camera((-3.6, -2.9, 1.45), (1.3, 0.55, 1.85), 22.0)
    scene.render.resolution_x, scene.render.resolution_y = 640, 360
    _scene.limit(scene, 64, 8_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "stained_glass")
