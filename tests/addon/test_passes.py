# SPDX-License-Identifier: GPL-3.0-or-later
"""Render passes, view layers, borders and the film: each pixel is what its name says."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def all_passes():
    layer = bpy.context.view_layer
    for name in ("z", "normal", "position", "emit"):
        setattr(layer, f"use_pass_{name}", True)
    for name in ("albedo", "direct", "indirect", "caustics", "medium"):
        setattr(layer.opal, f"use_pass_{name}", True)


def test_geometry_passes_give_distance_normal_position_and_albedo(tmp_path):
    stage.scene(passes=2)
    stage.camera((0, 0, 5))
    stage.world()
    stage.plane(size=20, location=(0, 0, 1), material=stage.matte(color=(0.8, 0.4, 0.2)))
    all_passes()
    got = stage.render_passes(tmp_path)
    assert set(got) == {"Combined", "Depth", "Normal", "Position", "Emission", "Albedo", "Direct", "Indirect", "Caustics", "Medium"}
    center = (6, 8)
    assert got["Depth"][center] == pytest.approx(4.0, rel=2e-2)
    np.testing.assert_allclose(got["Normal"][center], (0, 0, 1), atol=1e-5)
    assert got["Position"][center][2] == pytest.approx(1.0, abs=1e-4)
    np.testing.assert_allclose(got["Albedo"][center], (0.8, 0.4, 0.2), atol=5e-3)


def test_light_passes_add_up_to_the_picture(tmp_path):
    stage.scene(passes=4, samples=4)
    stage.camera((0, -4, 3), (0.9, 0, 0))
    stage.world(strength=0.5)
    stage.plane(size=20, material=stage.matte())
    stage.plane("Glow", size=1, location=(0, 0, 1), material=stage.glowing(strength=3))
    all_passes()
    got = stage.render_passes(tmp_path)
    parts = sum(got[name] for name in ("Emission", "Direct", "Indirect", "Caustics", "Medium"))
    np.testing.assert_allclose(parts, got["Combined"][..., :3], rtol=1e-4, atol=1e-5)
    assert np.sort(got["Emission"][..., 1].ravel())[-4:].mean() == pytest.approx(3.0, rel=0.05)
    assert got["Direct"].mean() > 10 * got["Caustics"].mean()


def test_what_a_medium_scatters_has_a_pass_of_its_own(tmp_path):
    stage.scene(passes=4, samples=4)
    stage.camera((0, 0, 5))
    stage.world()
    material = stage.matte("Fog")
    material.opal.kind = "MEDIUM"
    material.opal.medium.extinction = 0.5
    bpy.ops.mesh.primitive_cube_add(size=2)
    bpy.context.object.data.materials.append(material)
    all_passes()
    got = stage.render_passes(tmp_path)
    assert got["Medium"][6, 8].mean() > 0.1
    assert not got["Medium"][0, 0].any()
    parts = sum(got[name] for name in ("Emission", "Direct", "Indirect", "Caustics", "Medium"))
    np.testing.assert_allclose(parts, got["Combined"][..., :3], rtol=1e-4, atol=1e-5)


def test_border_renders_the_same_pixels_as_the_whole_frame(tmp_path):
    scene = stage.scene(width=20, height=16)
    stage.camera((0, 0, 5))
    for x, color in ((-1, (1, 0, 0)), (1, (0, 1, 0))):
        stage.plane(f"{x}", size=2, location=(x, 0, 0), material=stage.glowing(f"{x}", color))
    whole = stage.render(tmp_path)
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.25, 1.0
    framed = stage.render(tmp_path)
    assert framed.shape == whole.shape
    np.testing.assert_array_equal(framed[4:16, 5:15], whole[4:16, 5:15])
    assert not framed[:4].any() and not framed[:, :5].any()
    scene.render.use_crop_to_border = True
    cropped = stage.render(tmp_path)
    assert cropped.shape[:2] == (12, 10)
    np.testing.assert_array_equal(cropped, whole[4:16, 5:15])


@pytest.mark.parametrize("percent", [100, 61])
@pytest.mark.parametrize("low, high", [(0.39, 0.58), (0.07, 0.29), (0.11, 0.93)])
def test_a_border_has_the_size_that_blender_gives_it(tmp_path, low, high, percent):
    """Every pixel of the cropped picture is rendered: in double precision 0.58 of 300 pixels would be one less."""
    scene = stage.scene(width=300, height=240, passes=1, samples=1)
    stage.camera()
    stage.world()
    scene.render.resolution_percentage = percent
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_min_x = scene.render.border_min_y = low
    scene.render.border_max_x = scene.render.border_max_y = high
    picture = stage.render(tmp_path)
    frame = stage.addon("settings").frame_of(scene.render)
    assert picture.shape[1::-1] == frame.region_size
    assert (picture[..., :3] > 0).all(), f"{(picture[..., 1] <= 0).sum()} pixels are black"


def test_resolution_percentage_scales_the_frame(tmp_path):
    scene = stage.scene(width=33, height=21)
    stage.camera()
    scene.render.resolution_percentage = 50
    assert stage.render(tmp_path).shape[:2] == (10, 16)


def test_transparent_film_has_alpha_where_something_is_seen(tmp_path):
    scene = stage.scene()
    scene.render.film_transparent = True
    stage.camera((0, 0, 5))
    stage.world()
    stage.plane(size=1, material=stage.matte())
    picture = stage.render(tmp_path)
    assert picture[6, 8, 3] == pytest.approx(1, abs=1e-6)
    np.testing.assert_array_equal(picture[0, 0], (0, 0, 0, 0))


@pytest.mark.parametrize("opacity", [0.1, 0.9])
@pytest.mark.parametrize("kind", ["Principled", "mix", "filter", "holdout behind"])
def test_a_transparent_film_keeps_of_the_sky_what_surfaces_let_through(kind, opacity, tmp_path):
    """Alpha counted paths that passed: a filter of glass was not there, and of a mix there was what the paths' chance of passing said."""
    scene = stage.scene(passes=4, samples=64)
    scene.render.film_transparent = True
    stage.camera((0, 0, 5))
    stage.world()
    passing = 1 - opacity
    if kind == "mix":
        material = stage.node_material("Veil", "BsdfTransparent")
        tree = material.node_tree
        mix, matte = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfDiffuse")
        mix.inputs[0].default_value = opacity
        clear, output = (next(n for n in tree.nodes if n.type == kind) for kind in ("BSDF_TRANSPARENT", "OUTPUT_MATERIAL"))
        tree.links.new(clear.outputs[0], mix.inputs[1])
        tree.links.new(matte.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], output.inputs["Surface"])
    elif kind == "filter":
        material = stage.node_material("Veil", "BsdfTransparent", Color=(passing, passing, passing, 1))
    else:
        material = stage.node_material("Veil", "BsdfPrincipled", Alpha=opacity)
    stage.plane(size=20, material=material)
    if kind == "holdout behind":
        stage.plane("Hole", size=20, location=(0, 0, -1)).is_holdout = True
    # 49,152 paths, each off by half at most
    assert stage.render(tmp_path)[..., 3].mean() == pytest.approx(opacity, abs=0.009)


