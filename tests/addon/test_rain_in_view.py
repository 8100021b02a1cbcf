# SPDX-License-Identifier: GPL-3.0-or-later
"""What Opal says of rain: nothing where something is to be seen, else one sentence, at `opal.add_rain` and in the render's report alike."""

from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402
from rain_stage import rain_scene  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


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
