# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal's layers over a Cycles render make the picture that Opal renders alone."""

import layer_stage
import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def both(**settings):
    """The composite, and Opal's own picture: of the same seed, so that the noise of gems and fog is in both and cancels."""
    assert bpy.ops.opal.composite(**settings) == {"FINISHED"}
    composite = layer_stage.pixels("Opal Composite")
    assert bpy.ops.opal.render_layers(layers={"FULL"}) == {"FINISHED"}
    return composite, layer_stage.pixels("Opal Full Picture")


@pytest.mark.parametrize("attenuation", ["LAYER", "BASE"])
def test_the_composite_is_the_full_render_within_noise(attenuation):
    """Means over sixteenths of the picture, of which what Cycles and Opal each make of the base is the noise: some 0.2 %."""
    layer_stage.build(passes=12)
    composite, full = both(attenuation=attenuation)
    ratio = layer_stage.blocks(composite)[..., :3] / layer_stage.blocks(full)[..., :3]
    np.testing.assert_allclose(ratio, 1.0, atol=0.008, err_msg=str(np.round(ratio[..., 1], 3)))
    assert composite[..., :3].mean() == pytest.approx(full[..., :3].mean(), rel=0.004)
    np.testing.assert_allclose(composite[..., 3], 1.0, atol=0.1)


def test_volumes_of_nodes_stay_cycles_own_and_the_picture_is_whole():
    """Smoke made with nodes scatters in the base as it does in Opal, beside a gem and fog that Opal renders."""
    layer_stage.build(passes=12)
    smoke = stage.node_material("Smoke", "VolumeScatter", Density=0.6)
    tree = smoke.node_tree
    output = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial")
    shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeVolumeScatter")
    for link in list(tree.links):
        tree.links.remove(link)
    tree.links.new(shader.outputs[0], output.inputs["Volume"])
    layer_stage.cube("Smoke", smoke, (-2.5, -1.5, 0.3), (-1.2, -0.3, 1.2))
    composite, full = both()
    ratio = layer_stage.blocks(composite)[..., :3] / layer_stage.blocks(full)[..., :3]
    np.testing.assert_allclose(ratio, 1.0, atol=0.02, err_msg=str(np.round(ratio[..., 1], 3)))


@pytest.mark.parametrize("kind", ["MEDIUM", "RAINBOW"])
def test_under_haze_or_rain_to_the_horizon_the_composite_is_the_full_render(kind):
    """By rows, from the ground before the camera over the horizon, where hardly a path comes through, to the sky. The sky is
    dim beside the sun: of its light on the ground Cycles itself lets 4 % too much through such a world (docs/composite.md). Cycles of
    Blender 4.5 lets all of the sun through, so that there only what stands before the sky is compared."""
    scene = stage.scene(10, 12, passes=12, samples=8)
    scene.cycles.samples, scene.cycles.device, scene.cycles.seed = 48, "CPU", 3
    stage.plane("Ground", size=20_000, material=stage.matte(color=(0.5, 0.4, 0.3)))
    world = stage.world((0.5, 0.7, 1.0), strength=0.02)
    world.opal.kind, world.opal.scale_height = kind, 400
    world.opal.medium.extinction = world.opal.rainbow.extinction = 5e-4
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle = 3.0, 0.009
    stage.link("Sun", sun).rotation_euler = (0.9, 0, 0.3)
    stage.camera((0, 0, 10), (1.6, 0, 0), clip_end=1e5)
    composite, full = both()
    rows = composite[..., :3].mean(1) / full[..., :3].mean(1)
    if bpy.app.version < (5, 0):
        rows = rows[6:]
    np.testing.assert_allclose(rows, 1.0, atol=0.025, err_msg=str(np.round(rows[:, 1], 3)))
    through = layer_stage.pixels("Opal Transmittance")[..., 1].mean(1)
    assert through.min() < 0.1 and through.max() > 0.9, through


def test_with_a_transparent_film_alpha_is_the_full_renders():
    scene = layer_stage.build(passes=8)
    scene.render.film_transparent = True
    composite, full = both(samples=32)
    np.testing.assert_allclose(layer_stage.blocks(composite)[..., 3], layer_stage.blocks(full)[..., 3], atol=0.01)
    assert full[-1, 0, 3] == composite[-1, 0, 3] == 0


