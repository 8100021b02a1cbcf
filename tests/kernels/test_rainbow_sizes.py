# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes are many enough: no theory shows the arcs or the ripple of the single sizes that stand for a distribution; no place of the sky stands out."""

import numpy as np
import pytest
from opal_kernels import droplets
from opal_kernels.optics import rainbow
from opal_kernels.optics.rainbow import _tables, airy, airy_function, drop_shapes, droplet
from opal_kernels.optics.rainbow.folded_bow import Fold, sum_of_sizes

SUN = np.radians(0.2666)
ANGLES = np.radians(np.linspace(90.0, 180.0, 1801))
FALLING = {"flattening": 1.0, "sun_elevation_rad": 0.31}


@pytest.mark.parametrize(
    ("theory", "radius", "spread", "distribution", "place", "error"),
    [
        ("AIRY", 250.0, 0.05, "LOG_NORMAL", {}, 0.001),
        ("AIRY", 700.0, 0.25, "GAMMA", {}, 0.001),
        ("AIRY", 300.0, 0.3, "NORMAL", {}, 0.002),
        ("AIRY", 171.0, 1.0, "MARSHALL_PALMER", {}, 0.002),
        ("DROPLET", 500.0, 0.06, "TWO_SIZES", FALLING, 0.002),
        ("DROPLET", 400.0, 0.3, "GAMMA", FALLING, 0.01),
        ("DROPLET", 171.0, 1.0, "MARSHALL_PALMER", FALLING, 0.04),
        ("MIE", 5.0, 0.05, "LOG_NORMAL", {}, 0.02),
        ("MIE", 10.0, 0.1, "LOG_NORMAL", {}, 0.025),
        ("MIE", 20.0, 0.05, "LOG_NORMAL", {}, 0.025),
        ("MIE", 60.0, 0.05, "GAMMA", {}, 0.025),
        ("MIE", 150.0, 0.05, "NORMAL", {}, 0.025),
    ],
)
def test_twice_as_many_sizes_show_the_same_bow(theory, radius, spread, distribution, place, error):
    """Under the sun, single angles from 90 to 170 degrees, against the brightest."""
    angles = ANGLES[:1601]
    nm = np.array([550.0])
    count = _tables._sizes(theory, radius, nm, spread, distribution)
    few, many = (
        rainbow.phase_function(theory, radius, nm, angles, spread, SUN, distribution=distribution, sizes=n, diffraction=False, **place)
        for n in (None, 2 * count)
    )
    assert np.abs((few - many).mean(axis=0)).max() < error * many.mean(axis=0).max()


@pytest.mark.parametrize(("diameter", "elevation", "k", "error"), [(0.85, 0.0, 1, 0.01), (1.05, 0.3, 1, 0.02), (1.05, 0.3, 2, 0.025)])
def test_folds_between_traced_drops_are_those_drops_own(diameter, elevation, k, error):
    """Between diameters, indices and places at once: caustics within 0.015 degrees, the bow (fringes smoothed over 1.2 degrees) within 2 per cent or so."""
    n, x = 1.3343, np.pi * diameter / 550e-6
    shape = droplet.Shape(1.0, elevation, 0.0)
    below = int(diameter / 0.1)
    t = diameter / 0.1 - below
    angles = np.linspace(0.5, np.pi, 4000)
    for clock in (0.2, 0.9, 1.4, 2.4):
        true = droplet.fold(n, k, shape.surface(diameter), elevation, clock)
        pair = [droplet.fold_near(n, k, shape.surface(0.1 * i), elevation, clock) for i in (below, below + 1)]
        between = Fold.combined(pair, (1 - t, t), (1 - t) * pair[0].angle + t * pair[1].angle)
        assert np.degrees(abs(between.angle - true.angle)) < 0.015
        moved = Fold.combined(pair, (1 - t, t), true.angle)
        one, other = (np.convolve(f.intensity(angles, x).mean(axis=0), np.ones(30) / 30, "same") for f in (true, moved))
        assert np.abs(one - other).max() < error * one.max()


def test_many_sizes_at_once_are_the_uniform_approximation_of_each():
    """Against the formula written out: Chester, Friedman and Ursell 1957, on the curves of two folds and those between them."""
    folds = [droplet.fold(1.334, 1, drop_shapes.falling(d), 0.2, 0.3) for d in (0.9, 1.0)]
    place, share = np.array([0.0, 0.4, 1.0]), np.array([0.5, 0.3, 0.2])
    x = np.array([5100.0, 5300.0, 5700.0])
    caustics = np.interp(place, [0, 1], [f.angle for f in folds])
    angles = np.radians(np.linspace(136.0, 150.0, 700))
    expected = np.zeros((2, angles.size))
    for p, caustic, size, part in zip(place, caustics, x, share, strict=True):
        fold = Fold.combined(folds, (1 - p, p), caustic)
        delta = angles - caustic
        dark = np.linspace(-np.radians(6), 0, 41)[:-1]
        s = np.linspace(0, 1, 500)[1:]
        at = np.concatenate([dark, (s * (0.3 + 0.7 * s)) ** 2 * fold.last])
        curve = [np.interp(delta, at, row) for row in fold.curves]
        scale = size ** (2 / 3) * curve[4]
        value, slope = airy_function.airy(-scale * delta)
        for j in range(2):
            expected[j] += part * np.pi * (curve[j] * np.sqrt(scale) * value**2 + curve[2 + j] / np.sqrt(scale) * slope**2)
    summed = sum_of_sizes(folds, place, caustics, x, share, angles)
    np.testing.assert_allclose(summed, expected, atol=2e-3 * expected.max())


@pytest.mark.parametrize("k", [1, 2, 5])
def test_airys_bow_as_a_fold_is_airys_bow(k):
    angles = np.radians(np.linspace(100.0, 170.0, 3000))
    expected = airy.bow(angles, 1.334, 2856.0, k)
    np.testing.assert_allclose(airy.as_fold(1.334, k).intensity(angles, 2856.0), expected, atol=1e-9 * expected.max())


@pytest.mark.parametrize("elevation", [0.05, 0.31])
def test_between_the_places_of_a_table_the_bow_is_one(elevation):
    """A twinned bow half way between two places of the sky that its table holds: the mean of theirs, within 4 per cent of the peak, moves nowhere."""
    clocks = droplets.Drops(theory="DROPLET", flattening=1.0).clocks()

    def bow(clock):
        return rainbow.phase_function(
            "DROPLET", 500.0, [550.0], ANGLES, 0.06, SUN, distribution="TWO_SIZES", diffraction=False, flattening=1.0,
            sun_elevation_rad=elevation, clock_rad=float(clock),
        ).mean(axis=0)[0]  # fmt: skip

    for i in (5, 12, 18):
        middle, mean = bow((clocks[i] + clocks[i + 1]) / 2), (bow(clocks[i]) + bow(clocks[i + 1])) / 2
        assert np.abs(middle - mean).max() < 0.04 * middle.max()
