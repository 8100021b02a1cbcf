# SPDX-License-Identifier: GPL-3.0-or-later
"""A gem's absorption from property, file and species to the picture; what is refused and what is kept."""

import math

import bpy
import numpy as np
import pytest
import stage


@pytest.fixture
def gem(opal):
    material = bpy.data.materials.new("Stone")
    material.opal.kind = "GEM"
    return material.opal.gem


def plate(material, thickness=0.001, scale=1.0):
    """An index-matched plate of `thickness` metres before a white world, seen straight."""
    scene = stage.scene(8, 8, passes=2, samples=16)
    h = thickness / 2
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-h, h)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    obj = stage.mesh("Plate", corners, faces, material=material)
    obj.scale = (1, 1, scale)
    stage.world()
    stage.camera((0, 0, 2), type="ORTHO", ortho_scale=0.5)
    return scene


def clear_stone(gem):
    gem.dispersion, gem.cauchy_b, gem.cauchy_c = "CAUCHY", 1.0, 0.0
    return gem.id_data


def import_curve(tmp_path, material, text):
    obj = stage.mesh("Holder", [(0, 0, -9), (1, 0, -9), (0, 1, -9)], [(0, 1, 2)], material=material)
    bpy.context.view_layer.objects.active = obj
    path = tmp_path / "measured.csv"
    path.write_text(text)
    return bpy.ops.opal.import_absorption(filepath=str(path))


def test_an_imported_curve_absorbs_as_beer_and_lambert_say(gem, tmp_path):
    material = clear_stone(gem)
    assert import_curve(tmp_path, material, "nm,1/mm\n400,0.5\n700,0.5\n") == {"FINISHED"}
    assert gem.absorption_source == "CURVE" and gem.species == "CUSTOM" and len(gem.absorption_curve) == 2
    plate(material)
    assert stage.render(tmp_path)[..., :3].mean(axis=(0, 1)) == pytest.approx(math.exp(-0.5), rel=2e-3)


def test_white_light_becomes_the_absorption_color_along_the_absorption_depth(gem, tmp_path):
    material = clear_stone(gem)
    gem.absorption_color, gem.absorption_depth = (0.8, 0.3, 0.5), 0.001
    plate(material)
    assert stage.render(tmp_path)[..., :3].mean(axis=(0, 1)) == pytest.approx([0.8, 0.3, 0.5], rel=0.02, abs=0.01)


def test_depth_scales_with_the_object(gem, tmp_path):
    material = clear_stone(gem)
    gem.absorption_color, gem.absorption_depth = (0.25, 0.25, 0.25), 0.002
    plate(material, thickness=0.001, scale=2.0)
    assert stage.render(tmp_path)[..., :3].mean(axis=(0, 1)) == pytest.approx(0.25, rel=5e-3)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [("400,0.5\n500,-1\n", "Line 2: an absorption cannot be negative"), ("400,0.5\n500,x\n", "Line 2: “x” is not a number")],
)
def test_a_bad_file_is_named_with_its_line_and_changes_nothing(gem, tmp_path, text, sentence):
    gem.species = "RUBY"
    before = [tuple((s.wavelength, s.absorption)) for s in gem.absorption_curve]
    with pytest.raises(RuntimeError, match=f"measured.csv: {sentence}"):
        import_curve(tmp_path, gem.id_data, text)
    assert gem.species == "RUBY" and [tuple((s.wavelength, s.absorption)) for s in gem.absorption_curve] == before


def test_a_file_that_is_not_there_is_named(gem, tmp_path):
    import_curve(tmp_path, gem.id_data, "400,0.5\n")
    with pytest.raises(RuntimeError, match="gone.csv cannot be read"):
        bpy.ops.opal.import_absorption(filepath=str(tmp_path / "gone.csv"))


def test_impossible_absorption_is_refused_with_a_sentence_and_the_last_good_kept(gem):
    gem.species = "RUBY"
    tint, depth = tuple(gem.absorption_color), gem.absorption_depth
    gem.absorption_color = (1.5, 0.5, 0.5)
    assert "negative absorption" in gem.refusal and tuple(gem.absorption_color) == tint
    gem.absorption_depth = -0.01
    assert "above 0" in gem.refusal and gem.absorption_depth == depth
    sample = gem.absorption_curve[100]
    value = sample.absorption
    sample.absorption = -2.0
    assert "cannot be negative" in gem.refusal and sample.absorption == value
    assert gem.species == "RUBY"


