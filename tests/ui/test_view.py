# SPDX-License-Identifier: GPL-3.0-or-later
"""What the rendered view draws in a window, value for value, as `view.py` looks at it.

Pictures go to build/screenshots/view.
"""

from __future__ import annotations

import pytest
from real_blender import SCREENSHOTS, drive

# `view.MARKED`, and the frame round it that is looked at as well.
MARKED, AROUND = (400, 300, 560, 400), 40


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    result, printed = drive(tmp_path_factory.mktemp("view"), script="view.py", keep=SCREENSHOTS / "view")
    assert "Traceback" not in printed, printed[-4000:]
    return result


@pytest.mark.parametrize("transform", ["Standard", "AgX"])
def test_the_view_shows_the_display_values_that_a_final_render_saves(found, transform):
    """Both are means of the same noise; they differed by 0.0005 at most. A stop of exposure, or the other transform, is 0.1."""
    assert found[transform]["shown"] == pytest.approx(found[transform]["saved"], abs=2 / 255)
    assert max(found[transform]["saved"]) - min(found[transform]["saved"]) > 0.25, "the colour is one"


@pytest.mark.parametrize("transform", ["Standard", "AgX"])
def test_a_border_is_drawn_where_it_was_marked_and_nothing_beyond(found, transform):
    """Through the camera Blender makes fractions of its frame of what is marked, of which a pixel may be lost, as in Cycles."""
    place = found[transform]["place"]
    assert place["edges"] == pytest.approx(MARKED, abs=1) and place["filled"] > 0.98, place
    assert found[transform]["beyond"] < 1 / 255, "what lies beyond is of one colour"


def test_without_its_border_the_view_is_whole_again(found):
    left, bottom, right, top = MARKED
    assert found["whole"]["edges"] == [left - AROUND, bottom - AROUND, right + AROUND, top + AROUND], found["whole"]
    assert found["whole"]["filled"] > 0.9, "one pass is noisy"
