# SPDX-License-Identifier: GPL-3.0-or-later
"""The round brilliant against what grading reports and Tolkowsky say of it."""

import math

import numpy as np
import pytest
from opal_kernels.cuts import BrilliantProportions, round_brilliant

DIAMOND_DENSITY = 3520.0


def slopes(stone, name):
    """Angles with the girdle plane of the facets of one name, radians."""
    vectors = stone.solid.area_vectors()[[n == name for n in stone.names]]
    return np.arccos(np.abs(vectors[:, 2]) / np.linalg.norm(vectors, axis=1))


def test_it_has_57_facets_and_the_girdle():
    stone = round_brilliant()
    assert stone.facet_count() == 57
    assert stone.counts() == {"table": 1, "star": 8, "bezel": 8, "upper half": 16, "lower half": 16, "main": 8, "girdle": 96}


def test_a_culet_makes_58():
    stone = round_brilliant(BrilliantProportions(culet=0.01))
    assert stone.facet_count() == 58
    assert stone.counts()["culet"] == 1


@pytest.mark.parametrize("proportions", [
    BrilliantProportions(),
    BrilliantProportions(culet=0.02, girdle=0.05),
    BrilliantProportions(table=0.6, crown_angle=math.radians(32), pavilion_angle=math.radians(42), star_length=0.55, lower_half_length=0.85),
    BrilliantProportions(girdle=0.0),
    BrilliantProportions(girdle_facets=16),
])  # fmt: skip
def test_it_is_closed_planar_and_round_in_every_direction(proportions):
    stone = round_brilliant(proportions)
    assert stone.solid.is_watertight()
    assert stone.solid.euler_characteristic() == 2
    assert stone.solid.planarity_error() < 1e-14
    assert np.all(np.einsum("ij,ij->i", stone.solid.area_vectors(), [stone.solid.vertices[face[0]] for face in stone.solid.faces]) > 0.0)


@pytest.mark.parametrize("width", [6.5e-3, 1.0, 1e3])
def test_the_girdles_diameter_is_what_was_asked_for(width):
    vertices = round_brilliant().scaled(width).solid.vertices
    assert 2.0 * np.hypot(vertices[:, 0], vertices[:, 1]).max() == pytest.approx(width, rel=1e-14)


def test_tolkowskys_proportions_come_back_from_the_solid():
    stone = round_brilliant()
    table = stone.solid.vertices[list(stone.solid.faces[stone.names.index("table")])]
    assert len(table) == 8
    assert 2.0 * np.hypot(table[:, 0], table[:, 1]).max() == pytest.approx(0.53, abs=1e-12)
    assert slopes(stone, "bezel") == pytest.approx(math.radians(34.5), abs=1e-9)
    assert slopes(stone, "main") == pytest.approx(math.radians(40.75), abs=1e-9)
    # Crown 16.15 %, pavilion 43.08 %: Tolkowsky gives 16.2 and 43.1.
    assert stone.solid.vertices[:, 2].max() == pytest.approx(0.015 + 0.235 * math.tan(math.radians(34.5)), abs=1e-12)
    assert stone.solid.vertices[:, 2].min() == pytest.approx(-0.015 - 0.5 * math.tan(math.radians(40.75)), abs=1e-12)


def test_halves_are_steeper_than_mains_and_stars_flatter_than_bezels():
    stone = round_brilliant()
    assert slopes(stone, "lower half").min() > math.radians(40.75)
    assert slopes(stone, "star").max() < math.radians(34.5) < slopes(stone, "upper half").min()


def test_a_diamond_of_six_and_a_half_millimetres_weighs_about_a_carat():
    carats = round_brilliant().scaled(6.5e-3).carats(DIAMOND_DENSITY)
    assert carats == pytest.approx(1.0, abs=0.05), f"{carats:.3f} ct"


def test_weight_follows_the_trades_estimate_over_the_usual_proportions():
    """The rule of thumb for diamonds, diameter² × depth × 0.0061 in millimetres and carats: good to a few percent, girdle apart."""
    for table, crown in ((0.53, 34.5), (0.57, 34.0), (0.60, 33.0)):
        stone = round_brilliant(BrilliantProportions(table=table, crown_angle=math.radians(crown))).scaled(6.5e-3)
        estimate = 6.5**2 * stone.extent()[2] * 1e3 * 0.0061
        assert stone.carats(DIAMOND_DENSITY) == pytest.approx(estimate, rel=0.05)


@pytest.mark.parametrize("proportions", [{"table": 1.2}, {"crown_angle": math.nan}, {"culet": -0.1}, {"girdle_facets": 30}])
def test_impossible_proportions_are_refused_by_name(proportions):
    with pytest.raises(ValueError, match=next(iter(proportions))):
        BrilliantProportions(**proportions)
