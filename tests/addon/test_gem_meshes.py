# SPDX-License-Identifier: GPL-3.0-or-later
"""Gems whose meshes are wrong: the report names the object, and the picture is sane."""

import bpy
import pytest
import stage


def stone_in_a_furnace(material_index=1.5):
    scene = stage.scene(12, 12, passes=4, samples=16)
    material = bpy.data.materials.new("Glass")
    material.opal.kind = "GEM"
    gem = material.opal.gem
    gem.dispersion, gem.cauchy_b, gem.cauchy_c = "CAUCHY", material_index, 0.0
    h = 0.5
    corners = [(x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    obj = stage.mesh("Stone", corners, faces, material=material)
    obj.rotation_euler = (0.4, 0.3, 0)
    stage.world()
    stage.camera((0, 0, 3), type="ORTHO", ortho_scale=0.8)
    return scene, obj


def about(name):
    return [line for line in stage.problems() if line.startswith(f"{name}:")]


def test_a_good_gem_is_not_spoken_of(opal, tmp_path):
    stone_in_a_furnace()
    image = stage.render(tmp_path)[..., :3]
    assert about("Stone") == [] and image.mean() == pytest.approx(1.0, abs=0.005)


def test_flipped_normals_are_named_and_make_no_difference(opal, tmp_path):
    _, obj = stone_in_a_furnace()
    material = obj.data.materials[0].opal.gem
    material.absorption_color, material.absorption_depth = (0.3, 0.5, 0.8), 0.7
    right = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    obj.data.flip_normals()
    flipped = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    assert any("normals are flipped" in line for line in about("Stone"))
    assert flipped == pytest.approx(right, rel=0.01)


def test_some_flipped_faces_are_named(opal, tmp_path):
    _, obj = stone_in_a_furnace()
    obj.data.polygons[2].flip()
    obj.data.update()
    image = stage.render(tmp_path)
    assert any("recalculate" in line for line in about("Stone"))
    assert image.max() < 3


def test_an_open_gem_is_named_and_is_neither_black_nor_burnt(opal, tmp_path):
    _, obj = stone_in_a_furnace()
    corners = [v.co.copy() for v in obj.data.vertices]
    faces = [tuple(p.vertices) for p in obj.data.polygons][:-1]
    material = obj.data.materials[0]
    obj.data = bpy.data.meshes.new("Open")
    obj.data.from_pydata(corners, [], faces)
    obj.data.materials.append(material)
    image = stage.render(tmp_path)[..., :3]
    assert any("open at 4 edges" in line for line in about("Stone"))
    assert 0.4 < image.mean() < 1.6
