# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur beside Cycles: what turns, goes round, is sheared or bent meanwhile, and glows, and a camera that turns.

Cycles reads a scene where its shutter opens, in the middle and where it closes. Between these, turn, place and scale go each by
themselves. A body that turns keeps its size so, which a matrix that went straight from one place to the other would not: at 87°
in the shutter it took 15 % of a bar's light.
"""

from __future__ import annotations

import math

import pytest
from test_scenes import camera, check, cube, diffuse, lamp, nodes_of, place, square, world

bpy = pytest.importorskip("bpy")

FRAME = 2  # the one rendered: halfway between two keyframes, where everything is fastest


def moves(owner, path, before, after):
    """Keyframes from the frame before to the frame after; Blender eases between them, so that speed is no constant."""
    for frame, value in ((FRAME - 1, before), (FRAME + 1, after)):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def glow(colour):
    material = bpy.data.materials.new("glow")
    tree = nodes_of(material)
    tree.nodes.clear()
    shader, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = (*colour, 1.0)
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def expose(shutter, position="CENTER"):
    render = bpy.context.scene.render
    render.use_motion_blur, render.motion_blur_shutter, render.motion_blur_position = True, shutter, position
    bpy.context.scene.frame_set(FRAME)


def stage_for_motion():
    place("floor", square("floor", diffuse("floor", (0.5, 0.5, 0.5)), 4))
    world((0.3, 0.35, 0.4))
    lamp("SUN", (0, 0, 3), (0.5, 0.3, 0), energy=2.0, angle=0.1)
    return camera((0, -1, 6), (0.15, 0, 0), lens=50)


@pytest.mark.parametrize("shutter", [0.25, 0.5, 1.0])
def test_a_wheel_keeps_its_size(opal, render, shutter):
    """Two bars, one above the other, which turn by about 56°, 110° and 200° while the shutter is open: by the last beyond half a turn."""
    stage_for_motion()
    for name, turn, z, colour in (("a", 0.0, 0.4, (0.8, 0.2, 0.1)), ("b", 0.5 * math.pi, 0.7, (0.1, 0.3, 0.8))):
        bar = place(name, cube(name, diffuse(name, colour)), (0.3, 0.1, z), scale=(2.4, 0.25, 0.25))
        moves(bar, "rotation_euler", (0, 0, turn), (0, 0, turn + 5.0))
    expose(shutter)
    check(render, mean_tolerance=0.003, unexplained_tolerance=0.01)


@pytest.mark.parametrize("position", ["START", "CENTER", "END"])
def test_what_goes_round_is_sheared_mirrored_bent_and_glows(opal, render, position):
    """A child that a turning parent carries round and shears, a mirrored one, a box that its shape keys bend, a bar of light.

    The mirrored child is not sheared as well: of such a body Cycles turns the skew the wrong way round once it moves at all."""
    stage_for_motion()
    for name, x, scale, hub_scale in (
        ("sheared", 0.9, (0.3, 0.5, 0.4), (1.0, 0.6, 1.2)),
        ("mirrored", -0.7, (-0.4, 0.5, 0.4), (1, 1, 1)),
    ):
        hub = place("hub", None, (-0.9, 0, 0), scale=hub_scale)
        moves(hub, "rotation_euler", (0, 0, 0), (0.3, 0, 2.4))
        child = place(name, cube(name, diffuse(name, (0.7, 0.6, 0.2))), (x, 0.2, 0.6), (0, 0, 0.5), scale)
        child.parent = hub
    bent = place("bent", cube("bent", diffuse("bent", (0.2, 0.7, 0.3))), (1.1, 0.9, 0.5), scale=(0.5, 0.5, 0.8))
    bent.shape_key_add(name="rest")
    key = bent.shape_key_add(name="bent")
    for corner in key.data:
        corner.co.x += 2.0 * (corner.co.z > 0)
    moves(key, "value", 0.0, 1.0)
    bar = place("light", cube("light", glow((3.0, 2.0, 1.0))), (1.0, -0.8, 0.4), scale=(1.2, 0.1, 0.1))
    moves(bar, "rotation_euler", (0, 0, -1), (0, 0, 1))
    expose(0.8, position)
    check(render, mean_tolerance=0.003, unexplained_tolerance=0.01)


def test_a_camera_that_turns_and_goes(opal, render):
    data = stage_for_motion()
    for i, colour in enumerate(((0.8, 0.2, 0.1), (0.2, 0.7, 0.2), (0.1, 0.3, 0.8))):
        place(f"post {i}", cube(f"post {i}", diffuse(f"post {i}", colour)), (i - 1, 0.6 * i - 0.5, 0.5), (0, 0, 0.4 * i), (0.4, 0.4, 1))
    obj = next(o for o in bpy.data.objects if o.data == data)
    moves(obj, "rotation_euler", (0.15, 0, -1.0), (0.25, 0.1, 1.0))
    moves(obj, "location", (-0.4, -1, 6), (0.4, -1.2, 5.5))
    expose(0.8)
    check(render, mean_tolerance=0.003, unexplained_tolerance=0.01)