def test_an_object_that_cuts_the_film_cuts_both():
    scene = layer_stage.build(passes=4)
    scene.render.film_transparent = True
    bpy.data.objects["Cube"].is_holdout = True
    composite, full = both(samples=32)
    np.testing.assert_allclose(layer_stage.blocks(composite, 8)[..., 3], layer_stage.blocks(full, 8)[..., 3], atol=0.02)


def test_nothing_of_the_scene_is_changed_by_it():
    scene = layer_stage.build(passes=1)
    materials = list(bpy.data.materials)
    before = [[(node.name, node.bl_idname, getattr(node, "is_active_output", None)) for node in m.node_tree.nodes] for m in materials]
    settings = (scene.render.engine, scene.render.filepath, scene.cycles.caustics_reflective, scene.cycles.max_bounces)
    assert bpy.ops.opal.composite(samples=1, use_nodes=False) == {"FINISHED"}
    after = [[(node.name, node.bl_idname, getattr(node, "is_active_output", None)) for node in m.node_tree.nodes] for m in materials]
    assert after == before
    assert (scene.render.engine, scene.render.filepath, scene.cycles.caustics_reflective, scene.cycles.max_bounces) == settings


def test_the_compositors_nodes_give_the_same_picture(tmp_path):
    scene = layer_stage.build(passes=2)
    assert bpy.ops.opal.composite(samples=4, show_in_compositor=True) == {"FINISHED"}
    group = bpy.data.node_groups["Opal Composite"]
    assert {"Attenuation", "Caustics Exposure", "Gems Exposure", "Media Exposure"} <= {node.name for node in group.nodes}
    expected = layer_stage.pixels("Opal Composite")
    scene.opal.passes = scene.opal.samples_per_pass = 1
    scene.opal.photons_per_pass = 0
    np.testing.assert_allclose(rendered(scene, tmp_path), expected, atol=2e-3, rtol=2e-3)
    group.nodes["Media Exposure"].inputs["Exposure"].default_value = 1.0
    twice = expected + layer_stage.pixels("Opal Media") * (1, 1, 1, 0)
    np.testing.assert_allclose(rendered(scene, tmp_path), twice, atol=2e-3, rtol=2e-3)


