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


def groups():
    """Every group of settings by the data path to it."""
    world, camera = bpy.data.worlds.new("Any"), bpy.data.cameras.new("Any")
    light, material = bpy.data.lights.new("Any", "POINT"), bpy.data.materials.new("Any")
    return {
        "scene": bpy.context.scene.opal,
        "view_layer": bpy.context.view_layer.opal,
        "material": material.opal,
        "gem": material.opal.gem,
        "medium": material.opal.medium,
        "rainbow": material.opal.rainbow,
        "world": world.opal,
        "light": light.opal,
        "camera": camera.opal,
    }


GROUPS = ("scene", "view_layer", "material", "gem", "medium", "rainbow", "world", "light", "camera")
OPERATORS = (
    "add_gem add_rain apply_preset compare_cycles composite gem_report import_absorption import_gemcad merge rainbow_chart render_layers "
    "render_preset_add render_preset_apply render_preset_remove select_reported update_twins"
).split()


def said(prop, inherited=()):
    """Whether a property is Opal's own and shown."""
    return prop.identifier not in {"rna_type", "name", *inherited} and not prop.is_hidden and prop.type != "POINTER"


def is_a_sentence(text, words=3):
    return len(text.split()) >= words and text[0] == text[0].upper() and not text.endswith(".")  # Blender adds the full stop


@pytest.mark.parametrize("group", GROUPS)
def test_every_setting_and_every_choice_says_in_a_sentence_what_it_does(group):
    rna = groups()[group].bl_rna
    unsaid = [p.identifier for p in rna.properties if said(p) and not (is_a_sentence(p.description) and len(p.description) >= 20)]
    unsaid += [
        f"{p.identifier}: {item.identifier}"
        for p in rna.properties
        if said(p) and p.type == "ENUM"
        for item in p.enum_items
        if not is_a_sentence(item.description)
    ]
    assert not unsaid


@pytest.mark.parametrize("group", GROUPS)
def test_every_choice_has_a_number_that_a_keyframe_can_hold(group):
    enums = [p for p in groups()[group].bl_rna.properties if p.type == "ENUM" and not p.is_enum_flag]
    too_large = [f"{p.identifier}: {item.identifier}" for p in enums for item in p.enum_items if not 0 <= item.value < 2**23]
    assert not too_large


def test_these_are_opals_operators():
    assert sorted(dir(bpy.ops.opal)) == sorted(OPERATORS)


@pytest.mark.parametrize("name", OPERATORS)
def test_every_operator_and_its_choices_say_in_a_sentence_what_they_do(name):
    rna = getattr(bpy.ops.opal, name).get_rna_type()
    assert is_a_sentence(rna.description, 5) and rna.name[0].isupper()
    # What Blender's own helpers bring along: the file browser and the alignment of added objects.
    inherited = {"filepath", "filter_glob", "files", "directory", "align", "location", "rotation"}
    unsaid = [p.identifier for p in rna.properties if said(p, inherited) and not is_a_sentence(p.description, 2)]
    unsaid += [
        f"{p.identifier}: {item.identifier}"
        for p in rna.properties
        if said(p, inherited) and p.type == "ENUM"
        for item in p.enum_items
        if not is_a_sentence(item.description, 2)
    ]
    assert not unsaid


class Recorded:
    """A layout that notes which operators are drawn into it."""

    def __init__(self, drawn):
        self.drawn = drawn

    def operator(self, name, **_options):
        self.drawn.add(name)
        return type("Options", (), {})()

    def menu(self, name, **_options):
        getattr(bpy.types, name).draw(type("Menu", (), {"layout": self})(), bpy.context)

    def column(self):
        return self

    def separator(self):
        pass


