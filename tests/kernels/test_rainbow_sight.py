# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a bow stands, and the one sentence that says why it is not in the frame."""

import numpy as np
import pytest
from opal_kernels.optics.rainbow import sight


def toward(elevation, azimuth):
    e, a = np.radians([elevation, azimuth])
    return np.array([np.cos(e) * np.sin(a), np.cos(e) * np.cos(a), np.sin(e)])


def looking(elevation, azimuth, half_width=0.9):
    back = -toward(elevation, azimuth)
    right = np.cross([0, 0, 1], back)
    right /= np.linalg.norm(right)
    return sight.View(np.column_stack([right, np.cross(back, right), back]), (-half_width, half_width, -0.5, 0.5))


@pytest.mark.parametrize("height", [0.0, 20.0, 41.0, 60.0])
def test_the_top_of_the_bow_stands_42_degrees_minus_the_suns_height(height):
    sun = toward(height, 200)
    assert np.degrees(sight.top_elevation(sun)) == pytest.approx(42 - height)
    bow = sight.circle(sun)
    assert np.degrees(sight.elevation(bow[0])) == pytest.approx(42 - height)
    np.testing.assert_allclose(bow @ -sun, np.cos(np.radians(42)), atol=1e-12)
    assert sight.elevation(bow[0]) == pytest.approx(max(sight.elevation(d) for d in bow), abs=1e-12)


def test_a_camera_opposite_the_sun_sees_the_bow_and_is_told_nothing():
    assert sight.warnings([toward(20, 180)], looking(5, 0)) == []


@pytest.mark.parametrize(
    ("suns", "view", "said"),
    [
        ([], looking(0, 0), "no sun"),
        ([toward(-10, 180)], looking(0, 0), "below the horizon"),
        ([toward(20, 0)], looking(5, 0), "looks towards the sun"),
        ([toward(20, 90)], looking(5, 0, 0.3), "azimuth 270°"),
        ([toward(60, 180)], looking(10, 0), "above 42°"),
    ],
)
def test_why_there_is_no_bow_is_said_in_one_sentence(suns, view, said):
    sentences = sight.warnings(suns, view, lowest_rad=-0.02)
    assert len(sentences) == 1 and said in sentences[0] and sentences[0].endswith(".")


def test_where_to_look_is_where_the_bow_is():
    sun = toward(25, 130)
    assert "azimuth 310°" in sight.where_to_look(sun) and "elevation 17°" in sight.where_to_look(sun)


def test_lamps_near_the_drops_silence_the_warnings():
    assert sight.warnings([], looking(0, 0), lamps=True) == []


@pytest.mark.parametrize("azimuth", [0.0, 75.0, 190.0, 300.0])
def test_the_curtain_holds_the_whole_of_both_bows(azimuth):
    sun = toward(15, azimuth)
    wall = sight.curtain([sun], None, (3.0, -4.0, 2.0), 100.0, 50.0)
    bow = sight.circle(sun, sight.SECONDARY_RAD)
    bow = bow[bow[:, 2] > 0.01]
    forward = np.array([-np.sin(wall.turn), np.cos(wall.turn), 0.0])
    np.testing.assert_allclose(forward[:2], -sun[:2] / np.linalg.norm(sun[:2]), atol=1e-12)
    across = np.array([np.cos(wall.turn), np.sin(wall.turn), 0.0])
    points = np.array([3.0, -4.0, 2.0]) + bow * (120.0 / (bow @ forward))[:, None] - np.asarray(wall.centre)
    assert (np.abs(points @ forward) <= wall.size[1] / 2).all()
    assert (np.abs(points @ across) <= wall.size[0] / 2).all()
    assert (np.abs(points[:, 2]) <= wall.size[2] / 2).all()
