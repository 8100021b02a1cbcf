# SPDX-License-Identifier: GPL-3.0-or-later
"""Where bows, glory and corona stand, and the one sentence that says why none is in the frame."""

import numpy as np
import pytest
from opal_kernels import droplets
from opal_kernels.optics.rainbow import rain_places, sight
from opal_kernels.optics.rainbow.curtain import curtain

RAIN = droplets.arcs(droplets.Drops())
BEADS = droplets.arcs(droplets.Drops(radius_um=300.0, index=1.51, dispersion=0.0042))
FOG = droplets.arcs(droplets.Drops("MIE", 10.0, 0.1))
CLOUD = droplets.arcs(droplets.Drops("MIE", 8.0, 0.05, diffraction=True))
EYE = np.array([0.0, 0.0, 2.0])


def toward(elevation, azimuth):
    e, a = np.radians([elevation, azimuth])
    return np.array([np.cos(e) * np.sin(a), np.cos(e) * np.cos(a), np.sin(e)])


def looking(elevation, azimuth, half_width=0.9, eye=EYE, **more):
    back = -toward(elevation, azimuth)
    right = np.cross([0, 0, 1], back)
    right /= np.linalg.norm(right)
    axes = np.column_stack([right, np.cross(back, right), back])
    return sight.View(axes, (-half_width, half_width, -0.55 * half_width, 0.55 * half_width), np.asarray(eye, float), **more)


def air(arcs=RAIN, extinction=5e-4):
    return rain_places.Air(arcs, extinction)


def box(low, high, arcs=RAIN, linear=None, place=(0, 0, 0)):
    matrix = np.column_stack([np.eye(3) if linear is None else linear, place])
    return rain_places.Box(arcs, matrix[None], np.asarray(low, float), np.asarray(high, float))


def wall(suns, view=None, arcs=RAIN, distance=150.0, depth=150.0):
    """The curtain that the operator makes, as a region."""
    made = curtain(suns, view, EYE, distance, depth)
    c, s = np.cos(made.turn), np.sin(made.turn)
    half = np.asarray(made.size) / 2
    return box(-half, half, arcs, np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]), made.centre)


@pytest.mark.parametrize(
    ("arcs", "primary", "secondary"),
    [(droplets.arcs(droplets.Drops("DESCARTES")), 42.02, 50.97), (RAIN, 41.5, 51.9), (FOG, 37.65, None), (BEADS, 21.61, None)],
)
def test_bows_stand_where_the_drops_index_and_size_put_them(arcs, primary, secondary):
    """At 589.3 nm: Descartes' angles of water in air, and inside them by Airy's first maximum; the fogbow between the 37.68° of
    reference/fog_corona_glory.csv at 550 nm and its 37.5° at 650, within Airy's error."""
    assert np.degrees(arcs.primary) == pytest.approx(primary, abs=0.1)
    if secondary is not None:
        assert np.degrees(arcs.secondary) == pytest.approx(secondary, abs=0.1)


def test_the_places_of_bows_are_those_of_the_tables():
    """The brightest place of the drops' own phase function lies in the band, at violet as at red."""
    from opal_kernels.optics import rainbow

    angles = np.radians(np.arange(120.0, 160.0, 0.05))
    for drops, arcs in ((droplets.Drops(), RAIN), (droplets.Drops("MIE", 10.0, 0.1), FOG)):
        p = rainbow.phase_function(drops.theory, drops.radius_um, [450.0, 550.0, 660.0], angles, drops.spread, diffraction=False)
        places = np.pi - angles[p.mean(axis=0).argmax(axis=1)]
        low, high = arcs.bands[0]
        slack = np.radians(1.0 if drops.theory == "MIE" else 0.05)  # Airy's cubic wavefront at x = 100
        assert (places > low - slack).all() and (places < high + slack).all(), np.degrees([*places, low, high])


def test_small_drops_alone_have_a_glory_and_drops_with_the_forward_lobe_a_corona():
    assert not (RAIN.glory or RAIN.corona or FOG.corona) and FOG.glory and CLOUD.corona
    assert not droplets.arcs(droplets.Drops("MIE", 100.0)).glory, "its rings are smaller than the sun's disc"
    assert not droplets.arcs(droplets.Drops("AIRY", 10.0)).glory, "only Lorenz-Mie has one"
    third = np.degrees(droplets.arcs(droplets.Drops("MIE", 5.0, 0.0)).bands[2][1])
    assert third == pytest.approx(11.2 * 589.3 / 650, rel=0.05), "third ring, Laven's 11.2 degrees at 650 nm"