def test_what_a_person_calls_stands_in_a_menu_where_search_finds_it():
    """Blender's search (F3) goes through menus; buttons of panels alone are those that act on a row or a preset."""
    drawn = set()
    menus = "VIEW3D_MT_mesh_add VIEW3D_MT_volume_add VIEW3D_MT_object TOPBAR_MT_file_import TOPBAR_MT_render".split()
    for menu in menus:
        for draw in getattr(bpy.types, menu)._dyn_ui_initialize():
            if draw.__module__.startswith("bl_ext.user_default.opal"):
                draw(type("Menu", (), {"layout": Recorded(drawn)})(), bpy.context)
    of_panels = {"apply_preset", "render_preset_add", "render_preset_apply", "render_preset_remove", "select_reported"}
    assert drawn == {f"opal.{name}" for name in set(OPERATORS) - of_panels}


def test_sub_panels_are_closed_and_sampling_comes_first():
    panels = [getattr(bpy.types, name) for name in dir(bpy.types) if name.startswith("OPAL_") and "_PT_" in name]
    panels = [p for p in panels if p.bl_region_type == "WINDOW" and "INSTANCED" not in getattr(p, "bl_options", ())]
    open_ones = [p.__name__ for p in panels if getattr(p, "bl_parent_id", "") and "DEFAULT_CLOSED" not in p.bl_options]
    assert not open_ones
    assert [c.__name__ for c in stage.addon("panels").CLASSES][0] == "OPAL_RENDER_PT_sampling"
    assert "OPAL" not in bpy.types.RENDER_PT_simplify.COMPAT_ENGINES, "Blender's own stands above every engine's: Opal has one"


@pytest.mark.parametrize(
    "group, name, values",
    [
        ("scene", "film_exposure", (0.5, 2.0)),
        ("scene", "max_depth", (2, 40)),
        ("scene", "volume_estimate", ("POINTS", "BEAMS")),
        ("gem", "roughness", (0.0, 0.5)),
        ("gem", "absorption_depth", (0.001, 0.02)),
        ("gem", "cauchy_b", (1.5, 2.0)),
        ("medium", "extinction", (0.1, 3.0)),
        ("medium", "anisotropy", (-0.5, 0.5)),
        ("rainbow", "radius", (0.1, 1.0)),
        ("rainbow", "flattening", (0.0, 1.0)),
        ("world", "scale_height", (0.0, 500.0)),
        ("light", "temperature", (2000.0, 6000.0)),
        ("camera", "polarizer_angle", (0.0, 1.5)),
    ],
)
def test_settings_are_keyed_and_frames_show_what_was_keyed(group, name, values):
    owner = groups()[group]
    for frame, value in zip((1, 11), values, strict=True):
        setattr(owner, name, value)
        assert owner.keyframe_insert(name, frame=frame)
    for frame, value in zip((1, 11), values, strict=True):
        bpy.context.scene.frame_set(frame)
        if group == "scene":
            assert getattr(owner, name) == (value if isinstance(value, str) else pytest.approx(value))
        else:
            assert _curves(owner.id_data)[name].evaluate(frame) == pytest.approx(value)


def _curves(block):
    """Curves of a block's animated settings by name."""
    action = block.animation_data.action
    curves = getattr(action, "fcurves", None)
    if curves is None:  # since Blender 5 curves lie in layers
        curves = [c for layer in action.layers for strip in layer.strips for bag in strip.channelbags for c in bag.fcurves]
    return {curve.data_path.rpartition(".")[2]: curve for curve in curves}


def test_everything_but_file_names_can_be_animated():
    still = {
        f"{group}.{prop.identifier}"
        for group, owner in groups().items()
        for prop in owner.bl_rna.properties
        if said(prop) and prop.type in {"FLOAT", "INT", "BOOLEAN", "ENUM"} and not prop.is_animatable
    }
    assert not still


def test_a_driver_reaches_the_render(tmp_path):
    """The exposure follows the camera's lens: what is rendered is what was driven."""
    scene = stage.scene()
    camera = stage.camera((0, 0, 5), lens=50)
    stage.plane(size=20, material=stage.glowing(strength=1.0))
    curve = scene.opal.driver_add("film_exposure")
    variable = curve.driver.variables.new()
    variable.name, variable.type = "lens", "SINGLE_PROP"
    variable.targets[0].id_type, variable.targets[0].id, variable.targets[0].data_path = "CAMERA", camera.data, "lens"
    curve.driver.expression = "lens / 25"
    bpy.context.view_layer.update()
    assert stage.render(tmp_path)[..., :3].mean() == pytest.approx(2.0, rel=0.01)


