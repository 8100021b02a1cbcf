# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal in a window, by mouse and keys: from the menu's gem to the comparison, as `keys.py` drives it.

Pictures go to build/screenshots/keys, to be looked at. They are compared by their structure alone: what is there, how it is
coloured, whether its grain falls.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from real_blender import SCREENSHOTS, drive

# Escape is asked for every 0.03 s and every pass of the tracer ends within 0.1 s of it; Blender's interface looks at its render
# job every 0.1 s. On a busy machine we measured 0.25 to 0.46 s; it gets time to draw.
ESCAPE_SECONDS = 1.0
# Block means of screenshots that were looked at and found right (`window.blocks`).
STORED = json.loads((Path(__file__).parent / "blocks.json").read_text())


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    result, printed = drive(tmp_path_factory.mktemp("keys"), script="keys.py", keep=SCREENSHOTS / "keys")
    assert "Traceback" not in printed, printed[-4000:]
    return result


def test_the_menu_adds_a_gem_with_its_material(found):
    assert found["gem"]["kind"] == "GEM" and found["gem"]["selected"], found["gem"]
    assert found["species"] == "RUBY"
    assert found["species_seconds"] < 0.5, "a species is one edit"


def test_search_finds_what_has_no_key(found):
    assert found["searched"] == ["OPAL_OT_update_twins"]


def test_f12_shows_progress_and_a_picture_meanwhile(found):
    assert any("Pass 1 of 10000" in text for text in found["words"]), found["words"]
    assert found["while_rendering"]["spread"] > 0.02 and found["while_rendering"]["colourful"] > 0.2, found["while_rendering"]


def test_escape_stops_the_render_and_keeps_what_there_is(found):
    assert found["stopped"]
    assert found["escape_seconds"] < ESCAPE_SECONDS, f"{found['escape_seconds']:.2f} s"
    assert found["after_escape"]["spread"] == pytest.approx(found["while_rendering"]["spread"], rel=0.2)
    assert found["after_escape"]["colourful"] > 0.2


def test_the_rendered_view_shows_a_picture_that_refines(found):
    first, later = found["view_first"], found["view_later"]
    assert first["spread"] > 0.02 and later["colourful"] > 0.2, (first, later)
    assert later["grain"] < 0.7 * first["grain"], (first["grain"], later["grain"])
    assert later["mean"] == pytest.approx(first["mean"], abs=0.05)


def test_the_rendered_view_follows_a_material_a_deletion_and_an_undo(found):
    ruby, emerald, deleted, undone = (found[f"view_{name}"] for name in ("later", "edited", "deleted", "undone"))
    assert emerald["green"] - emerald["red"] > ruby["green"] - ruby["red"] + 0.005, (ruby, emerald)
    assert deleted["spread"] < 0.5 * ruby["spread"] < undone["spread"], (ruby, deleted, undone)


@pytest.mark.parametrize("part", ["stopped_opal", "stopped_cycles"])
def test_escape_stops_comparison_and_composite_in_either_engines_part(found, part):
    """They tell in the window's foot how far they are, and leave everything as it was."""
    job = found[part]
    assert job["begun"] == ["RUNNING_MODAL"] and job["ran"]
    assert job["foot_changed"] > 0.3 < job["foot_changed_back"], job
    assert job["view"]["spread"] > 0.02, f"a view that is locked keeps its picture: {job['view']}"
    assert "is still at work" in job["other"], "no other begins meanwhile"
    assert job["escape_seconds"] < 3.0, f"Cycles ends with the sample that it is at: {job['escape_seconds']:.2f} s"
    assert job["changed"] == [] and job["pictures"] == []


def test_undo_ends_a_composite_and_what_it_has_changed_is_put_back(found):
    assert found["undone"] == {"changed": [], "pictures": []}


def test_beside_the_interface_the_comparison_makes_the_pictures_that_scripts_get(found):
    assert found["compare"] == ["FINISHED"]
    finished = found["finished"]
    assert finished["stepwise"] == finished["pictures"] and len(finished["pictures"]) == 4
    assert list(finished["apart"].values()) == [0.0] * 4, finished
    assert finished["changed"] == []
    assert finished["undone"] == [], "one step of undo takes them away"


def test_the_comparison_opens_its_picture(found):
    assert "Opal Side by Side" in found["compare_shown"], found["compare_shown"]


def test_escape_stops_the_gem_report(found):
    assert found["report"] == ["RUNNING_MODAL"] and found["report_runs"]
    assert found["report_escape_seconds"] < 3.0, "it ends with the band of rows it is at"


def test_panels_show_curves_in_the_colours_of_the_spectrum(found):
    """Nothing else in these panels is as colourful as a spectrum."""
    assert found["material_panel"]["colourful"] > 0.8 and found["gem_curve"]["colourful"] > 0.8
    assert found["lamp_F11"]["colourful"] > 0.8 > found["lamp_COLOR"]["colourful"], (found["lamp_F11"], found["lamp_COLOR"])


def test_a_click_on_a_line_of_the_report_selects_the_object(found):
    assert ["Flattened", "OBJECT"] in found["report_line"] and found["report_selected_before"] == []
    assert found["report_line_rows"] > 8, "the list's active line is in sight"
    assert found["report_selected"] == ["Flattened"]


@pytest.mark.parametrize("name", sorted(STORED))
def test_a_screenshot_has_the_structure_that_it_had(found, name):
    """Means of 6 x 8 blocks: panels, picture and list stand where they stood, as bright as they were.

    Two runs differed by noise by at most 0.005 in any block; another font may change one a little more.
    """
    now, before = np.array(found["blocks"][name]), np.array(STORED[name])
    assert np.corrcoef(now.ravel(), before.ravel())[0, 1] > 0.9, now
    assert np.abs(now - before).max() < 0.05, np.round(now - before, 2)


def test_the_stored_structures_tell_screenshots_apart():
    for one in STORED:
        for other in STORED:
            if one < other:
                assert np.corrcoef(np.ravel(STORED[one]), np.ravel(STORED[other]))[0, 1] < 0.5, (one, other)


def test_disabling_leaves_nothing(found):
    assert found["left_behind"] == []