def test_an_index_above_2_has_no_primary_and_is_no_trouble():
    arcs = droplets.arcs(droplets.Drops(index=2.4))
    assert np.isnan(arcs.primary) and np.isfinite(arcs.secondary)
    assert len(sight.warnings([toward(60, 180)], looking(0, 0, 0.05), [air(arcs)])) == 1


@pytest.mark.parametrize("height", [0.0, 20.0, 41.0, 60.0])
def test_the_top_of_a_bow_stands_its_radius_minus_the_suns_height(height):
    sun, radius = toward(height, 200), np.radians(42.0)
    assert np.degrees(sight.top_elevation(sun, radius)) == pytest.approx(42 - height)
    bow = sight.circle(sun, radius)
    assert np.degrees(sight.elevation(bow[0])) == pytest.approx(42 - height)
    np.testing.assert_allclose(bow @ -sun, np.cos(radius), atol=1e-12)
    assert sight.elevation(bow[0]) == pytest.approx(max(sight.elevation(d) for d in bow), abs=1e-12)


@pytest.mark.parametrize(
    ("sun", "view", "region"),
    [
        (toward(20, 180), looking(5, 0), air()),
        (toward(20, 180), looking(33, 0, 0.2), air()),  # the secondary alone
        (toward(45, 180), looking(5, 0, 0.4), air()),  # the same, with the primary below the horizon
        (toward(10, 180), looking(12, 0, 0.1), air(BEADS)),
        (toward(20, 180), looking(-20, 0, 0.1, (0, 0, 100)), box([-300, 50, 0], [300, 150, 80], FOG)),  # the glory
        (toward(20, 180), looking(20, 180, 0.2), air(CLOUD)),  # the corona
        (toward(60, 180), looking(-18, 0, 0.4, (0, 0, 300)), air()),  # from a height the whole bow
        (toward(20, 180), looking(5, 0), wall([toward(20, 180)])),
    ],
)
def test_what_stands_in_the_frame_is_told_nothing_about(sun, view, region):
    assert sight.warnings([sun], view, [region]) == []


@pytest.mark.parametrize(
    ("suns", "view", "region", "said"),
    [
        ([], looking(0, 0), air(), "no sun"),
        ([toward(-10, 180)], looking(0, 0), air(), "below the horizon"),
        ([toward(20, 0)], looking(5, 0), air(), "looks towards the sun"),
        ([toward(20, 90)], looking(5, 0, 0.3), air(), "azimuth 270°"),
        ([toward(60, 180)], looking(10, 0), air(), "above 52°, so every bow"),
        ([toward(60, 180)], looking(0, 0), wall([toward(60, 180)]), "above 52°, so every bow"),
        ([toward(60, 180)], looking(-10, 0), air(), "above 52°, so every bow"),  # the ground hides the drops from an eye at 2 m
        ([toward(45, 180)], looking(20, 0, 0.1), air(), "secondary bow stands at azimuth 0° (from +Y towards +X), elevation 7°"),
        ([toward(10, 180)], looking(32, 0, 0.1), air(BEADS), "elevation 12°"),
        ([toward(20, 180)], looking(20, 180, 0.2), air(BEADS), "looks towards the sun"),
        ([toward(20, 180)], looking(20, 90, 0.2), air(CLOUD), "corona is round the sun, at azimuth 180°"),
        ([toward(20, 180)], looking(60, 0, 0.2), air(FOG), "the glory is at azimuth 0° (from +Y towards +X), elevation -20°"),
        ([toward(20, 180)], looking(5, 0), box([-300, -200, 0], [300, -100, 200]), "no drops are there"),
        ([toward(20, 180)], looking(5, 0, 5.0, parallel=True), air(), "orthographic"),
    ],
)
def test_why_there_is_no_bow_is_said_in_one_sentence(suns, view, region, said):
    sentences = sight.warnings(suns, view, [region])
    assert len(sentences) == 1 and said in sentences[0] and sentences[0].endswith("."), sentences


