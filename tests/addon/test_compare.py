# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison with Cycles: what it measures, shows and writes."""

import json
import types

import layer_stage
import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def result():
    return json.loads(bpy.context.scene["opal_comparison"])


def ordinary(width=48, height=36):
    """A scene without anything that only Opal can render."""
    scene = stage.scene(width, height, passes=8, samples=8)
    stage.plane(size=20, material=stage.matte(color=(0.7, 0.5, 0.3)))
    layer_stage.cube("Cube", stage.matte("Blue", (0.2, 0.4, 0.8)), (-1, -1, 0), (1, 1, 1))
    stage.world(strength=0.5)
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy = 300
    stage.link("Lamp", lamp, (2, -3, 4))
    stage.camera((0, -6, 4), (1.0, 0, 0))
    return scene


def test_a_scene_that_both_engines_render_is_equal_within_noise(tmp_path):
    ordinary()
    assert bpy.ops.opal.compare_cycles(use_file=True, filepath=str(tmp_path / "new" / "compared_####")) == {"FINISHED"}
    got = result()
    np.testing.assert_allclose(got["mean_ratio"], 1.0, atol=0.01)
    assert got["relative_mse"] < 0.02 and got["psnr"] > 25 and got["ssim"] > 0.9
    assert got["samples"] == 64
    assert got["flip"] is not None or "not installed" in got["flip_left_out"]
    assert all(got["seconds"][engine] > 0 and got["memory"][engine] >= 0 for engine in ("opal", "cycles"))
    assert json.loads((tmp_path / "new" / "compared_0001.json").read_text()) == got
    for name, size in (("side_by_side", (98, 36)), ("difference", None)):
        image = bpy.data.images.load(str(tmp_path / "new" / f"compared_0001_{name}.png"))
        assert size is None or tuple(image.size) == size
    sides = layer_stage.pixels("Opal Side by Side")
    np.testing.assert_allclose(sides[:, :48, :3].mean(), sides[:, 50:, :3].mean(), rtol=0.01)


def test_the_panel_shows_opals_picture_and_not_a_strangers_of_that_name():
    import opal_source.operators.own_images as own_images  # the installed extension's

    mine = bpy.data.images.new("Opal Side by Side", 3, 3)
    ordinary(8, 6).opal.passes = 1
    assert bpy.ops.opal.compare_cycles() == {"FINISHED"}
    owner = own_images.owner_of(bpy.context.scene, bpy.context.view_layer)
    found = own_images.own("Opal Side by Side", owner)
    assert found is not None and found != mine and tuple(found.size) == (18, 6)
    drawn = shown_by(bpy.types.OPAL_RENDER_PT_comparison)
    assert any(found.name in text for text in drawn) and not any(f"“{mine.name}”" in text for text in drawn), drawn


class Texts(list):
    """A layout that keeps the words that are put into it."""

    def label(self, text="", **_):
        self.append(text)

    def operator(self, *_, **__):
        return types.SimpleNamespace()

    def template_icon(self, *_, **__):
        pass

    def row(self, **_):
        return self

    box = column = split = row


def shown_by(panel):
    """The words of a panel."""
    texts = Texts()
    panel.draw(types.SimpleNamespace(layout=texts), bpy.context)
    return texts


def test_the_difference_is_red_where_opal_is_brighter_and_blue_where_it_is_darker():
    import opal_source.operators.difference_map as maps  # the installed extension's

    theirs = np.full((40, 80, 4), 0.5)
    ours = theirs.copy()
    ours[:, :40] += 0.2
    ours[:, 40:] -= 0.2
    picture = maps.draw(ours, theirs, 0.2)
    brighter, darker = picture[-1, 10], picture[-1, 70]
    assert brighter[0] > 2 * brighter[2] and darker[2] > 2 * darker[0]
    legend = picture[: picture.shape[0] - 40]
    assert legend.shape[0] > 8 and (legend[..., :3].max(axis=2) == 0).sum() > 20, "numbers in black"


def test_volumes_alone_are_compared_region_by_region():
    """Homogeneous fog by Opal and by Cycles' volume: each of four regions agrees within 4 standard errors and 1 %."""
    scene = layer_stage.build(passes=16, width=48, height=36)
    bpy.data.materials["Fog"].opal.medium.extinction = 1.0
    assert bpy.ops.opal.compare_cycles(mode="VOLUMES", regions=2) == {"FINISHED"}
    got = result()
    assert len(got["regions"]) == 4
    for region in got["regions"]:
        assert region["ratio"] == pytest.approx(1.0, abs=0.01 + 4 * region["error"]), region
    assert not any(obj.hide_render for obj in scene.objects)


def test_equal_time_gives_cycles_what_opal_took():
    """Cycles is told the seconds; how well it keeps to them on a busy machine is its own affair."""
    scene = ordinary(24, 18)
    scene.opal.passes = 64
    told = []

    def note(scene, _depsgraph=None):
        if scene.render.engine == "CYCLES":
            told.append((scene.cycles.time_limit, scene.cycles.samples, scene.cycles.use_adaptive_sampling))

    bpy.app.handlers.render_pre.append(note)
    try:
        assert bpy.ops.opal.compare_cycles(equal="TIME") == {"FINISHED"}
    finally:
        bpy.app.handlers.render_pre.remove(note)
    (limit, samples, adaptive), *more = told
    assert not more
    assert limit == pytest.approx(max(0.1, result()["seconds"]["opal"]), rel=1e-5)
    assert samples >= 1 << 20 and not adaptive, "time alone ends it"


def test_an_edited_twin_is_compared_as_it_is_and_named():
    layer_stage.build(passes=1, width=16, height=12)
    tree = bpy.data.materials["Glass"].node_tree
    next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfGlass").inputs["Roughness"].default_value = 0.5
    assert bpy.ops.opal.compare_cycles() == {"FINISHED"}
    assert result()["edited_twins"] == ["Glass"]


def test_a_scene_without_volumes_says_so():
    ordinary(16, 12)
    with pytest.raises(RuntimeError, match="no medium and no rain"):
        bpy.ops.opal.compare_cycles(mode="VOLUMES")
