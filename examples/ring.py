# SPDX-License-Identifier: GPL-3.0-or-later
"""A gold ring with a diamond in four claws: caustics of polished metal and of a gem side by side.

The ring lies on the table, on its band and two of its claws. Light from the left comes in over the band, and its inner face gathers it in
the cusped curve that a cup of tea shows, the cardioid's and nephroid's kin; the stone scatters its spectra into its own shadow.
"""

import math
import sys
from collections.abc import Sequence
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

INNER, THICK, WIDE = 0.0085, 0.0016, 0.0024
"""Radius inside the ring, and its band's thickness and width, m."""
FLAT = 0.25
"""How round the band's inner side is: 1 as its outer side, 0 not at all."""
STONE = 0.0068


def band(material: bpy.types.Material) -> bpy.types.Object:
    """The ring: a section that is round outside and all but flat inside, carried round the y axis, lowest point on the table.

    A finger's side that bulged would scatter the light that it should gather.
    """
    around, section = 240, 64
    middle = INNER + 0.5 * THICK
    vertices = []
    for i in range(around):
        a = math.tau * i / around
        for j in range(section):
            c, s = math.cos(math.tau * j / section), math.sin(math.tau * j / section)
            if c < 0:
                c, s = -((-c) ** FLAT), math.copysign(abs(s) ** FLAT, s)
            r = middle + 0.5 * THICK * c
            vertices.append((r * math.sin(a), 0.5 * WIDE * s, INNER + THICK + r * math.cos(a)))
    faces = []
    for i in range(around):
        for j in range(section):
            k, m = (i + 1) % around, (j + 1) % section
            faces.append((i * section + j, i * section + m, k * section + m, k * section + j))
    return _scene.mesh("Ring", vertices, faces, material, smooth=True)


def claw(start: Sequence[float], end: Sequence[float], radius: float, material: bpy.types.Material) -> None:
    """A round rod with a ball on its end."""
    sides = 24
    axis = Vector(end) - Vector(start)
    turn = axis.to_track_quat("Z", "Y").to_matrix().to_4x4()
    rim = [(radius * math.cos(math.tau * i / sides), radius * math.sin(math.tau * i / sides)) for i in range(sides)]
    vertices = [(x, y, z) for z in (0.0, axis.length) for x, y in rim]
    faces = [(i, (i + 1) % sides, sides + (i + 1) % sides, sides + i) for i in range(sides)]
    rod = _scene.mesh("Claw", vertices, faces, material, smooth=True)
    rod.matrix_world = Matrix.Translation(Vector(start)) @ turn
    _scene.sphere("Claw's tip", end, 1.25 * radius, material)


def lay_down(objects: Sequence[bpy.types.Object], lift: float, turn: float) -> None:
    """Lay what stands along z on its side, the top towards −y and lifted by an angle, turned about the vertical, lowest point on the table."""
    pose = Matrix.Rotation(turn, 4, "Z") @ Matrix.Translation((0.0, INNER + THICK, 0.0)) @ Matrix.Rotation(0.5 * math.pi - lift, 4, "X")
    placed = [(obj, pose @ obj.matrix_basis) for obj in objects]
    lowest = min((matrix @ vertex.co).z for obj, matrix in placed for vertex in obj.data.vertices)
    for obj, matrix in placed:
        obj.matrix_world = Matrix.Translation((0.0, 0.0, 1e-6 - lowest)) @ matrix


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    from opal_kernels.cuts import round_brilliant

    scene = _scene.empty()
    gold = _scene.surface("Gold", (1.0, 0.72, 0.29), roughness=0.04, metallic=1.0)
    band(gold)
    top = 2.0 * (INNER + THICK)
    stone = _scene.stone("Diamond", round_brilliant(), STONE, _scene.gem("Diamond", "DIAMOND"))
    seat = top + 0.46 * STONE
    stone.location = (0.0, 0.0, seat)
    for i in range(4):
        angle = math.radians(45.0 + 90.0 * i)
        c, s = math.cos(angle), math.sin(angle)
        claw((0.0004 * c, 0.0004 * s, top - 0.4e-3), (0.53 * STONE * c, 0.53 * STONE * s, seat + 0.10 * STONE), 0.00032, gold)
    lay_down([obj for obj in scene.collection.objects if obj.type == "MESH"], lift=math.radians(5.5), turn=math.radians(24.0))
    _scene.stage(0.6, _scene.matte("Table", (0.36, 0.35, 0.35)), depth=0.12, wall=0.2)
    _scene.lamp("Lamp", "AREA", (-0.090, -0.020, 0.050), (0.0, 0.0, 0.0), 0.42, shape="DISK", size=0.004)
    _scene.hdri(_scene.studio_light("interior"), 0.10, math.radians(-40.0))
    _scene.camera((0.008, -0.072, 0.070), (0.0035, -0.0025, 0.001), 96.0, fstop=16.0, focus=(0.0, -0.012, 0.003))
    scene.render.resolution_x, scene.render.resolution_y = 840, 600
    _scene.limit(scene, 256, 400_000)
    return scene


if __name__ == "__main__":
    _scene.run(build, "ring")