def test_where_to_look_is_where_the_bow_is():
    sun = toward(25, 130)
    assert "azimuth 310°" in sight.where_to_look(sun, RAIN) and "elevation 17°" in sight.where_to_look(sun, RAIN)


def test_lamps_among_the_drops_silence_the_warnings_and_far_ones_do_not():
    """A lamp of 1 kW lights a fountain and not a curtain at 150 m, which half a kilowatt for every metre would be needed for."""
    spray, shower = box([-1, 3, 0], [1, 4, 1]), wall([])
    for region, place, watts, expected in (
        (spray, (0, 0, 1), 60.0, rain_places.Lamps.NEAR),
        (spray, (0, 3.5, 0.5), 1e-3, rain_places.Lamps.NEAR),
        (shower, (4.1, 1.0, 5.9), 1000.0, rain_places.Lamps.FAR),
        (shower, (0, 200.0, 20.0), 100.0, rain_places.Lamps.NEAR),
        (air(), (0, 0, 2.0), 1000.0, rain_places.Lamps.FAR),
    ):
        found = rain_places.lamps([(np.array(place), watts)], [region])
        assert found == expected, (region, place, watts)
        for suns, word in (([], "no sun"), ([toward(-5, 180)], "below the horizon")):
            sentences = sight.warnings(suns, looking(0, 0), [region], found)
            if expected == rain_places.Lamps.NEAR:
                assert sentences == []
            else:
                assert len(sentences) == 1 and word in sentences[0] and "lamps" in sentences[0]
    assert rain_places.lamps([], [spray]) == rain_places.Lamps.NONE
    assert rain_places.lamps([(np.array([0, 0, 1.0]), 60.0)], [spray], 1000.0) == rain_places.Lamps.FAR, "outshone by the sun"


def test_a_ray_meets_a_box_however_it_is_turned():
    """Against points along rays, in a box that is turned, stretched and copied."""
    random = np.random.default_rng(1)
    linear = [np.linalg.qr(random.normal(size=(3, 3)))[0] * [1.0, 3.0, 0.5] for _ in range(2)]
    places = [np.array([6.0, 0, 0]), np.array([-4.0, 5, 1])]
    region = rain_places.Box(RAIN, np.array([np.column_stack(t) for t in zip(linear, places, strict=True)]), -np.ones(3), np.ones(3))
    directions = random.normal(size=(600, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points = EYE + np.linspace(0, 20, 2000)[:, None, None] * directions
    inside = np.zeros(points.shape[:2], bool)
    for matrix, place in zip(linear, places, strict=True):
        inside |= (np.abs((points - place) @ np.linalg.inv(matrix).T) <= 1).all(axis=-1)
    met = region.crossed(EYE, directions)
    assert met.any() and not met.all()
    assert (met != inside.any(axis=0)).mean() < 0.005  # steps of 1 cm jump over a corner
    assert region.crossed(places[0], directions).all(), "from within in every direction"


@pytest.mark.parametrize("azimuths", [(0.0,), (75.0,), (190.0,), (300.0,), (165.0, 200.0), (350.0, 20.0), (200.0, 165.0, 40.0)])
def test_the_curtain_holds_the_whole_of_both_bows_of_every_sun_that_is_near_the_best_one(azimuths):
    suns = [toward(15, azimuth) for azimuth in azimuths]
    view = looking(5, azimuths[0] + 180)
    made = curtain(suns, view, (3.0, -4.0, 2.0), 100.0, 50.0)
    forward = np.array([-np.sin(made.turn), np.cos(made.turn), 0.0])
    across = np.array([np.cos(made.turn), np.sin(made.turn), 0.0])
    if len(azimuths) == 1:
        np.testing.assert_allclose(forward[:2], -suns[0][:2] / np.linalg.norm(suns[0][:2]), atol=1e-12)
    for sun in suns[:2]:
        for radius in RAIN.radii:
            bow = sight.circle(sun, radius)
            bow = bow[bow[:, 2] > 0.01]
            points = np.array([3.0, -4.0, 2.0]) + bow * (120.0 / (bow @ forward))[:, None] - np.asarray(made.centre)
            assert (np.abs(points @ forward) <= made.size[1] / 2).all()
            assert (np.abs(points @ across) <= made.size[0] / 2).all()
            assert (np.abs(points[:, 2]) <= made.size[2] / 2).all()
