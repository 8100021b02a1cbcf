# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal in a Blender as a distribution ships it, with windows: another Python and NumPy than bpy's, perhaps no denoiser.

Pictures go to build/screenshots, to be looked at.
"""

from __future__ import annotations

import pytest
from real_blender import SCREENSHOTS, drive


@pytest.fixture(scope="module")
def background(tmp_path_factory):
    return drive(tmp_path_factory.mktemp("background"), "--background", keep=SCREENSHOTS / "background")


@pytest.fixture(scope="module")
def windowed(tmp_path_factory):
    return drive(tmp_path_factory.mktemp("window"), keep=SCREENSHOTS / "window")


def test_the_zip_renders_the_first_scene_without_a_window(background):
    found, printed = background
    assert found["enabled"] and "OK" in printed.splitlines()
    assert (found["render"]["width"], found["render"]["height"]) == (64, 64)
    assert 0.05 < found["render"]["mean"] < 0.95, found
    assert found["render"]["spread"] > 0.02, f"a flat picture: {found}"


def test_a_render_started_from_the_interface_ends_and_is_shown(windowed):
    found, _ = windowed
    assert found["render_end"] == ["complete"]
    assert found["render"]["spread"] > 0.02, f"a flat picture: {found}"


def test_the_rendered_view_shows_the_scene(windowed):
    found, _ = windowed
    assert found["viewport"]["mean"] > 0.05 and found["viewport"]["spread"] > 0.02, found


def test_disabled_while_a_view_renders_it_leaves_nothing(windowed):
    found, _ = windowed
    assert found["left_behind"] == []
    assert found["engine_after"] != "OPAL"


@pytest.mark.parametrize("how", ["background", "windowed"])
def test_nothing_went_wrong_on_the_way(how, request):
    _, printed = request.getfixturevalue(how)
    assert "Traceback" not in printed, printed[-4000:]