def test_an_empty_curve_is_refused_and_the_color_stays(gem):
    gem.absorption_curve.clear()
    gem.absorption_source = "CURVE"
    assert "empty" in gem.refusal and gem.absorption_source == "COLOR"


def test_a_species_keeps_its_bands_when_its_index_is_edited(gem, tmp_path):
    """Custom from then on, and the ruby's absorption stays to the digit."""
    from opal_kernels.optics import species

    materials = stage.addon("translate.materials")
    gem.species = "RUBY"
    gem.sellmeier_b[0] = 1.5
    assert gem.species == "CUSTOM" and gem.absorption_source == "CURVE"
    _, sigma = materials.gem_spectra(gem)
    assert sigma == pytest.approx(species.absorption("RUBY", np.arange(360.0, 831.0)), rel=1e-5, abs=1e-3)


def test_a_driven_color_tints_a_stone_of_a_species(gem, tmp_path):
    """Drivers and keyframes write without the callbacks of an edit; the picture follows them all the same."""
    gem.species = "SAPPHIRE_COLORLESS"
    materials, presets = stage.addon("translate.materials"), stage.addon("presets")
    material = gem.id_data
    for channel, value in enumerate((0.8, 0.3, 0.5)):
        driver = gem.driver_add("absorption_color", channel).driver
        driver.expression = str(value)
    gem.keyframe_insert("absorption_depth")
    action = material.animation_data.action
    curves = action.fcurves if hasattr(action, "fcurves") else action.layers[0].strips[0].channelbags[0].fcurves
    curves[0].keyframe_points[0].co[1] = 0.001
    plate(material)
    stage.render(tmp_path)
    evaluated = material.evaluated_get(bpy.context.evaluated_depsgraph_get()).opal.gem
    assert evaluated.species == "SAPPHIRE_COLORLESS" and presets.species_of(evaluated) == "CUSTOM"
    settings = presets.settings_of(evaluated)
    assert settings.absorption_color == pytest.approx((0.8, 0.3, 0.5)) and settings.absorption_depth == pytest.approx(0.001)
    index, sigma = materials.gem_spectra(evaluated)
    assert sigma.max() > 500 and index == pytest.approx(materials.gem_spectra(gem)[0], abs=2e-4)
    assert presets.read_out(evaluated).n_d == pytest.approx(1.768, abs=2e-3)


def test_a_driven_number_counts_before_the_species_own(gem):
    """An index driven away from ruby's keeps ruby's bands; a color driven away takes their place; the same values change nothing."""
    from opal_kernels.optics import species

    materials, presets = stage.addon("translate.materials"), stage.addon("presets")
    bands = species.absorption("RUBY", np.arange(360.0, 831.0))
    gem.species = "RUBY"
    gem["absorption_depth"] = gem.absorption_depth
    assert presets.species_of(gem) == "RUBY"
    gem["cauchy_b"] = 1.5
    assert presets.species_of(gem) == "CUSTOM" and materials.gem_spectra(gem)[1] == pytest.approx(bands, rel=1e-5, abs=1e-3)
    gem.species = "RUBY"
    gem["absorption_color"] = (0.5, 0.5, 0.5)
    _, grey = materials.gem_spectra(gem)
    assert np.ptp(grey) < 0.05 * grey.mean()
    gem.species = "RUBY"
    gem["absorption_source"] = 0
    assert presets.settings_of(gem).absorption_curve is None and presets.species_of(gem) == "CUSTOM"


def test_an_imported_curve_with_further_columns_says_so(gem, tmp_path, capfd):
    import_curve(tmp_path, gem.id_data, "nm;1/mm;1/mm\n400;0,5;1\n500;0,25;1\n")
    assert "a further column is ignored" in capfd.readouterr().out
    assert [s.absorption for s in gem.absorption_curve] == [0.5, 0.25]


def test_the_charts_of_a_panel_follow_the_numbers(gem):
    presets = stage.addon("presets")
    gem.species = "SF11"
    first = presets.index_chart(gem)
    gem.sellmeier_b[0] = 1.8
    second = presets.index_chart(gem)
    assert second.values[100] > first.values[100] and first.caption != second.caption
    assert presets.absorption_chart(gem) is None
    gem.species = "EMERALD"
    assert presets.absorption_chart(gem).high > 0
