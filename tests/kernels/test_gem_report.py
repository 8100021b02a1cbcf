# SPDX-License-Identifier: GPL-3.0-or-later
"""The gemmologist's numbers: the ray of Tolkowsky, shares that add up, faults that are seen, and the tracer's picture agreeing."""

import math

import numpy as np
import pytest
from opal_kernels import gem_report
from opal_kernels.cuts import round_brilliant
from opal_kernels.cuts.brilliant import BrilliantProportions
from opal_kernels.descriptions import wavelengths
from opal_kernels.gem_report.stone_rays import StoneRays, fresnel
from opal_kernels.optics import species

DOWN, UP = np.array([0.0, 0, -1]), np.array([0.0, 0, 1])


def brilliant(pavilion=40.75, name="DIAMOND", index=None, absorption=None):
    solid = round_brilliant(BrilliantProportions(pavilion_angle=math.radians(pavilion))).scaled(0.0065).solid
    triangles = np.array([(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)])
    index = species.index(name, wavelengths()) if index is None else np.full(471, index)
    return gem_report.FacetedStone(solid.vertices, triangles, index, absorption)


@pytest.mark.parametrize(("nm", "angle"), [(589.3, 44.970), (400.0, 46.091), (700.0, 44.710)])
def test_tolkowskys_ray_leaves_the_table_at_his_angle(nm, angle):
    """PHYSICS §2.3: down through the table, off two mains at 40.75°, 17° from the vertical inside, and out."""
    stone = brilliant()
    with StoneRays(stone) as rays:
        # Along the azimuths of the mains, at radii where light falls on a main and comes back through the table.
        turn = np.radians(np.arange(0, 360, 22.5))
        radii = np.linspace(0.02, 0.4, 40)
        at = np.stack(
            [np.outer(radii, np.cos(turn)).ravel(), np.outer(radii, np.sin(turn)).ravel(), np.full(radii.size * turn.size, 2.0)], 1
        )
        exits = rays.look(at, DOWN, nm, facets=3)
    slopes = np.degrees(np.arccos(np.clip(-stone.normals[exits.triangle[1:3]] @ UP, -1, 1)))
    two_mains = (np.abs(slopes - 40.75) < 0.01).all(axis=0)
    table = stone.is_table[exits.triangle[0]] & stone.is_table[exits.triangle[3]] & (exits.triangle[3] >= 0) & two_mains
    assert table.sum() > 10
    found = np.degrees(np.arccos(exits.direction[3, table] @ UP))
    assert found == pytest.approx(angle, abs=2e-3)


def test_fresnel_is_that_of_the_optics():
    from opal_kernels.optics import fresnel as optics

    cosine = np.linspace(0.01, 1, 50)
    for eta in (1.5, 2.417, 1 / 1.5):
        reflected, _ = fresnel(cosine, eta)
        assert reflected == pytest.approx(optics.reflectance(cosine, eta), abs=1e-12)


@pytest.mark.parametrize("name", sorted(species.table()))
def test_energy_through_every_species_is_conserved_to_a_millionth(name):
    """What leaves, facet by facet, what is absorbed and what is still inside add up to what entered."""
    stone = brilliant(name=name, absorption=species.absorption(name, wavelengths()))
    place = np.random.default_rng(1).uniform(-0.6, 0.6, (400, 3))
    place[:, 2] = 2.0
    with StoneRays(stone) as rays:
        for nm in (430.8, 589.3, 686.7):
            exits = rays.look(place, DOWN, nm, facets=2000, least=1e-9)
            total = exits.weight.sum(axis=0)[exits.hit] + exits.absorbed[exits.hit]
            assert total == pytest.approx(1.0, abs=1e-6)


def test_shares_add_up_and_a_stone_of_air_only_leaks():
    report = gem_report.measure(brilliant(), tilts=[0, 15], side=64)
    for shares in (report.face_up, *report.tilt_curve):
        parts = (shares.light_return, shares.head, shares.leakage, shares.absorbed)
        assert sum(parts) == pytest.approx(1.0, abs=1e-9) and min(parts) >= 0
    air = gem_report.measure(brilliant(index=1.0), tilts=[0], side=48)
    assert air.face_up.leakage == pytest.approx(1.0, abs=1e-6) and air.fire == 0


def test_a_diamond_of_tolkowskys_returns_the_light_and_a_quartz_of_the_same_cut_is_darker():
    diamond, quartz = gem_report.measure(brilliant(), side=96), gem_report.measure(brilliant(name="QUARTZ"), side=96)
    assert diamond.face_up.light_return > 0.65 and diamond.face_up.leakage < 0.1
    assert not diamond.has_fish_eye and not diamond.has_nail_head
    assert quartz.face_up.light_return < 0.8 * diamond.face_up.light_return
    assert quartz.fire < 0.7 * diamond.fire, "fire follows the dispersion"
    middle = len(diamond.tilts) // 2
    assert diamond.tilt_curve[0].leakage > 2 * diamond.tilt_curve[middle].leakage, "tilted, the stone opens a window"


def test_a_shallow_pavilion_shows_the_fish_eye_and_a_steep_one_the_nail_head():
    shallow, steep = gem_report.measure(brilliant(38.0), tilts=[0]), gem_report.measure(brilliant(45.0), tilts=[0])
    assert shallow.has_fish_eye and not shallow.has_nail_head, f"{shallow.fish_eye:.3f}, {shallow.nail_head:.3f}"
    assert steep.has_nail_head and not steep.has_fish_eye, f"{steep.fish_eye:.3f}, {steep.nail_head:.3f}"


def test_the_pictures_brightness_is_the_light_return():
    stone = brilliant()
    picture = gem_report.face_up(stone, size=64, passes=4)
    seen = (picture[..., :3] @ [0.2126729, 0.7151522, 0.0721750]).sum() / picture[..., 3].sum()
    expected = gem_report.measure(stone, tilts=[0]).face_up.light_return
    assert seen == pytest.approx(expected, abs=0.015), f"rendered {seen:.4f}, by rays {expected:.4f}"


def test_a_ruby_returns_what_its_picture_shows():
    """By three wavelengths beside the tracer's many: within 0.02 of white."""
    stone = brilliant(name="RUBY", absorption=0.3 * species.absorption("RUBY", wavelengths()))
    picture = gem_report.face_up(stone, size=64, passes=4)
    seen = (picture[..., :3] @ [0.2126729, 0.7151522, 0.0721750]).sum() / picture[..., 3].sum()
    assert seen == pytest.approx(gem_report.measure(stone, tilts=[0]).face_up.light_return, abs=0.02)


def test_a_stone_that_is_open_or_turned_inside_out_is_refused_with_a_sentence():
    stone = brilliant()
    with pytest.raises(ValueError, match="open"):
        gem_report.FacetedStone(stone.vertices, stone.triangles[:-3], stone.index)
    with pytest.raises(ValueError, match="inwards"):
        gem_report.FacetedStone(stone.vertices, stone.triangles[:, ::-1], stone.index)


def test_a_report_can_be_stopped():
    with pytest.raises(gem_report.Cancelled):
        gem_report.measure(brilliant(), side=32, progress=lambda done: done < 0.3)


def test_the_page_holds_pictures_and_numbers():
    stone = brilliant()
    report = gem_report.measure(stone, tilts=[-10, 0, 10], side=32)
    picture = gem_report.face_up(stone, size=128, passes=1)
    page = gem_report.draw(report, picture, gem_report.flashes(stone, size=128, passes=1))
    assert page.ndim == 3 and np.isfinite(page).all() and page.max() > 0.5
    assert "light return" in gem_report.table(report)
