# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene modelled in millimetres, Unit Scale 0.001, is to Opal what the same scene modelled in metres is.

Pictures of one seed differ by the rounding of coordinates alone: in single paths that take another facet, hardly in their mean.
"""

import importlib
import math

import bpy
import numpy as np
import pytest
import stage

UNITS = (1.0, 0.001)  # metres
# By which pixels may differ, of the brightest one: a hundred times what single precision rounds off.
ROUNDING = 1e-5


@pytest.fixture(autouse=True)
def extension(opal):
    """The extension, in an empty file."""


def begin(unit, system="METRIC"):
    """An empty file of units of so many metres, before a white world."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = stage.scene(24, 18, passes=1, samples=16)
    scene.unit_settings.system, scene.unit_settings.scale_length = system, unit
    stage.world()
    return scene


def box(material, half, unit):
    """A closed box of `half` metres to each side, turned towards the camera by a corner, in units."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half / unit
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    made = stage.mesh("Box", corners, faces, material=material)
    made.rotation_euler = (0.5, 0.4, 0.2)
    stage.camera((0, 0, 10 * half / unit), type="ORTHO", ortho_scale=4 * half / unit, clip_start=half / unit, clip_end=100 * half / unit)


def material(kind):
    made = bpy.data.materials.new("Material")
    made.opal.kind = kind
    return made


def ruby(unit):
    stone = material("GEM")
    stone.opal.gem.species = "RUBY"
    box(stone, 0.00325, unit)


def coloured(unit):
    stone = material("GEM")
    stone.opal.gem.absorption_color, stone.opal.gem.absorption_depth = (0.2, 0.5, 0.9), 0.004 / unit
    box(stone, 0.00325, unit)


def measured(unit):
    stone = material("GEM")
    stage.addon("presets").take_curve(stone.opal.gem, [(400.0, 0.05), (700.0, 0.4)])
    box(stone, 0.00325, unit)


def clouded(unit):
    stone = material("GEM")
    stone.opal.use_medium, stone.opal.medium.extinction, stone.opal.medium.albedo = True, 400.0, (0.2, 0.5, 0.9)
    box(stone, 0.00325, unit)


def milk(unit):
    body = material("MEDIUM")
    medium = body.opal.medium
    medium.extinction, medium.albedo, medium.emission_strength, medium.emission_color = 20.0, (0.5, 0.7, 0.9), 4.0, (1.0, 0.4, 0.1)
    box(body, 0.05, unit)
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy = 0.05 / unit**2  # W, which by the unit, as in Cycles, light what is so much larger
    lamp.shadow_soft_size = 0.01 / unit
    stage.link("Lamp", lamp, (0.0, 0.1 / unit, 0.1 / unit))


def shower(unit):
    body = material("RAINBOW")
    body.opal.rainbow.theory, body.opal.rainbow.extinction = "DESCARTES_SAMPLED", 10.0
    box(body, 0.05, unit)
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy = 20.0
    stage.link("Sun", sun).rotation_euler = (0.7, 0.0, 0.0)


def haze(unit):
    """The world's, of the height that it begins with."""
    world = bpy.context.scene.world
    world.opal.kind = "MEDIUM"
    world.opal.medium.extinction, world.opal.medium.albedo = 0.002, (0.2, 0.5, 0.9)
    stage.plane(size=20 / unit, material=stage.matte())
    stage.camera((0, 0, 5 / unit), (math.pi / 2 + 0.2, 0, 0), clip_start=0.1 / unit, clip_end=1000 / unit)


SCENES = (ruby, coloured, measured, clouded, milk, shower, haze)


@pytest.mark.parametrize("build", SCENES, ids=lambda build: build.__name__)
def test_a_scene_in_millimetres_looks_as_it_does_in_metres(build, tmp_path):
    pictures, said = [], []
    for unit in UNITS:
        begin(unit)
        build(unit)
        pictures.append(stage.render(tmp_path)[..., :3])
        said.append(stage.problems())
    assert said[0] == said[1]
    metres, millimetres = pictures
    off = np.abs(millimetres - metres).max() / metres.max()
    assert off < ROUNDING, f"{off:.2g} of the brightest pixel"