def rendered(scene, folder):
    """What the compositor makes of the scene."""
    scene.render.use_compositing = True
    image_settings = scene.render.image_settings
    if hasattr(image_settings, "media_type"):
        image_settings.media_type = "IMAGE"
    image_settings.file_format, image_settings.color_mode, image_settings.color_depth = "OPEN_EXR", "RGBA", "32"
    scene.render.filepath = str(folder / "composited.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath, check_existing=False)
    image.name = "Composited"
    try:
        return layer_stage.pixels("Composited")
    finally:
        bpy.data.images.remove(image)


def test_an_artists_compositor_is_left_alone():
    scene = layer_stage.build(passes=1, width=8, height=6)
    if bpy.app.version >= (5, 0, 0):
        own = scene.compositing_node_group = bpy.data.node_groups.new("Mine", "CompositorNodeTree")
        bpy.ops.opal.composite(samples=1, show_in_compositor=True)
        assert scene.compositing_node_group == own
    else:
        scene.use_nodes = True
        blur = scene.node_tree.nodes.new("CompositorNodeBlur")
        output = next(n for n in scene.node_tree.nodes if n.bl_idname == "CompositorNodeComposite")
        scene.node_tree.links.new(blur.outputs[0], output.inputs[0])
        bpy.ops.opal.composite(samples=1, show_in_compositor=True)
        assert output.inputs[0].links[0].from_node == blur
    assert "Opal Composite" in bpy.data.node_groups


def test_a_render_after_a_composite_is_that_render(tmp_path):
    """Unless the artist asks for it the still is not what later renders show."""
    scene = layer_stage.build(passes=1, width=8, height=6)
    before = rendered(scene, tmp_path)
    assert bpy.ops.opal.composite(samples=1) == {"FINISHED"}
    np.testing.assert_array_equal(rendered(scene, tmp_path), before)
    bpy.data.lights["Lamp"].energy *= 3
    assert rendered(scene, tmp_path)[..., :3].mean() > 1.5 * before[..., :3].mean()
    assert bpy.data.node_groups["Opal Composite"].use_fake_user, "kept with the file though nothing uses it"


def test_each_scene_has_pictures_and_nodes_of_its_own():
    first = layer_stage.build(passes=1, width=8, height=6)
    assert bpy.ops.opal.composite(samples=1) == {"FINISHED"}
    kept = layer_stage.pixels("Opal Composite")
    bpy.ops.scene.new(type="LINK_COPY")
    second = bpy.context.scene
    second.render.resolution_x = 10
    for _ in range(2):
        assert bpy.ops.opal.composite(samples=1) == {"FINISHED"}
    np.testing.assert_array_equal(layer_stage.pixels("Opal Composite"), kept)
    of_second = f" ({second.name})"
    assert tuple(bpy.data.images["Opal Base" + of_second].size) == (10, 6)
    groups = {tree.name for tree in bpy.data.node_groups if tree.bl_idname == "CompositorNodeTree" and tree.name.startswith("Opal")}
    assert groups == {"Opal Composite", "Opal Composite" + of_second}
    used = {node.image.name for node in bpy.data.node_groups["Opal Composite" + of_second].nodes if node.bl_idname == "CompositorNodeImage"}
    assert used and all(name.endswith(of_second) for name in used), used
    # What a scene leaves behind is the next one's.
    count = len(bpy.data.images)
    bpy.data.scenes.remove(first)
    assert bpy.ops.opal.composite(samples=1) == {"FINISHED"}
    assert len(bpy.data.images) == count and tuple(bpy.data.images["Opal Base"].size) == (8, 6)


def test_layers_are_written_as_a_multilayer_file(tmp_path):
    layer_stage.build(passes=1, width=16, height=12)
    path = tmp_path / "new folder" / "layers_####.exr"
    assert bpy.ops.opal.render_layers(use_file=True, filepath=str(path)) == {"FINISHED"}
    (written,) = stage.read_layers(path.with_name("layers_0001.exr")).values()
    assert set(written) == {"Caustics", "Gems", "Media", "Rainbow", "Transmittance"}
    np.testing.assert_allclose(written["Gems"], layer_stage.pixels("Opal Gems"), rtol=1e-6)


def test_a_file_that_cannot_be_written_is_a_sentence(tmp_path):
    layer_stage.build(passes=1, width=8, height=6)
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    with pytest.raises(RuntimeError, match="cannot be written"):
        bpy.ops.opal.render_layers(use_file=True, filepath=str(blocked / "layers.exr"))
    with pytest.raises(RuntimeError, match="Save the file first"):
        bpy.ops.opal.render_layers(use_file=True)


def test_a_strangers_image_of_the_same_name_is_left_alone():
    layer_stage.build(passes=1, width=8, height=6)
    mine = bpy.data.images.new("Opal Gems", 3, 3)
    for _ in range(2):
        assert bpy.ops.opal.render_layers(layers={"GEMS"}) == {"FINISHED"}
    assert tuple(mine.size) == (3, 3)
    made = [image for image in bpy.data.images if image.get("opal_picture")]
    assert len(made) == 1 and tuple(made[0].size) == (8, 6)


def test_the_chosen_view_layer_of_the_chosen_scene_is_rendered():
    scene = layer_stage.build(passes=1, width=8, height=6)
    scene.view_layers.new("Second").use = False
    other = bpy.data.scenes.new("Other")
    assert bpy.ops.opal.render_layers(layers={"FULL"}) == {"FINISHED"}
    assert [layer.use for layer in scene.view_layers] == [True, False]
    with bpy.context.temp_override(scene=other, view_layer=other.view_layers[0]):
        with pytest.raises(RuntimeError, match="camera"):
            bpy.ops.opal.render_layers(layers={"FULL"})
    assert scene.view_layers[0].use


def test_a_gpu_that_is_not_there_gives_way_to_the_processor():
    scene = layer_stage.build(passes=1, width=8, height=6)
    scene.cycles.device = "GPU"
    assert bpy.ops.opal.composite(samples=1) == {"FINISHED"}
    assert scene.cycles.device == "GPU"
