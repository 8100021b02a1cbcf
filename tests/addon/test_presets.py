# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets set what they say, are kept in the extension's own folder alone, and materials show what they will become."""

import json
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


@pytest.fixture
def presets():
    return stage.addon("render_presets")


@pytest.fixture(autouse=True)
def _no_presets_of_others(presets):
    yield
    for path in presets.own().values():
        path.unlink()


def test_each_preset_sets_what_it_says_and_the_rest_as_in_a_new_file(presets):
    opal = bpy.context.scene.opal
    for name, values in presets.BUILT_IN.items():
        opal.radius_shrink, opal.max_depth, opal.seed = 0.9, 3, 7
        assert bpy.ops.opal.render_preset_apply(name=name) == {"FINISHED"}
        for key in presets.SETTINGS:
            prop = opal.bl_rna.properties[key]
            expected = values.get(key, prop.default)
            assert getattr(opal, key) == (pytest.approx(expected) if isinstance(expected, float) else expected), (name, key)
        assert opal.seed == 7, "the seed is the file's"


def test_every_setting_of_a_preset_exists(presets):
    names = set(bpy.context.scene.opal.bl_rna.properties.keys())
    assert set(presets.SETTINGS) <= names
    assert all(set(values) <= set(presets.SETTINGS) for values in presets.BUILT_IN.values())


def test_a_preset_is_kept_in_the_extensions_own_folder_comes_back_and_goes(presets):
    opal = bpy.context.scene.opal
    opal.passes, opal.volume_estimate, opal.radius = 33, "POINTS", 0.25
    before = _files()
    assert bpy.ops.opal.render_preset_add(name="My stones") == {"FINISHED"}
    own = Path(bpy.utils.extension_path_user("bl_ext.user_default.opal")).resolve()
    assert [own in path.resolve().parents for path in _files() - before] == [True]
    opal.passes, opal.volume_estimate, opal.radius = 1, "BEAMS", 0.0
    assert bpy.ops.opal.render_preset_apply(name="My stones") == {"FINISHED"}
    assert (opal.passes, opal.volume_estimate, opal.radius) == (33, "POINTS", 0.25)
    assert bpy.ops.opal.render_preset_remove(name="My stones") == {"FINISHED"}
    assert "My stones" not in presets.own()


def _files():
    return {path for path in Path(bpy.utils.resource_path("USER")).rglob("*") if path.is_file() and "__pycache__" not in path.parts}


@pytest.mark.parametrize(
    "operator, name, sentence",
    [
        ("render_preset_add", "", "Give the preset a name"),
        ("render_preset_add", "Final", "comes with Opal"),
        ("render_preset_apply", "Nowhere", "There is no preset named “Nowhere”"),
        ("render_preset_remove", "Final", "cannot be removed"),
    ],
)
def test_what_cannot_be_is_said_in_a_sentence(operator, name, sentence):
    with pytest.raises(RuntimeError, match=sentence):
        getattr(bpy.ops.opal, operator)(name=name)


def test_a_damaged_preset_is_refused_and_one_of_another_version_does_what_it_can(presets):
    folder = presets.folder(create=True)
    (folder / "Broken.json").write_text("{", encoding="utf-8")
    with pytest.raises(RuntimeError, match="cannot be read"):
        bpy.ops.opal.render_preset_apply(name="Broken")
    (folder / "Other.json").write_text(json.dumps({"passes": 9, "tomorrow": 1, "volume_estimate": "NEW"}), encoding="utf-8")
    assert sorted(presets.apply(bpy.context.scene.opal, "Other")) == ["tomorrow", "volume_estimate"]
    assert bpy.context.scene.opal.passes == 9


