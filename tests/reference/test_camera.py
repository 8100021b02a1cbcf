# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras beside Cycles: what each pixel sees is in the same place and as blurred.

The scene is glowing boards of different colours at different depths, so that a picture is geometry and lens alone: the two
engines differ by the noise of edges, which is measured from two seeds of Cycles.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

SAMPLES = 256
BOARDS = (  # location, size, colour
    ((0.0, 0.0, -4.0), 3.0, (0.15, 0.3, 0.6)),
    ((-0.5, 0.2, -3.0), 0.5, (1.0, 0.2, 0.1)),
    ((0.4, -0.2, -2.0), 0.3, (0.1, 1.0, 0.2)),
    ((0.2, 0.35, -1.2), 0.12, (1.0, 1.0, 1.0)),
)


def glow(color):
    material = bpy.data.materials.new("glow")
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output, emission = (
        tree.nodes.new("ShaderNodeOutputMaterial"),
        tree.nodes.new("ShaderNodeEmission"),
    )
    emission.inputs["Color"].default_value = (*color, 1)
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def boards():
    for number, (location, size, color) in enumerate(BOARDS):
        h = size / 2
        mesh = bpy.data.meshes.new(f"board {number}")
        mesh.from_pydata([(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)], [], [(0, 1, 2, 3)])
        mesh.materials.append(glow(color))
        obj = bpy.data.objects.new(mesh.name, mesh)
        obj.location = location
        bpy.context.scene.collection.objects.link(obj)


def camera(dof=None, **settings):
    data = bpy.data.cameras.new("camera")
    for name, value in settings.items():
        setattr(data, name, value)
    if dof is not None:
        data.dof.use_dof = True
        for name, value in dof.items():
            setattr(data.dof, name, value)
    obj = bpy.data.objects.new("camera", data)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.scene.camera = obj
    return obj


def check(render, size=(36, 24)):
    scene = bpy.context.scene
    one, two, ours = (
        np.asarray(render(scene, engine, size, SAMPLES, seed), dtype=np.float64)[..., :3]
        for engine, seed in (("CYCLES", 1), ("CYCLES", 2), ("OPAL", 3))
    )
    theirs = 0.5 * (one + two)
    assert ours.shape == theirs.shape
    assert theirs.max() > 0.1, "the camera sees nothing"
    assert ours.mean(axis=(0, 1)) == pytest.approx(theirs.mean(axis=(0, 1)), rel=5e-3)
    # An edge pixel is a fraction of hits among the samples: its standard error is at most 1 / (2 sqrt n), less in practice.
    difference = np.abs(ours - theirs)
    worst = 5 * 0.5 / math.sqrt(SAMPLES)
    assert difference.max() < worst, f"pixel {np.unravel_index(difference.argmax(), difference.shape)}"
    assert np.sqrt(np.mean(difference**2)) < 2.5 * max(np.std(one - two), 2e-3)


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"lens": 24.0},
        {"sensor_fit": "HORIZONTAL", "sensor_width": 30.0},
        {"sensor_fit": "VERTICAL", "sensor_height": 20.0},
        {"shift_x": 0.12, "shift_y": -0.07},
        {"sensor_fit": "VERTICAL", "shift_x": 0.12, "shift_y": -0.07},
        {"type": "ORTHO", "ortho_scale": 1.8},
        {"type": "ORTHO", "ortho_scale": 1.5, "sensor_fit": "VERTICAL", "shift_x": 0.1},
        {"clip_start": 1.5, "clip_end": 3.5},
    ],
    ids=str,
)
@pytest.mark.parametrize("size", [(36, 24), (20, 32)])
def test_lens_and_sensor(opal, render, settings, size):
    boards()
    camera(**settings)
    check(render, size)


def test_wide_pixels(opal, render):
    boards()
    camera()
    bpy.context.scene.render.pixel_aspect_x = 1.7
    check(render)


def test_a_camera_that_is_turned_moved_scaled_and_parented(opal, render):
    boards()
    obj = camera(lens=30.0)
    obj.location, obj.rotation_euler, obj.scale = (
        (0.2, -0.1, 0.3),
        (0.1, -0.05, 0.4),
        (2.0, 0.5, 3.0),
    )
    parent = bpy.data.objects.new("parent", None)
    parent.rotation_euler = (0.05, 0.02, 0.3)
    bpy.context.scene.collection.objects.link(parent)
    obj.parent = parent
    check(render)


@pytest.mark.parametrize(
    "dof",
    [
        {"focus_distance": 2.0, "aperture_fstop": 0.2},
        {
            "focus_distance": 3.0,
            "aperture_fstop": 0.2,
            "aperture_blades": 5,
            "aperture_rotation": 0.4,
        },
        {"focus_distance": 3.0, "aperture_fstop": 0.2, "aperture_ratio": 2.0},
        {
            "focus_distance": 3.0,
            "aperture_fstop": 0.15,
            "aperture_blades": 3,
            "aperture_ratio": 1.6,
            "aperture_rotation": 0.2,
        },
    ],
    ids=str,
)
def test_depth_of_field(opal, render, dof):
    boards()
    camera(dof, lens=50.0)
    check(render)


def test_orthographic_depth_of_field(opal, render):
    boards()
    camera({"focus_distance": 3.0, "aperture_fstop": 4.0}, type="ORTHO", ortho_scale=1.8)
    check(render)


def test_focus_on_an_object_is_along_the_axis(opal, render):
    boards()
    target = bpy.data.objects.new("target", None)
    target.location = (2.0, 1.0, -2.0)
    bpy.context.scene.collection.objects.link(target)
    camera({"focus_object": target, "aperture_fstop": 0.2})
    check(render)


@pytest.mark.parametrize("kind", ["BOX", "GAUSSIAN", "BLACKMAN_HARRIS"])
def test_pixel_filters_blur_alike(opal, render, kind):
    boards()
    camera()
    scene = bpy.context.scene
    width = 1.0 if kind == "BOX" else 2.0  # in Cycles a box is one pixel wide whatever the width says
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = kind, width
    scene.opal.pixel_filter, scene.opal.filter_width = kind, width
    check(render)


def test_looking_through_a_spot_lamp(opal, render):
    boards()
    data = bpy.data.lights.new("spot", "SPOT")
    data.spot_size, data.energy = 1.0, 0.0
    obj = bpy.data.objects.new("spot", data)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.scene.camera = obj
    check(render)
