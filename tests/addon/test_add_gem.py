# SPDX-License-Identifier: GPL-3.0-or-later
"""Add › Mesh › Gem and File › Import › GemCad, as a script calls them with the extension enabled."""

import math

import bpy
import pytest

CUTS = ("BRILLIANT", "PRINCESS", "EMERALD", "ASSCHER", "OVAL", "PEAR", "MARQUISE", "CUSHION", "HEART", "TRILLION", "ROSE", "CABOCHON")
ASC = "GemCad 5.0\ng 96 0.0\ny 4 y\nI 1.54\nH A cube\na 90 0.5 96 24 48 72 n G\na 0 0.5 n T\na -0.0 0.5 n C\n"


@pytest.fixture(autouse=True)
def empty_file():
    bpy.ops.wm.read_homefile(use_empty=True)


@pytest.mark.parametrize("cut", CUTS)
def test_every_cut_comes_at_real_size_closed_and_turned_outward(cut):
    assert bpy.ops.opal.add_gem(cut=cut, species="RUBY") == {"FINISHED"}
    gem = bpy.context.object
    assert gem.dimensions.y == pytest.approx(0.0065, rel=1e-6)
    mesh = gem.data
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == 2
    volume = sum(polygon.center.dot(polygon.normal) * polygon.area for polygon in mesh.polygons) / 3.0
    box = gem.dimensions.x * gem.dimensions.y * gem.dimensions.z
    assert 0.2 * box < volume < 0.8 * box
    assert not mesh.validate(verbose=False), "Blender had something to mend"


def test_left_alone_it_adds_a_carat_of_diamond():
    bpy.ops.opal.add_gem()
    gem = bpy.context.object
    material = gem.data.materials[0]
    assert (material.opal.kind, material.opal.gem.species) == ("GEM", "DIAMOND")
    assert len(gem.data.polygons) == 57 + 96


def test_proportions_reach_the_mesh():
    bpy.ops.opal.add_gem(cut="BRILLIANT", size=1.0, girdle=0.05, pavilion_angle=math.radians(42.0), culet=0.02)
    lowest = min(vertex.co.z for vertex in bpy.context.object.data.vertices)
    point = 0.025 + 0.5 * math.tan(math.radians(42.0))
    assert -lowest == pytest.approx(point - 0.01 * math.cos(math.pi / 8) * math.tan(math.radians(42.0)), rel=1e-5)


def test_an_impossible_proportion_is_refused_with_a_sentence():
    with pytest.raises(RuntimeError, match="ratio must lie between 1 and 2"):
        bpy.ops.opal.add_gem(cut="OVAL", ratio=2.8)
    assert not bpy.data.objects


def test_stones_of_one_species_share_a_material():
    bpy.ops.opal.add_gem(cut="OVAL", species="RUBY")
    bpy.ops.opal.add_gem(cut="HEART", species="RUBY")
    bpy.ops.opal.add_gem(cut="HEART", species="SAPPHIRE_BLUE")
    kinds = [obj.data.materials[0] for obj in bpy.data.objects]
    assert len(set(kinds)) == 2


@pytest.mark.parametrize(
    "edit",
    [
        lambda material: setattr(material.opal.gem, "roughness", 0.2),
        lambda material: setattr(material.opal.gem, "fresnel", "SCHLICK"),
        lambda material: setattr(material.opal.gem, "priority", 3),
        lambda material: setattr(material.opal, "use_medium", True),
        lambda material: setattr(material.opal.gem, "absorption_depth", 0.02),
        lambda material: material.opal.gem.keyframe_insert("roughness"),
    ],
)
def test_a_material_that_was_edited_is_not_shared(edit):
    bpy.ops.opal.add_gem(species="RUBY")
    first = bpy.context.object.data.materials[0]
    edit(first)
    bpy.ops.opal.add_gem(species="RUBY")
    second = bpy.context.object.data.materials[0]
    assert second != first and (second.opal.gem.species, second.opal.gem.roughness) == ("RUBY", 0.0)
    bpy.ops.opal.add_gem(species="RUBY")
    assert bpy.context.object.data.materials[0] == second and len(bpy.data.materials) == 2


def test_it_lands_on_the_cursor():
    bpy.context.scene.cursor.location = (1.0, 2.0, 3.0)
    bpy.ops.opal.add_gem()
    assert tuple(bpy.context.object.location) == (1.0, 2.0, 3.0)


def test_a_gemcad_file_becomes_a_stone_of_its_refractive_index(tmp_path):
    path = tmp_path / "cube.asc"
    path.write_text(ASC)
    assert bpy.ops.opal.import_gemcad(filepath=str(path), species="CUSTOM", size=0.01) == {"FINISHED"}
    gem = bpy.context.object
    assert tuple(gem.dimensions) == pytest.approx((0.01, 0.01, 0.01), rel=1e-6)
    settings = gem.data.materials[0].opal.gem
    assert (settings.dispersion, settings.cauchy_c) == ("CAUCHY", 0.0)
    assert settings.cauchy_b == pytest.approx(1.54, abs=1e-6)


@pytest.mark.parametrize(
    ("text", "sentence"), [("GemCad 5.0\ng 96 0\na 141 0.5 96\n", "broken.asc: line 3"), ("a stone", "broken.asc: line 1")]
)
def test_a_broken_gemcad_file_is_refused_with_its_line(tmp_path, text, sentence):
    path = tmp_path / "broken.asc"
    path.write_text(text)
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.opal.import_gemcad(filepath=str(path))
    assert not bpy.data.objects


def test_a_missing_gemcad_file_is_refused(tmp_path):
    with pytest.raises(RuntimeError, match=r"nowhere\.asc cannot be read: No such file"):
        bpy.ops.opal.import_gemcad(filepath=str(tmp_path / "nowhere.asc"))


def test_a_path_may_be_relative_to_the_file(tmp_path):
    (tmp_path / "cube.asc").write_text(ASC)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    assert bpy.ops.opal.import_gemcad(filepath="//cube.asc") == {"FINISHED"}


def test_what_a_gemcad_file_leaves_open_is_said(tmp_path, capfd):
    path = tmp_path / "cube.asc"
    path.write_text(ASC.replace("I 1.54\n", "") + "a 45 0.9 12 36 n Far\n")
    bpy.ops.opal.import_gemcad(filepath=str(path))
    said = capfd.readouterr().out
    assert "cube.asc gives no refractive index" in said and "2 facets lie outside the stone and cut nothing: Far" in said
    path.write_text(ASC)
    bpy.ops.opal.import_gemcad(filepath=str(path))
    assert "Warning" not in capfd.readouterr().out
