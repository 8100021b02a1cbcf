# SPDX-License-Identifier: GPL-3.0-or-later
"""What Opal says of rain: nothing where something is to be seen, else one sentence, at `opal.add_rain` and in the render's report alike."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402
from rain_stage import looking, rain_scene, sun  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


@pytest.fixture
def quick(monkeypatch):
    """Drops without tables: where a bow is to be seen does not depend on them."""
    from opal_kernels import droplets
    from opal_kernels.descriptions import Phase

    monkeypatch.setattr(droplets, "phase", lambda *_: Phase())


@pytest.fixture
def said(quick, capfd, tmp_path):
    """Adds rain and renders; what the operator and the render say, which must be the same."""

    def add_and_render(**settings):
        scene = stage.scene(16, 9, 1, 1)
        capfd.readouterr()
        bpy.ops.opal.add_rain(**settings)
        told = [line.partition("Warning: ")[2].strip() for line in capfd.readouterr().out.splitlines() if "Warning: " in line]
        stage.render(tmp_path)
        assert [f"Rainbow: {sentence}" for sentence in told] == stage.problems(), scene
        return told

    return add_and_render


# Radius of what a preset shows, degrees from the antisolar point.
SHOWN = {"GLASS_BEADS": 22.0, "FOGBOW": 37.7, "CORONA": 180.0}


def test_no_preset_is_warned_of_where_its_bow_is_in_a_narrow_frame(said):
    presets = stage.addon("rainbow_presets").PRESETS
    sun(math.radians(12.0))
    for name in presets:
        radius = SHOWN.get(name, 41.5)
        camera = looking(0.0, math.radians(radius - 12.0), lens=100.0) if radius < 90 else looking(math.pi, math.radians(12.0), lens=100.0)
        assert said(preset=name) == [], name
        bpy.data.objects.remove(bpy.context.object)
        bpy.data.objects.remove(camera)
    looking(0.0, math.radians(52.0 - 12.0), lens=90.0)
    assert said() == [], "the secondary alone"
    looking(math.pi / 2, math.radians(20.0), lens=100.0)
    assert len(said()) == 1


@pytest.mark.parametrize(
    ("height", "words"),
    [(None, ("no sun", "lamps")), (-5.0, ("below the horizon", "lamps")), (60.0, ("above 52°",))],
)
def test_a_lamp_far_from_the_rain_silences_nothing(said, height, words):
    """As in Blender's factory scene: a point lamp of 1 kW stands near the camera and the curtain at 150 m."""
    data = bpy.data.lights.new("Light", "POINT")
    data.energy = 1000.0
    stage.link("Light", data, (4.08, 1.0, 5.9))
    if height is not None:
        sun(math.radians(height))
    looking(0.0, 0.0)
    sentences = said()
    assert len(sentences) == 1 and all(word in sentences[0] for word in words), sentences


def test_a_lamp_by_a_spray_makes_a_bow_of_its_own_and_nothing_is_said(quick, tmp_path):
    stage.scene(16, 9, 1, 1)
    looking(0.0, 0.0)
    data = bpy.data.lights.new("Light", "POINT")
    data.energy = 60.0
    stage.link("Light", data, (0.0, 0.0, 3.0))
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0, 3, 2))
    material = bpy.data.materials.new("Spray")
    material.opal.kind = "RAINBOW"
    bpy.context.object.data.materials.append(material)
    stage.render(tmp_path)
    assert stage.problems() == []


def test_an_orthographic_camera_is_told_that_it_cannot_see_a_bow(said):
    sun()
    looking().data.type = "ORTHO"
    sentences = said()
    assert len(sentences) == 1 and "orthographic" in sentences[0].lower()


def test_rain_on_the_world_begins_with_numbers_that_let_the_sun_through(quick, tmp_path):
    stage.scene(16, 9, 1, 1)
    sun()
    looking()
    world = bpy.context.scene.world = bpy.data.worlds.new("Rain")
    world.opal.kind = "RAINBOW"
    assert (world.opal.scale_height, world.opal.rainbow.extinction) == (1000.0, pytest.approx(0.0005))
    stage.render(tmp_path)
    assert stage.problems() == []
    bpy.data.objects.remove(bpy.data.objects["Sun"])
    stage.link("Light", bpy.data.lights.new("Light", "POINT"))
    stage.render(tmp_path)
    assert len(stage.problems()) == 1 and "no sun" in stage.problems()[0] and "lamps" in stage.problems()[0]


