# SPDX-License-Identifier: GPL-3.0-or-later
"""Twins follow Opal's settings and leave what an artist made alone."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def material(kind, name="Material"):
    made = bpy.data.materials.new(name)
    made.opal.kind = kind
    return made


def node(material, kind):
    return next(n for n in material.node_tree.nodes if n.bl_idname == kind)


def test_a_gem_is_glass_of_its_index_and_absorption():
    stone = material("GEM")
    stone.opal.gem.species = "DIAMOND"
    glass = node(stone, "ShaderNodeBsdfGlass")
    assert glass.inputs["IOR"].default_value == pytest.approx(2.417, abs=1e-3)
    stone.opal.gem.species = "RUBY"
    assert glass.inputs["IOR"].default_value == pytest.approx(1.768, abs=2e-3)
    absorbed = np.array(node(stone, "ShaderNodeVolumeCoefficients").inputs["Absorption Coefficients"].default_value)
    expected = -np.log(np.maximum(stone.opal.gem.absorption_color, 1e-6)) / stone.opal.gem.absorption_depth
    np.testing.assert_allclose(absorbed, expected, rtol=1e-4)
    stone.opal.gem.roughness = 0.3
    assert glass.inputs["Roughness"].default_value == pytest.approx(0.3)
    assert any(n.bl_idname == "NodeFrame" and "Opal" in n.label for n in stone.node_tree.nodes)


def test_a_mediums_coefficients_are_those_that_opal_renders():
    fog = material("MEDIUM")
    fog.opal.medium.extinction, fog.opal.medium.albedo = 2.0, (0.9, 0.5, 0.1)
    fog.opal.medium.phase, fog.opal.medium.anisotropy = "HENYEY_GREENSTEIN", 0.6
    volume = node(fog, "ShaderNodeVolumeCoefficients")
    np.testing.assert_allclose(volume.inputs["Scatter Coefficients"].default_value, (1.8, 1.0, 0.2), rtol=1e-5)
    np.testing.assert_allclose(volume.inputs["Absorption Coefficients"].default_value, (0.2, 1.0, 1.8), rtol=1e-5)
    assert volume.inputs["Anisotropy"].default_value == pytest.approx(0.6)
    fog.opal.medium.phase = "RAYLEIGH"
    assert volume.phase == "RAYLEIGH"
    for density, kind in (("NOISE", "ShaderNodeTexNoise"), ("GRID", "ShaderNodeAttribute")):
        fog.opal.medium.density = density
        assert node(fog, kind)
    fog.opal.medium.density = "HOMOGENEOUS"
    assert not any(n.bl_idname in {"ShaderNodeTexNoise", "ShaderNodeAttribute"} for n in fog.node_tree.nodes)


def test_rain_scatters_forward_as_drops_do_on_average():
    rain = material("RAINBOW")
    rain.opal.rainbow.extinction = 0.003
    volume = node(rain, "ShaderNodeVolumeCoefficients")
    factor = 2 if rain.opal.rainbow.diffraction else 1
    np.testing.assert_allclose(volume.inputs["Scatter Coefficients"].default_value, (0.003 * factor,) * 3, rtol=1e-5)
    assert 0.7 < volume.inputs["Anisotropy"].default_value < 0.9


def test_the_worlds_volume_follows_and_its_background_stays():
    world = stage.world(color=(0.2, 0.4, 0.6))
    world.opal.kind = "MEDIUM"
    world.opal.medium.extinction = 0.01
    output = world.node_tree.get_output_node("ALL")
    assert output.inputs["Volume"].links[0].from_node.bl_idname == "ShaderNodeVolumeCoefficients"
    assert output.inputs["Surface"].links[0].from_node.bl_idname == "ShaderNodeBackground"


def test_an_edited_tree_is_never_written_over_without_asking():
    stone = material("GEM")
    glass = node(stone, "ShaderNodeBsdfGlass")
    glass.inputs["Roughness"].default_value = 0.77
    stone.opal.gem.species = "RUBY"
    assert glass.inputs["IOR"].default_value == pytest.approx(2.417, abs=1e-3), "the artist's now"
    assert bpy.ops.opal.update_twins() == {"FINISHED"}
    assert glass.inputs["Roughness"].default_value == pytest.approx(0.77)
    assert bpy.ops.opal.update_twins(overwrite=True) == {"FINISHED"}
    glass = node(stone, "ShaderNodeBsdfGlass")
    assert glass.inputs["Roughness"].default_value == 0
    assert glass.inputs["IOR"].default_value == pytest.approx(1.768, abs=2e-3)


def test_a_tree_made_by_hand_is_left_alone_when_the_kind_is_chosen():
    mine = stage.matte("Mine", (1, 0, 0))
    mine.opal.kind = "GEM"
    assert {n.bl_idname for n in mine.node_tree.nodes} == {"ShaderNodeBsdfDiffuse", "ShaderNodeOutputMaterial"}


def test_moving_nodes_about_is_no_edit():
    stone = material("GEM")
    for n in stone.node_tree.nodes:
        n.location.x += 300
    stone.opal.gem.species = "RUBY"
    assert node(stone, "ShaderNodeBsdfGlass").inputs["IOR"].default_value == pytest.approx(1.768, abs=2e-3)


def test_twins_survive_saving_and_animated_settings(tmp_path):
    fog = material("MEDIUM", "Fog")
    fog.use_fake_user = True
    for frame, value in ((1, 1.0), (10, 3.0)):
        fog.opal.medium.extinction = value
        fog.opal.medium.keyframe_insert("extinction", frame=frame)
    bpy.context.scene.frame_set(5)
    path = str(tmp_path / "twins.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    fog = bpy.data.materials["Fog"]
    fog.opal.medium.albedo = (0.5, 0.5, 0.5)
    scattering = node(fog, "ShaderNodeVolumeCoefficients").inputs["Scatter Coefficients"].default_value
    np.testing.assert_allclose(scattering, (fog.opal.medium.extinction * 0.5,) * 3, rtol=1e-4)


def test_a_linked_librarys_material_is_left_alone_and_renders(tmp_path):
    stone = material("GEM", "Stone")
    stone.use_fake_user = True
    library = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(library, link=True) as (source, target):
        target.materials = ["Stone"]
    stage.scene(passes=1)
    stage.camera((0, 0, 5))
    stage.world()
    stage.plane(size=2, material=bpy.data.materials["Stone"])
    assert bpy.ops.opal.update_twins(overwrite=True) == {"FINISHED"}
    assert bpy.ops.opal.composite(samples=1, use_nodes=False) == {"FINISHED"}
    assert np.isfinite(stage.render(tmp_path)).all()