def test_holdout_cuts_the_film(tmp_path):
    scene = stage.scene()
    scene.render.film_transparent = True
    stage.camera((0, 0, 5))
    stage.world()
    stage.plane(size=20, material=stage.matte())
    stage.plane("Hole", size=1, location=(0, 0, 1)).is_holdout = True
    picture = stage.render(tmp_path)
    assert picture[6, 8, 3] == pytest.approx(0, abs=1e-6)
    assert picture[0, 0, 3] == pytest.approx(1, abs=1e-6)


def test_exposure_is_a_factor_on_the_film(tmp_path):
    scene = stage.scene()
    stage.camera()
    stage.world((0.2, 0.4, 0.6))
    before = stage.render(tmp_path)
    scene.opal.film_exposure = 2.5
    np.testing.assert_allclose(stage.render(tmp_path)[..., :3], 2.5 * before[..., :3], rtol=1e-5)


def test_world_radiance_is_its_colour_times_strength(tmp_path):
    stage.scene(passes=16, samples=16)
    stage.camera()
    stage.world((0.2, 0.4, 0.6), 2.0)
    picture = stage.render(tmp_path)
    np.testing.assert_allclose(picture[..., :3].mean((0, 1)), (0.4, 0.8, 1.2), rtol=3e-3)


def test_each_view_layer_is_rendered_with_its_collections(tmp_path):
    scene = stage.scene()
    stage.camera((0, 0, 5))
    collection = bpy.data.collections.new("Left out")
    scene.collection.children.link(collection)
    card = stage.plane(size=20, material=stage.glowing())
    scene.collection.objects.unlink(card)
    collection.objects.link(card)
    second = scene.view_layers.new("Second")
    second.layer_collection.children["Left out"].exclude = True
    first_picture = stage.render(tmp_path)
    second_picture = stage.read_layers(tmp_path / "render.exr")["Second"]["Combined"]
    assert first_picture[..., :3].mean() == pytest.approx(1.0, rel=0.05)
    assert not second_picture[..., :3].any()


def test_world_override_of_a_view_layer_replaces_the_world(tmp_path):
    layer = bpy.context.view_layer
    if not hasattr(layer, "world_override"):
        pytest.skip("this version of Blender has no world override")
    stage.scene(passes=8, samples=8)
    stage.camera()
    other = stage.world((0.0, 0.0, 1.0))
    stage.world((1.0, 0.0, 0.0))
    layer.world_override = other
    red, _, blue = stage.render(tmp_path)[..., :3].mean((0, 1))
    assert blue > 0.9 and red < 0.1


def test_material_override_of_a_view_layer_replaces_every_material(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.plane(size=20, material=stage.matte())
    bpy.context.view_layer.material_override = stage.glowing(strength=2)
    assert stage.render(tmp_path)[..., :3].mean() == pytest.approx(2.0, rel=0.05)