def test_without_a_system_of_units_a_unit_is_a_metre(tmp_path):
    pictures = []
    for unit, system in ((1.0, "METRIC"), (0.001, "NONE"), (0.001, "IMPERIAL")):
        begin(unit, system)
        ruby(0.001)  # 6.5 units across
        pictures.append(stage.render(tmp_path)[..., :3])
    metres, none, feet = pictures
    np.testing.assert_array_equal(none, metres)
    assert feet[9, 12].mean() > 2 * metres[9, 12].mean(), "a ruby of 6.5 m lets nothing through"


def test_node_trees_are_by_the_unit_as_in_cycles(tmp_path):
    pictures = []
    for unit in UNITS:
        begin(unit)
        fog = stage.node_material("Fog", "VolumeAbsorption", Color=(0.2, 0.5, 0.9, 1), Density=0.3)
        tree = fog.node_tree
        tree.links.new(tree.nodes["Volume Absorption"].outputs[0], tree.nodes["Material Output"].inputs["Volume"])
        tree.links.remove(tree.nodes["Material Output"].inputs["Surface"].links[0])
        box(fog, 1.0, 1.0)
        pictures.append(stage.render(tmp_path)[..., :3])
    assert 0.1 < pictures[0].min() < 0.9
    np.testing.assert_array_equal(*pictures)


def colour_and_depth(gem):
    return *gem.absorption_color, gem.absorption_depth


def test_the_depth_of_a_color_is_a_length_and_the_usual_one_until_it_is_set():
    found = []
    for unit in UNITS:
        begin(unit)
        stone, edited = material("GEM").opal.gem, material("GEM").opal.gem
        stone.species = "RUBY"
        edited.absorption_color = (0.2, 0.5, 0.9)
        assert edited.species == "CUSTOM"
        shown = stage.addon("presets").absorption_chart(edited, unit)
        found.append((*colour_and_depth(stone), *colour_and_depth(edited), shown.high))
        stone.absorption_depth = -1.0
        assert "above 0" in stone.refusal and stone.species == "RUBY"
    metres, millimetres = np.array(found)
    np.testing.assert_allclose(millimetres * [1, 1, 1, 1e-3, 1, 1, 1, 1e-3, 1], metres, rtol=1e-5)
    assert millimetres[3] == pytest.approx(5.0)


def test_a_stone_is_added_and_imported_at_its_real_size_and_weight(tmp_path, capfd):
    path = tmp_path / "cube.asc"
    path.write_text("GemCad 5.0\ng 96 0.0\ny 4 y\nI 1.54\nH A cube\na 90 0.5 96 24 48 72 n G\na 0 0.5 n T\na -0.0 0.5 n C\n")
    told = []
    for unit in UNITS:
        begin(unit)
        for add in (bpy.ops.opal.add_gem, lambda **more: bpy.ops.opal.import_gemcad(filepath=str(path), **more)):
            for size in ({}, {"size": 0.01 / unit}):
                add(species="DIAMOND", **size)
                assert bpy.context.object.dimensions.y * unit == pytest.approx(0.01 if size else 0.0065, rel=1e-5)
        told.append([line for line in capfd.readouterr().out.splitlines() if line.endswith(" ct")])
    assert told[0] == told[1] and len(told[0]) == 4, told
    assert 0.9 < float(told[0][0].split()[-2]) < 1.1, told


def operators(name):
    """A module of the installed extension's ``operators``."""
    return importlib.import_module(f"{stage.addon('units').__package__.rpartition('.')[0]}.operators.{name}")


def test_the_report_of_a_stone_is_on_it_at_its_real_size(monkeypatch):
    judged = []

    class Work:
        def __init__(self, _settings, stone, *_rest):
            judged.append(stone)

        def make(self, _told):
            raise ValueError("enough")

    monkeypatch.setattr(operators("gem_report"), "_Work", Work)
    for unit in UNITS:
        begin(unit)
        bpy.ops.opal.add_gem(cut="BRILLIANT", species="RUBY")
        with pytest.raises(RuntimeError, match="enough"):
            bpy.ops.opal.gem_report()
    metres, millimetres = judged
    np.testing.assert_allclose(millimetres.vertices, metres.vertices, atol=1e-9)
    np.testing.assert_allclose(millimetres.absorption, metres.absorption)
    assert np.ptp(metres.vertices[:, 1]) == pytest.approx(0.0065, rel=1e-5)


def test_rain_is_added_at_its_real_distance_and_catches_the_same_light():
    found = []
    for unit in UNITS:
        begin(unit)
        bpy.ops.opal.add_rain()
        curtain = bpy.context.object
        found.append((*curtain.location * unit, *curtain.dimensions * unit, curtain.active_material.opal.rainbow.extinction))
    assert found[0] == pytest.approx(found[1], rel=1e-5)
    assert found[0][4] == pytest.approx(150.0)
    assert found[0][6] == pytest.approx(-math.log(0.75) / 150.0)


