# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera that starts to see behind a stone is named, with the stone; one that sees it, or that another stands in front of, is not."""

import math

import bpy
import pytest
import stage

pytestmark = pytest.mark.usefixtures("opal")


def close_to_a_stone(clip_start=0.1, **camera):
    stage.scene(4, 4, passes=1, samples=1)
    stage.world()
    bpy.ops.opal.add_gem()
    bpy.context.object.name = "Stone"
    return stage.camera((0, 0, 0.04), clip_start=clip_start, **camera)


def about_the_camera(tmp_path):
    stage.render(tmp_path)
    return [line for line in stage.problems() if line.startswith("Camera")]


@pytest.mark.parametrize("camera", [{}, {"type": "ORTHO", "ortho_scale": 0.01}])
def test_a_stone_before_the_clip_start_is_named(camera, tmp_path):
    close_to_a_stone(**camera)
    (line,) = about_the_camera(tmp_path)
    assert line == "Camera: Clip Start: “Stone” lies nearer to the camera than 10 cm, where it starts to see: lower it"


def test_several_are_counted_and_the_unit_is_the_scenes(tmp_path):
    close_to_a_stone()
    bpy.context.scene.unit_settings.system = "IMPERIAL"
    for x in (0.008, -0.008):
        bpy.ops.opal.add_gem(location=(x, 0, 0))
    (line,) = about_the_camera(tmp_path)
    assert "“Stone” and 2 other gems lie nearer" in line and '"' in line.split("than")[1], line


def test_the_clip_start_is_said_as_the_interface_shows_it(tmp_path):
    camera = close_to_a_stone(clip_start=100.0)
    bpy.context.scene.unit_settings.scale_length = 0.001
    (line,) = about_the_camera(tmp_path)
    assert "than 10 cm" in line, (line, camera.data.clip_start)


def test_what_the_camera_sees_or_does_not_look_at_is_not_named(tmp_path):
    camera = close_to_a_stone(clip_start=0.001)
    assert about_the_camera(tmp_path) == []
    camera.data.clip_start = 0.1
    camera.rotation_euler.x = math.pi
    assert about_the_camera(tmp_path) == []
    camera.rotation_euler.x = 0
    camera.location.x = 0.1
    assert about_the_camera(tmp_path) == []
    camera.location = (0, 0, 0.101)  # half of the stone is seen
    assert about_the_camera(tmp_path) == []
    camera.location.z, bpy.data.objects["Stone"].visible_camera = 0.04, False
    assert about_the_camera(tmp_path) == []


def test_a_wall_cut_away_to_look_in_is_nobodys_mistake(tmp_path):
    close_to_a_stone(clip_start=0.001).data.clip_start = 0.02
    stage.plane("Wall", 0.01, (0, 0, 0.03), stage.matte())
    assert about_the_camera(tmp_path) == []