# ---- Undo ----


def undone(operator, **settings):
    """Runs an operator as a person does, with a step of undo after it, and undoes that step."""
    bpy.ops.ed.undo_push(message="before")
    assert operator("EXEC_DEFAULT", True, **settings) == {"FINISHED"}
    done = names()
    bpy.ops.ed.undo()
    return done, names()


def names():
    return {
        kind: sorted(block.name for block in getattr(bpy.data, kind))
        for kind in ("objects", "meshes", "materials", "images", "texts", "node_groups")
    }


def test_adding_a_stone_and_rain_is_undone():
    before = names()
    for operator in (bpy.ops.opal.add_gem, bpy.ops.opal.add_rain):
        done, after = undone(operator)
        assert done["objects"] and done["materials"] and after == before


def test_layers_a_comparison_and_a_composite_are_undone():
    stage.scene(width=8, height=6, passes=1, samples=1)
    stage.camera((0, 0, 5))
    stage.plane(size=20, material=stage.glowing())
    before = names()
    for operator in (bpy.ops.opal.render_layers, bpy.ops.opal.compare_cycles, bpy.ops.opal.composite):
        done, after = undone(operator)
        assert done["images"] != before["images"] and after["images"] == before["images"]
        assert after["node_groups"] == before["node_groups"]
        assert bpy.context.scene.render.engine == "OPAL" and bpy.context.scene.get("opal_comparison") is None


def test_a_species_that_was_chosen_is_undone_with_its_numbers_and_its_twin():
    material = bpy.data.materials.new("Stone")
    material.use_fake_user = True
    material.opal.kind = "GEM"
    bpy.ops.ed.undo_push(message="diamond")
    before = tuple(material.opal.gem.sellmeier_b), material.opal.gem.species
    material.opal.gem.species = "RUBY"
    bpy.ops.ed.undo_push(message="ruby")
    bpy.ops.ed.undo()
    gem = bpy.data.materials["Stone"].opal.gem
    assert (tuple(gem.sellmeier_b), gem.species) == before


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


@pytest.mark.parametrize(
    "name, value, sentence",
    [
        ("cauchy_b", 0.5, "has to be 1 or more"),
        ("cauchy_b", math.nan, "has no value"),
        ("cauchy_b", math.inf, "10 is the most"),
        ("cauchy_c", 1e9, "10 is the most"),
    ],
)
def test_numbers_of_the_formula_that_is_not_shown_are_refused_as_well(name, value, sentence, gem):
    """Else the other formula could not be chosen afterwards, and its panel hides the number that is in the way."""
    gem.species = "RUBY"
    before = gem.cauchy_b, gem.cauchy_c
    setattr(gem, name, value)
    assert sentence in gem.refusal and (gem.cauchy_b, gem.cauchy_c) == before and gem.species == "RUBY"
    gem.dispersion = "CAUCHY"
    assert (gem.refusal, gem.dispersion, gem.species) == ("", "CAUCHY", "CUSTOM")
    setattr(gem, name, value)
    assert sentence in gem.refusal and (gem.cauchy_b, gem.cauchy_c) == before


def test_species_are_saved_by_name_not_by_their_place_in_the_table(gem):
    """And by numbers that a keyframe, of single precision and rounded, can hold, each distinct from those of files of layout 1."""
    presets = stage.addon("presets")
    numbers = [item[3] for item in presets.species_items()]
    assert len(set(numbers)) == len(numbers) and min(numbers) == 0 and max(numbers) < 2**23
    old = [item[3] for item in presets._items_of_31_bits]
    assert len({*numbers, *old}) == 2 * len(numbers) - 1, "Custom alone is 0 in both"
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
