# SPDX-License-Identifier: GPL-3.0-or-later
"""Rain in Blender: the curtain, the world, the filter, the chart, the tables on disk, and what bad input is told."""

import math
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402
from rain_stage import SUN_HEIGHT, looking, rain_scene, sun  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def test_the_suns_axes_are_what_the_tests_take_them_for():
    toward = np.array(sun().matrix_world)[:3, 2]
    np.testing.assert_allclose(toward, [0, -math.cos(SUN_HEIGHT), math.sin(SUN_HEIGHT)], atol=1e-6)


def test_add_rain_stands_opposite_the_sun_and_makes_a_bow(tmp_path):
    scene = rain_scene(96, 54, 3)
    rain = bpy.context.object
    assert rain.name.startswith("Rain") and rain.active_material.opal.kind == "RAINBOW"
    assert rain.location.y > 100 and abs(rain.location.x) < 1
    picture = stage.render(tmp_path)[..., :3]
    assert stage.problems() == []
    # On the column through the middle the brightest place of green is the bow's top, 42 degrees minus the sun's height over the horizon.
    column = picture[:, 44:52].mean(axis=1)[:, 1]
    f = scene.camera.data.lens / 36.0 * 96
    elevation = np.degrees(np.arctan((np.arange(54) + 0.5 - 27) / f)) + 12.0
    above = elevation > 5
    assert elevation[above][column[above].argmax()] == pytest.approx(42 - 20 - 0.5, abs=1.5)


def test_without_a_sun_rain_is_black_and_says_why(tmp_path):
    stage.scene(24, 8, 1, 2)
    looking()
    bpy.ops.opal.add_rain()
    bpy.context.object.active_material.opal.rainbow.theory = "DESCARTES_SAMPLED"
    assert stage.render(tmp_path)[..., :3].max() == 0
    assert len(stage.problems()) == 1 and "no sun" in stage.problems()[0]


def test_as_many_bows_as_suns(tmp_path):
    """Light adds: the same rain under two suns shows the sum of what each shows alone, and each its own bow round its antisolar point."""
    scene = stage.scene(120, 40, 2, 8)
    looking(lens=14.0, height=math.radians(5.0))
    suns = [sun(math.radians(30.0), math.pi + math.radians(azimuth)) for azimuth in (-20.0, 20.0)]
    bpy.ops.opal.add_rain(share=0.02)  # so thin that next to nothing is scattered twice, which would be noise
    bpy.context.object.active_material.opal.rainbow.theory = "DESCARTES_SAMPLED"
    up, across = np.mgrid[0:40, 0:120] + 0.5
    toward = (
        np.stack([across - 60, up - 20, np.full(up.shape, -14.0 / 36.0 * 120)], axis=-1) @ np.array(scene.camera.matrix_world)[:3, :3].T
    )
    toward /= np.linalg.norm(toward, axis=-1, keepdims=True)

    def picture(*lit):
        for obj in suns:
            obj.hide_render = obj not in lit
        return stage.render(tmp_path)[..., :3].mean(axis=-1)

    def profile(pixels, obj):
        """Mean by whole degrees from the antisolar point of a sun, over the horizon."""
        angle = np.degrees(np.arccos(toward @ -np.array(obj.matrix_world)[:3, 2])).astype(int)
        seen = toward[..., 2] > 0.02
        return {a: pixels[seen & (angle == a)].mean() for a in range(33, 56)}

    both, alone = picture(*suns), [picture(obj) for obj in suns]
    for obj, one in zip(suns, alone, strict=True):
        bow, sums = profile(one, obj), profile(both, obj)
        top = max(range(33, 48), key=bow.get)
        assert top in (40, 41) and bow[45] < 0.1 * bow[top] and bow[52] > 3 * bow[45], bow
        expected = profile(sum(alone), obj)
        assert sums == pytest.approx(expected, abs=float(0.04 * bow[top])), (sums, expected)


def test_a_polarising_filter_takes_the_top_of_the_bow(tmp_path):
    scene = rain_scene(64, 36, 3)
    light = {}
    for angle in (None, 0.0, math.pi / 2):
        scene.camera.data.opal.polarizer = angle is not None
        scene.camera.data.opal.polarizer_angle = angle or 0.0
        f = scene.camera.data.lens / 36.0 * 64
        row = int(18 + f * math.tan(math.radians(21.6 - 12.0)))
        light[angle] = stage.render(tmp_path)[row - 1 : row + 2, 28:36, :3].sum()
    assert light[0.0] + light[math.pi / 2] == pytest.approx(light[None], rel=0.1)
    assert (light[0.0] - light[math.pi / 2]) / light[None] > 0.6


