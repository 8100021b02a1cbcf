# SPDX-License-Identifier: GPL-3.0-or-later
"""The public names, and the gem panel's promises: choosing fills, editing makes Custom, nonsense is refused with a sentence."""

import math

import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")

SCENE_NAMES = [
    "passes",
    "samples_per_pass",
    "use_adaptive_sampling",
    "photons_per_pass",
    "photons_carry",
    "gather",
    "radius",
    "radius_shrink",
    "volume_estimate",
    "march_steps",
    "march_tolerance",
    "max_depth",
    "wavelengths",
    "denoise",
    "seed",
    "time_limit",
    "noise_threshold",
]
GEM_NAMES = [
    "species",
    "dispersion",
    "cauchy_b",
    "cauchy_c",
    "sellmeier_b",
    "sellmeier_c",
    "fresnel",
    "absorption_color",
    "absorption_depth",
    "roughness",
]


@pytest.fixture
def gem():
    material = bpy.data.materials.new("Stone")
    material.opal.kind = "GEM"
    return material.opal.gem


def test_public_names_exist():
    assert set(SCENE_NAMES) <= set(bpy.context.scene.opal.bl_rna.properties.keys())
    material = bpy.data.materials.new("Any")
    assert material.opal.kind == "SURFACE"
    assert set(GEM_NAMES) <= set(material.opal.gem.bl_rna.properties.keys())


@pytest.mark.parametrize("group", ["scene", "view_layer", "material", "gem"])
def test_every_setting_says_in_a_sentence_what_it_does(group):
    material = bpy.data.materials.new("Any")
    owner = {
        "scene": bpy.context.scene.opal,
        "view_layer": bpy.context.view_layer.opal,
        "material": material.opal,
        "gem": material.opal.gem,
    }[group]
    for prop in owner.bl_rna.properties:
        if prop.identifier in {"rna_type", "name"} or prop.is_hidden or prop.type == "POINTER":
            continue
        assert len(prop.description) >= 20 and prop.description[0].isupper(), prop.identifier
        assert not prop.description.endswith("."), "Blender adds the full stop"


def test_lengths_and_times_have_blenders_units():
    properties = bpy.context.scene.opal.bl_rna.properties
    assert properties["radius"].unit == "LENGTH"
    assert properties["time_limit"].unit == "TIME_ABSOLUTE"
    gem = bpy.data.materials.new("Any").opal.gem.bl_rna.properties
    assert gem["absorption_depth"].unit == "LENGTH"


def test_a_new_gem_is_a_diamond(gem):
    assert gem.species == "DIAMOND"
    assert stage.addon("presets").read_out(gem).n_d == pytest.approx(2.41726, abs=2e-5)


def every_species():
    from opal_kernels.optics import species

    return sorted(species.table())


@pytest.mark.parametrize("species", every_species())
def test_choosing_a_species_fills_numbers_that_give_its_index(species, gem):
    from opal_kernels import gem as gems

    gem.species = species
    presets = stage.addon("presets")
    exact, shown = presets.read_out(gem), gems.read_out(presets.settings_of(gem))
    assert gem.species == species and not gem.refusal
    assert shown.n_d == pytest.approx(exact.n_d, abs=2e-4)
    assert shown.b_to_g == pytest.approx(exact.b_to_g, abs=5e-4)


def test_read_outs_match_the_handbook(gem):
    gem.species = "BK7"
    numbers = stage.addon("presets").read_out(gem)
    assert numbers.n_d == pytest.approx(1.51673, abs=2e-5)
    assert numbers.abbe == pytest.approx(64.17, abs=0.05)
    assert math.degrees(numbers.critical_angle) == pytest.approx(41.248, abs=0.01)


@pytest.mark.parametrize("name, value", [("cauchy_c", 0.02), ("absorption_color", (0.2, 0.3, 0.4)), ("sellmeier_b", (4.0, 0.3, 0.1))])
def test_editing_a_number_makes_the_species_custom_and_keeps_the_rest(name, value, gem):
    gem.species = "RUBY"
    before = {key: getattr(gem, key) for key in ("cauchy_b", "absorption_depth", "dispersion")}
    kept = tuple(gem.sellmeier_c)
    setattr(gem, name, value)
    assert gem.species == "CUSTOM"
    assert {key: getattr(gem, key) for key in before} == before and tuple(gem.sellmeier_c) == kept


def test_roughness_and_fresnel_are_not_the_species(gem):
    gem.species = "RUBY"
    gem.roughness, gem.fresnel = 0.3, "SCHLICK"
    assert gem.species == "RUBY"


@pytest.mark.parametrize(
    "edit, sentence",
    [
        (lambda gem: setattr(gem, "sellmeier_b", (-50, 0, 0)), "has no value"),
        (lambda gem: gem.sellmeier_b.__setitem__(0, -50), "has no value"),
        (lambda gem: setattr(gem, "sellmeier_b", (-0.3, 0, 0)), "has to be 1 or more"),
        (lambda gem: setattr(gem, "sellmeier_b", (500, 0, 0)), "10 is the most"),
    ],
)
def test_an_impossible_index_is_refused_with_a_sentence_and_the_last_good_one_kept(edit, sentence, gem):
    gem.species = "BK7"
    before = tuple(gem.sellmeier_b)
    edit(gem)
    assert sentence in gem.refusal
    assert tuple(gem.sellmeier_b) == before
    assert gem.species == "BK7"
    gem.sellmeier_b[0] = 1.1
    assert gem.refusal == "" and gem.species == "CUSTOM"


def test_species_are_saved_by_name_not_by_their_place_in_the_table(gem):
    presets = stage.addon("presets")
    numbers = [item[3] for item in presets.species_items()]
    assert len(set(numbers)) == len(numbers)
    gem.species = "EMERALD"
    assert gem.get("species", presets.species_number("EMERALD")) == presets.species_number("EMERALD")


def test_blenders_own_panels_join_and_opals_survive_a_second_enabling():
    blender_panels, panels = stage.addon("blender_panels"), stage.addon("panels")
    assert "OPAL" in bpy.types.DATA_PT_camera_dof.COMPAT_ENGINES
    assert "OPAL" not in bpy.types.RENDER_PT_freestyle.COMPAT_ENGINES
    blender_panels.unregister()
    try:
        assert "OPAL" not in bpy.types.DATA_PT_camera_dof.COMPAT_ENGINES
        assert panels.OpalPanel.COMPAT_ENGINES == {"OPAL"}
    finally:
        blender_panels.register()