def test_the_world_begins_with_a_real_height_and_rain_without_one_has_that_of_a_cloud():
    found = []
    for unit in UNITS:
        begin(unit)
        world = bpy.context.scene.world
        world.opal.kind = "RAINBOW"
        height = world.opal.scale_height * unit
        world.opal.scale_height = 0.0
        falloff = world.node_tree.nodes["Opal Height"].inputs[1].default_value / unit
        interior = world.node_tree.nodes["Opal Scatter"].inputs[0].default_value[0] / unit
        found.append((height, falloff, interior))
    assert found[0] == pytest.approx(found[1], rel=1e-5)
    assert found[0] == pytest.approx((1000.0, -1e-3, 5e-4))


def coefficients(owner):
    inputs = next(node for node in owner.node_tree.nodes if node.bl_idname == "ShaderNodeVolumeCoefficients").inputs
    names = ("Absorption Coefficients", "Scatter Coefficients", "Emission Coefficients")
    return np.array([inputs[name].default_value for name in names])


def test_twins_are_by_the_unit_and_take_another_unit_when_they_are_updated():
    by_metre = {}
    for build in (ruby, coloured, measured, milk, shower):
        begin(1.0)
        build(1.0)
        owner = bpy.context.scene.objects["Box"].active_material
        by_metre[build] = coefficients(owner)
        begin(0.001)
        build(0.001)
        owner = bpy.context.scene.objects["Box"].active_material
        np.testing.assert_allclose(coefficients(owner), by_metre[build] * 1e-3, rtol=1e-4, err_msg=build.__name__)
        if build is not coloured:  # whose depth is a length, and so another one by another unit
            bpy.context.scene.unit_settings.scale_length = 1.0
            bpy.ops.opal.update_twins()
            np.testing.assert_allclose(coefficients(owner), by_metre[build], rtol=1e-4, err_msg=build.__name__)
    # The curve of 0.05 to 0.4 by the millimetre, as colours see it.
    assert (by_metre[measured][0] > 50).all() and (by_metre[measured][0] < 400).all(), by_metre[measured]


def test_under_opals_layers_cycles_takes_away_by_the_unit():
    scene = begin(0.001)
    milk(0.001)
    owner = scene.objects["Box"].active_material
    with operators("cycles_base").replaced(scene, dim_camera=True):
        taken = owner.node_tree.nodes["Opal base Interior"].inputs["Absorption Coefficients"].default_value[:]
    assert taken == pytest.approx((0.02, 0.02, 0.02))


def test_a_view_follows_another_unit():
    scene = begin(1.0)
    ruby(0.001)
    sync = stage.addon("viewport_sync").SceneSync(threads=2)
    changed = []

    def on_update(_scene, depsgraph):
        changed.append(sync.update(depsgraph))

    try:
        sync.update(bpy.context.evaluated_depsgraph_get())
        bpy.app.handlers.depsgraph_update_post.append(on_update)
        scene.unit_settings.scale_length = 0.001
        bpy.context.view_layer.update()
        assert changed == [True] and sync.rebuilds == 2
        scene.render.film_transparent = True  # tags the scene as well
        bpy.context.view_layer.update()
        assert sync.rebuilds == 2
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(on_update)
        sync.close()


def test_a_preview_shows_a_stone_of_usual_size_whatever_the_unit():
    """Its ball of 2 units stands in a scene of Blender's; the stone's settings are of the scene that is edited."""
    units, materials = stage.addon("units"), stage.addon("translate.materials")
    found = []
    for unit in UNITS:
        begin(unit)
        stones = [material("GEM").opal.gem for _ in range(2)]
        stones[0].species = "RUBY"
        stones[1].absorption_color, stones[1].absorption_depth = (0.2, 0.5, 0.9), 0.004 / unit
        lengths = units.of_preview()
        assert lengths.media == 1.0
        found.append([materials._gem_tables(gem, lengths)[1] for gem in stones])
        real = [materials.gem_spectra(gem, unit)[1] for gem in stones]
        np.testing.assert_allclose(found[-1], np.array(real) * 0.00325, rtol=1e-6)
    np.testing.assert_allclose(found[0], found[1], rtol=1e-5)