def test_world_rain_shows_a_bow_over_the_horizon(tmp_path):
    stage.scene(64, 36, 2, 4)
    sun()
    looking()
    world = bpy.data.worlds.new("Rain")
    bpy.context.scene.world = world
    world.opal.kind, world.opal.scale_height = "RAINBOW", 500.0
    world.opal.rainbow.theory, world.opal.rainbow.extinction = "DESCARTES_SAMPLED", 5e-4
    picture = stage.render(tmp_path)[..., :3]
    f = 18.0 / 36.0 * 64
    rows = {e: int(18 + f * math.tan(math.radians(e - 12.0))) for e in (21.5, 25.0)}
    assert picture[rows[21.5], 24:40].mean() > 2 * picture[rows[25.0] + 1, 24:40].mean() > 0
    assert stage.problems() == []


@pytest.mark.parametrize(
    ("height", "azimuth", "said"),
    [
        (math.radians(-10), math.pi, "below the horizon"),
        (SUN_HEIGHT, 0.0, "looks towards the sun"),
        (SUN_HEIGHT, math.pi / 2, "azimuth 270"),
    ],
)
def test_a_render_without_a_bow_says_why(tmp_path, height, azimuth, said):
    scene = rain_scene(16, 9, 1)
    bpy.data.objects.remove(next(o for o in scene.objects if o.type == "LIGHT"))
    sun(height, azimuth)
    scene.camera.data.lens = 50.0
    stage.render(tmp_path)
    assert len(stage.problems()) == 1 and said in stage.problems()[0]


def tables():
    return stage.addon("rainbow_tables").folder()


def test_tables_are_kept_and_a_damaged_one_is_computed_again(tmp_path):
    from opal_kernels import droplets

    rain_scene(16, 9, 1, radius=0.123)
    stage.render(tmp_path)
    newest = max(tables().glob("*.opaltable"), key=lambda p: p.stat().st_mtime)
    assert bpy.utils.resource_path("USER") in str(newest)
    newest.write_bytes(newest.read_bytes()[:-50])
    droplets._recent().clear()
    stage.render(tmp_path)
    assert len(stage.problems()) == 1 and "damaged" in stage.problems()[0]
    droplets._recent().clear()
    stage.render(tmp_path)
    assert stage.problems() == []


def test_the_chart_is_an_image_files_and_numbers(tmp_path):
    path = tmp_path / "sheet" / "chart.png"
    assert bpy.ops.opal.rainbow_chart(filepath=str(path), radius=0.05, largest=0.04, rows=3) == {"FINISHED"}
    image, numbers = bpy.data.images["Rainbow Chart"], bpy.data.texts["Rainbow Chart"].as_string()
    assert image.size[0] > 1000 and image.is_float
    assert all(theory in numbers for theory in ("DESCARTES", "DESCARTES_SAMPLED", "AIRY", "MIE", "DROPLET"))
    mie = next(line for line in numbers.splitlines() if line.startswith("MIE"))
    assert "+0.00°" in mie and "+0.0%" in mie
    for suffix in (".png", ".exr"):
        written = bpy.data.images.load(str(path.with_suffix(suffix)))
        assert tuple(written.size) == tuple(image.size)


@pytest.mark.parametrize("settings", [{"radius": 0.0}, {"radius": 1000.0}, {"spread": 30.0}, {"largest": 0.0}])
def test_an_impossible_chart_is_refused_in_a_sentence(settings):
    with pytest.raises(RuntimeError, match=r"radius|spread"):
        bpy.ops.opal.rainbow_chart(**settings)


def test_every_preset_fills_drops_that_can_be():
    from opal_kernels.optics import rainbow as theories

    rainbow = bpy.data.materials.new("Drops").opal.rainbow
    drops_of = stage.addon("translate.rainbow").drops_of
    for name in [item.identifier for item in rainbow.bl_rna.properties["preset"].enum_items]:
        rainbow.preset = name
        drops = drops_of(rainbow, [0.3])
        assert drops.theory in theories.THEORIES
        p = theories.phase_function(
            drops.theory,
            drops.radius_um,
            [550.0],
            [2.4],
            drops.spread,
            distribution=drops.distribution,
            index=None if drops.index is None else np.array([drops.index]),
            salinity=drops.salinity,
            celsius=drops.celsius,
            flattening=drops.flattening,
            sizes=3,
        )
        assert np.isfinite(p).all() and p.max() > 0


def test_the_files_names_are_those_of_the_design():
    rainbow = bpy.data.materials.new("Drops").opal.rainbow
    assert {"theory", "radius", "spread", "extinction", "flattening", "polarization"} <= set(rainbow.bl_rna.properties.keys())
    assert Path(tables()).name == "rainbows"
