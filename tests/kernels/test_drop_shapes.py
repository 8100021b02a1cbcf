# SPDX-License-Identifier: GPL-3.0-or-later
"""Falling drops have the shapes that were measured: Chuang and Beard's series, its volume, its axis ratio, its flat base."""

import numpy as np
import pytest
from opal_kernels.optics.rainbow import drop_shapes

# Axis ratios of the series itself, by its greatest width, for diameters in mm.
RATIOS = {1.0: 0.9836731654, 1.5: 0.9592341256, 2.0: 0.9258601783, 3.0: 0.8468674523, 5.0: 0.7000008173, 6.0: 0.6409411963}


def volume(surface):
    """Over a unit sphere's."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    return 0.5 * weights @ surface.radius(nodes)[0] ** 3


@pytest.mark.parametrize(("diameter", "ratio"), RATIOS.items())
def test_the_series_has_its_axis_ratio(diameter, ratio):
    assert drop_shapes.falling(diameter).ratio == pytest.approx(ratio, abs=1e-5)


@pytest.mark.parametrize("diameter", [0.2, 0.7, 1.0, 1.3, 2.2, 4.5, 6.0, 9.0])
@pytest.mark.parametrize("flattening", [0.0, 0.5, 1.0, 2.0])
def test_every_drop_has_the_volume_of_its_sphere(diameter, flattening):
    assert volume(drop_shapes.falling(diameter, flattening)) == pytest.approx(1, abs=1e-12)


def test_the_tables_own_volumes_are_a_spheres():
    """The printed coefficients keep the volume to 3e-4, so that scaling them to 1 exactly changes nothing that was measured."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    for diameter in drop_shapes.DIAMETERS_MM:
        series = drop_shapes.coefficients(diameter) + np.eye(11)[0]
        raw = 0.5 * weights @ np.polynomial.chebyshev.chebval(nodes, series) ** 3
        assert raw == pytest.approx(1, abs=3.2e-4)


def test_small_drops_are_round_and_join_the_table_without_a_step():
    assert drop_shapes.falling(0.05) == drop_shapes.SPHERE
    for diameter in (0.5, 0.7, 0.9):  # the papers of 1987 and 1990 differ by 0.0011 in the ratio at 1 mm
        assert drop_shapes.falling(diameter).ratio == pytest.approx(drop_shapes.axis_ratio(500 * diameter), abs=1.1e-3)
    for d in drop_shapes.DIAMETERS_MM[:-1]:
        below, above = drop_shapes.coefficients(d - 1e-7), drop_shapes.coefficients(d + 1e-7)
        np.testing.assert_allclose(below, above, atol=1e-8)


def test_between_the_tables_diameters_the_ratio_falls_steadily():
    ratios = [drop_shapes.falling(float(d)).ratio for d in np.arange(0.4, 6.05, 0.1)]
    assert (np.diff(ratios) < 0).all()
    assert drop_shapes.falling(3.5).ratio == pytest.approx((0.8468674523 + 0.7688447841) / 2, abs=2e-3)


def test_the_base_is_flatter_than_the_top():
    for diameter in (2.0, 5.0):
        surface = drop_shapes.falling(diameter)
        pole, slope = (np.array(v) for v in zip(*(surface.radius(np.array([c])) for c in (1.0, -1.0)), strict=True))
        # Radius of curvature at a pole of r(c): r^2/(r + r'_c) above, r^2/(r - r'_c) below.
        top, base = pole[0] ** 2 / (pole[0] + slope[0]), pole[1] ** 2 / (pole[1] - slope[1])
        assert base > 1.1 * top > 0


def test_flattening_scales_the_coefficients():
    half, full = (drop_shapes.falling(2.0, f).series for f in (0.5, 1.0))
    np.testing.assert_allclose(half, 0.5 * np.array(full))
    assert drop_shapes.falling(2.0, 0.0) == drop_shapes.SPHERE


@pytest.mark.parametrize("surface", [drop_shapes.falling(3.0), drop_shapes.Spheroid(0.8)])
def test_slopes_are_derivatives(surface):
    c = np.linspace(-0.99, 0.99, 41)
    difference = (surface.radius(c + 1e-6)[0] - surface.radius(c - 1e-6)[0]) / 2e-6
    np.testing.assert_allclose(surface.radius(c)[1], difference, atol=1e-8)
