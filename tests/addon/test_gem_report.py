# SPDX-License-Identifier: GPL-3.0-or-later
"""`opal.gem_report` on a stone of `opal.add_gem`: numbers, page and files; and what it refuses."""

import importlib
import math
import re

import bpy
import pytest
import stage

SMALL = {"size": 128, "passes": 1, "tilt_steps": 3}


def stone(**settings):
    bpy.ops.opal.add_gem(cut="BRILLIANT", **settings)
    return bpy.context.active_object


def numbers():
    lines = bpy.data.texts["Gem Report"].as_string().splitlines()
    pairs = (re.fullmatch(r"([a-z\- ()]+?)\s+(-?[\d.]+)", line) for line in lines)
    return {match[1]: float(match[2]) for match in pairs if match}


def test_a_report_is_an_image_a_text_and_files(opal, tmp_path, capfd):
    obj = stone(species="DIAMOND")
    obj.data.materials[0].opal.gem.roughness = 0.25
    path = tmp_path / "folder" / "diamond.png"
    assert bpy.ops.opal.gem_report(filepath=str(path), **SMALL) == {"FINISHED"}
    text = path.with_suffix(".txt").read_text()
    assert path.stat().st_size > 5000 and "light return" in text
    assert "no nail-head (up to 0.5)" in text and text.endswith("the stone is judged polished\n")
    assert f"Warning: “{obj.name}”: the roughness of “Diamond” (0.25) is ignored" in capfd.readouterr().out
    assert bpy.data.images["Gem Report"].size[0] > 2 * 128
    assert 0.6 < numbers()["light return"] < 0.9
    assert numbers()["fire (degrees)"] > 0.8


def test_a_stone_lying_on_its_side_is_judged_face_up_and_its_size_does_not_matter_to_a_clear_one(opal):
    obj = stone(species="DIAMOND")
    bpy.ops.opal.gem_report(**SMALL)
    upright = numbers()
    obj.rotation_euler, obj.scale, obj.location = (1.2, 0.4, 2.0), (1000, 1000, 1000), (5, 6, 7)
    bpy.context.view_layer.update()
    bpy.ops.opal.gem_report(**SMALL)
    assert numbers() == pytest.approx(upright, abs=2e-3)


def test_a_larger_ruby_is_darker(opal):
    obj = stone(species="RUBY")
    bpy.ops.opal.gem_report(**SMALL)
    small = numbers()
    obj.scale = (4, 4, 4)
    bpy.context.view_layer.update()
    bpy.ops.opal.gem_report(**SMALL)
    assert numbers()["absorbed"] > small["absorbed"] + 0.05


def test_a_steep_pavilion_is_a_nail_head(opal):
    stone(species="DIAMOND", pavilion_angle=math.radians(45.0))
    bpy.ops.opal.gem_report(**SMALL)
    assert numbers()["nail-head"] > 0.5 > numbers()["head shadow"]


def left_out(obj):
    bpy.context.view_layer.update()
    operators = importlib.import_module(stage.addon("presets").__package__.removesuffix("addon") + "operators.gem_report")
    return operators._stone_of(obj, bpy.context.evaluated_depsgraph_get(), 1.0)[1]


def test_what_the_report_leaves_out_is_said_and_nothing_else(opal):
    obj = stone(species="DIAMOND")
    assert left_out(obj) == []
    material = obj.data.materials[0]
    obj.data.materials.append(stage.matte("Unused"))
    assert left_out(obj) == []
    material.opal.gem.roughness, material.opal.gem.fresnel, material.opal.use_medium = 0.25, "SCHLICK", True
    obj.data.materials.append(stage.matte("Foil"))
    obj.data.polygons[3].material_index = 2
    obj.data.polygons[4].use_smooth = True
    roughness, schlick, clouding, others, smooth = left_out(obj)
    assert roughness.startswith("the roughness of “Diamond” (0.25) is ignored") and schlick.startswith(
        "Schlick's approximation of “Diamond”"
    )
    assert clouding.startswith("the clouding of “Diamond”") and "(Foil)" in others and smooth.startswith("its smooth faces are judged")


def test_a_mirrored_stone_is_no_stone_turned_inside_out(opal):
    obj = stone(species="DIAMOND")
    obj.scale = (-1, 1, 1)
    bpy.context.view_layer.update()
    assert bpy.ops.opal.gem_report(**SMALL) == {"FINISHED"}


def test_what_is_no_stone_is_refused_with_a_sentence_that_names_it(opal):
    obj = stage.plane("Floor", material=stage.matte())
    bpy.context.view_layer.objects.active = obj
    with pytest.raises(RuntimeError, match="“Floor”: the stone has no material of the kind Gem"):
        bpy.ops.opal.gem_report(**SMALL)
    obj.data.materials[0].opal.kind = "GEM"
    with pytest.raises(RuntimeError, match="“Floor”: a stone needs at least four faces"):
        bpy.ops.opal.gem_report(**SMALL)
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.opal.gem_report.poll()


def test_a_file_that_cannot_be_written_leaves_the_report_in_blender(opal, tmp_path):
    stone(species="DIAMOND")
    (tmp_path / "file").write_text("")
    with pytest.raises(RuntimeError, match="stays in Blender"):
        bpy.ops.opal.gem_report(filepath=str(tmp_path / "file" / "page.png"), **SMALL)
    assert "Gem Report" in bpy.data.images