def test_a_folder_that_cannot_be_written_is_named(presets, monkeypatch, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("")
    monkeypatch.setattr(presets, "folder", lambda create=False: blocked)
    with pytest.raises(RuntimeError, match="cannot be written"):
        bpy.ops.opal.render_preset_add(name="Mine")


def wearing(material):
    obj = stage.plane(material=material)
    bpy.context.view_layer.objects.active = obj
    return material.opal


@pytest.mark.parametrize("kind, name", [("GEM", "RUBY"), ("MEDIUM", "MILK"), ("RAINBOW", "FOGBOW")])
def test_a_material_preset_makes_the_kind_and_fills_it(kind, name):
    opal = wearing(bpy.data.materials.new("Any"))
    assert bpy.ops.opal.apply_preset(kind=kind, preset=name) == {"FINISHED"}
    assert opal.kind == kind
    assert {"GEM": opal.gem.species, "MEDIUM": opal.medium.preset, "RAINBOW": opal.rainbow.preset}[kind] == name


def overridden_ruby(tmp_path):
    stone = bpy.data.materials.new("Ruby")
    stone.opal.kind, stone.opal.gem.species = "GEM", "RUBY"
    bpy.data.libraries.write(str(tmp_path / "stones.blend"), {stone}, fake_user=True)
    bpy.data.materials.remove(stone)
    with bpy.data.libraries.load(str(tmp_path / "stones.blend"), link=True) as (_, wanted):
        wanted.materials = ["Ruby"]
    return wanted.materials[0].override_create()


def test_an_override_takes_a_species_though_its_curve_is_the_library_s(tmp_path):
    """Blender lets nobody add to a list of an override, which was a traceback."""
    mine = overridden_ruby(tmp_path)
    mine.opal.gem.species = "SAPPHIRE_BLUE"
    local = bpy.data.materials.new("Local")
    local.opal.kind, local.opal.gem.species = "GEM", "SAPPHIRE_BLUE"
    spectra = stage.addon("translate.materials").gem_spectra
    for found, expected in zip(spectra(mine.opal.gem), spectra(local.opal.gem), strict=True):
        np.testing.assert_array_equal(found, expected)


def test_no_curve_is_imported_into_an_override(tmp_path):
    """It was a traceback, of a library override whose curve Blender lets nobody add to."""
    mine = overridden_ruby(tmp_path)
    obj = stage.plane()
    obj.data.materials.append(mine)
    bpy.context.view_layer.objects.active = obj
    path = tmp_path / "measured.csv"
    path.write_text("400,0.5\n700,0.5\n")
    with pytest.raises(RuntimeError, match="belongs to a library"):
        bpy.ops.opal.import_absorption(filepath=str(path))
    obj.data.materials[0] = mine.make_local(clear_liboverride=True)
    assert bpy.ops.opal.import_absorption(filepath=str(path)) == {"FINISHED"}


def test_a_material_preset_that_is_none_changes_nothing():
    opal = wearing(bpy.data.materials.new("Any"))
    with pytest.raises(RuntimeError, match="There is no gem named “CHEESE”"):
        bpy.ops.opal.apply_preset(kind="GEM", preset="CHEESE")
    assert opal.kind == "SURFACE"


def test_swatches_show_the_colour_and_every_preset_has_one():
    swatches, media, bows = stage.addon("swatches"), stage.addon("media_presets"), stage.addon("rainbow_presets")
    species = [item[0] for item in stage.addon("presets").species_items()[1:]]

    def colour(kind, name):
        picture = swatches.picture(kind, name)
        assert picture.shape == (32, 32, 4) and np.isfinite(picture).all() and picture.min() >= 0 and picture.max() <= 1
        return picture[picture[..., 3] > 0.5][:, :3].mean(axis=0)

    found = {
        (kind, name): colour(kind, name)
        for kind, names in (("GEM", species), ("MEDIUM", media.PRESETS), ("RAINBOW", bows.PRESETS))
        for name in names
    }
    red, green, milk, coffee = (found[k] for k in (("GEM", "RUBY"), ("GEM", "EMERALD"), ("MEDIUM", "MILK"), ("MEDIUM", "COFFEE")))
    assert red[0] > 1.5 * red[1] and green[1] > green[0]
    assert milk.min() > 0.6 and coffee.max() < 0.5
    arc = swatches.picture("RAINBOW", "CLASSIC")
    column = arc[:, 16][arc[:, 16, 3] > 0.5][::-1]  # from outside to inside
    assert column[1, 0] > column[1, 2], "red is outside"


def test_diffuse_reflectance_of_thick_media():
    """1 without absorption, 0 without scattering; isotropic albedo 0.5 sends 0.1445 back (s = 0.7071)."""
    from opal_kernels.charts.swatches import diffuse_reflectance

    assert diffuse_reflectance(np.array([0.0, 0.5, 1.0]), 0.0) == pytest.approx([0.0, 0.14453, 1.0], abs=1e-4)
    assert diffuse_reflectance(np.array([0.9]), 0.8) < diffuse_reflectance(np.array([0.9]), 0.0)