@pytest.mark.parametrize(("kind", "filling"), [("RAINBOW", "rainbow"), ("MEDIUM", "medium")])
def test_a_worlds_numbers_that_were_set_stay_when_its_kind_is_chosen(kind, filling):
    world = bpy.data.worlds.new("World").opal
    world.scale_height = 0.0
    getattr(world, filling).extinction = 0.002
    world.kind = kind
    assert (world.scale_height, getattr(world, filling).extinction) == (0.0, pytest.approx(0.002))
    fresh = bpy.data.worlds.new("World").opal
    fresh.kind = kind
    assert (fresh.scale_height, getattr(fresh, filling).extinction) == (1000.0, pytest.approx(0.0005))
    fresh.rainbow.preset = "FOGBOW"  # whose extinction is that of a body
    assert (fresh.rainbow.theory, getattr(fresh, filling).extinction) == ("MIE", pytest.approx(0.0005))
    fresh.kind = "NONE"
    fresh.scale_height = 0.0
    fresh.kind = kind
    assert fresh.scale_height == 0.0


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"radius": 0.0}, "Radius must lie between 0.0001 and 5 mm, not 0 mm"),
        ({"radius": 1000.0}, "Radius must lie between 0.0001 and 5 mm, not 1000 mm"),
        ({"spread": 40.0}, "Spread must lie between 0 and 1, not 40"),
        (
            {"liquid": "CUSTOM", "index": 1.01, "index_dispersion": 0.1},
            "Index and Dispersion give an index of 0.886 at 780 nm, and drops need one above 1",
        ),
    ],
)
def test_impossible_drops_are_named_in_the_panels_words_and_the_picture_comes(tmp_path, settings, sentence):
    rain_scene(16, 9, 1, **settings)
    picture = stage.render(tmp_path)
    assert picture.shape == (9, 16, 4) and np.isfinite(picture).all()
    assert stage.problems() == [f"Rain: {sentence}; the body is rendered empty."]


@pytest.mark.parametrize("spread", [0.0, 0.3, 9.0])
def test_marshall_and_palmers_rain_is_the_same_whatever_the_spread(spread):
    module = stage.addon("translate.rainbow")
    rainbow = bpy.data.materials.new("Drops").opal.rainbow
    rainbow.preset = "SHOWER"
    wanted = module.drops_of(rainbow).key()
    rainbow.spread = spread
    assert module.drops_of(rainbow).key() == wanted and module.refusal(rainbow) == ""


def test_small_drops_by_airys_theory_are_hinted_at():
    panels = stage.addon("rainbow_panels")
    rainbow = bpy.data.materials.new("Drops").opal.rainbow

    class Layout(SimpleNamespace):
        def prop(self, *_, **__):
            pass

        def label(self, text, icon):
            hints.append(text)

        def column(self, **_):
            return self

        row = column

    for theory, radius, expected in (("AIRY", 0.25, 0), ("AIRY", 0.02, 1), ("MIE", 0.02, 0)):
        rainbow.theory, rainbow.radius = theory, radius
        hints = []
        panels.draw_drops(Layout(), rainbow)
        assert len(hints) == expected, (theory, radius)


def test_escape_while_drops_are_computed_ends_the_render_and_leaves_nothing(tmp_path, monkeypatch):
    """F12 with drops that no table is kept of: the bar moves on, Escape half way stops, and the next render is as any."""
    from opal_kernels import droplets

    rain_scene(16, 9, 1, temperature=13.7)
    render = stage.addon("final_render")._FinalRender
    real, bar = render._stage, []

    def escape_half_way(self, text, done=0.0):
        engine = SimpleNamespace(update_stats=lambda *_: None, update_progress=bar.append, test_break=lambda: done > 0.5)
        if text.startswith("Computing the rainbow's drops"):
            real(SimpleNamespace(engine=engine, last_stage=-np.inf), text, done)

    def kept():
        return {path.name for path in stage.addon("rainbow_tables").folder().glob("*")}

    before, recent = kept(), set(droplets._recent())
    with monkeypatch.context() as patch:
        patch.setattr(render, "_stage", escape_half_way)
        bpy.ops.render.render()  # writes no picture, as Blender does not after Escape
    assert len(bar) > 2 and bar == sorted(bar) and bar[0] < 0.3 and 0.5 < bar[-1] < 1.0, bar
    assert kept() == before and set(droplets._recent()) == recent
    assert stage.render(tmp_path)[..., :3].max() > 0
    assert stage.problems() == []
    assert len(kept() - before) >= 1 and set(droplets._recent()) != recent
