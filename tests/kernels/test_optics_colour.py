# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour: published sums and chromaticities, the white, Planck's law, and the uplift's round trips."""

import numpy as np
import pytest
from opal_kernels.optics import colour, illuminants, uplift


def chromaticity(spectrum):
    xyz = colour.xyz(spectrum)
    return xyz[:2] / xyz.sum()


def test_the_observer_has_the_published_sums():
    np.testing.assert_allclose(colour.observer().sum(axis=1), [106.8654, 106.8570, 106.8921], atol=2e-4)


def test_d65_has_its_published_chromaticity():
    np.testing.assert_allclose(chromaticity(colour.d65()), [0.31272, 0.32903], atol=2e-5)  # CIE 15:2018


def test_d65_is_white():
    np.testing.assert_allclose(colour.rec709(colour.white()), 1.0, atol=1e-12)
    assert colour.xyz(colour.white())[1] == pytest.approx(1)


def test_the_matrix_is_that_of_rec709():
    published = [[3.2409699, -1.5373832, -0.4986108], [-0.9692436, 1.8759675, 0.0415551], [0.0556301, -0.2039770, 1.0569715]]
    np.testing.assert_allclose(colour.rec709_from_xyz(), published, rtol=3e-4)


def test_a_flat_spectrum_is_pinkish():
    np.testing.assert_allclose(colour.rec709(np.ones(471)), [1.2049, 0.9482, 0.9092], atol=2e-4)


def test_monochromatic_light_of_550_nm():
    np.testing.assert_allclose(colour.observer()[:, 190], [0.43345, 0.99495, 0.00875], atol=1e-5)


@pytest.mark.parametrize(("kelvin", "red", "blue"), [(2800, 2.2926, 0.2669), (6500, 1.0594, 1.0520)])
def test_black_bodies_have_the_colours_that_cycles_gives(kelvin, red, blue):
    rgb = colour.blackbody_rec709(kelvin)
    np.testing.assert_allclose(rgb / rgb[1], [red, 1, blue], rtol=1.5e-3)
    assert colour.luminance(rgb) == pytest.approx(1)


def test_planck_integrates_to_stefan_boltzmann():
    nm = np.geomspace(50, 1e6, 20001)
    radiance = colour.planck(5000, nm)
    total = np.pi * ((radiance[1:] + radiance[:-1]) / 2 * np.diff(nm)).sum()
    assert total == pytest.approx(5.670374419e-8 * 5000**4, rel=1e-5)


def test_planck_peaks_where_wien_says():
    nm = np.arange(300, 900, 0.01)
    assert nm[colour.planck(5772, nm).argmax()] == pytest.approx(2.897771955e6 / 5772, abs=0.02)


@pytest.mark.parametrize(
    ("lamp", "xy"), [("A", (0.44758, 0.40745)), ("F2", (0.3721, 0.3751)), ("F11", (0.3805, 0.3769)), ("LED", (0.3756, 0.3723))]
)
def test_illuminants_have_their_published_chromaticities(lamp, xy):
    np.testing.assert_allclose(chromaticity(illuminants.lamp(lamp)), xy, atol=3e-4)


def test_every_lamp_has_luminance_one():
    for name in illuminants.LAMPS:
        assert colour.xyz(illuminants.lamp(name))[1] == pytest.approx(1), name


def test_a_line_between_samples_keeps_its_wavelength():
    spectrum = illuminants.line(632.8)
    assert (spectrum @ colour.WAVELENGTHS_NM) / spectrum.sum() == pytest.approx(632.8)


@pytest.mark.parametrize("nm", [359.9, 831, np.nan])
def test_a_line_outside_the_range_is_refused(nm):
    with pytest.raises(ValueError, match="360-830"):
        illuminants.line(nm)


def test_a_curve_needs_finite_samples():
    with pytest.raises(ValueError, match="at least one"):
        colour.resample([], [])
    with pytest.raises(ValueError, match="finite"):
        colour.resample([400, 500], [1, np.nan])


def test_the_basis_is_a_partition_of_one():
    basis = uplift.basis()
    assert basis.shape == (3, 471) and basis.min() >= 0 and basis.max() <= 1
    np.testing.assert_allclose(basis.sum(axis=0), 1, atol=1e-12)


def test_the_basis_round_trips_exactly():
    np.testing.assert_allclose(colour.rec709(uplift.emission(np.eye(3))), np.eye(3), atol=1e-7)


def test_products_of_reflectances_behave_like_products_of_rgb():
    basis, unit = uplift.basis(), np.eye(3)
    error = [colour.rec709(colour.white() * basis[i] * basis[j]) - (unit[i] if i == j else 0) for i in range(3) for j in range(3)]
    assert np.sqrt(np.mean(np.square(error))) < 0.02  # Mallett and Yuksel's own table has 0.045
    assert np.abs(error).max() < 0.03


COLOURS = [(0.8, 0.1, 0.05), (0.18, 0.18, 0.18), (0.02, 0.3, 0.9), (0.5, 0.9, 0.1), (1, 1, 1), (0, 0, 0), (0.9, 0.9, 0.2)]


@pytest.mark.parametrize("rgb", COLOURS)
def test_the_smooth_fit_round_trips(rgb):
    spectrum = uplift.smooth_reflectance(rgb)
    assert spectrum.min() >= 0 and spectrum.max() <= 1
    np.testing.assert_allclose(colour.rec709(spectrum * colour.white()), rgb, atol=1.1e-4)


@pytest.mark.parametrize("rgb", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1)])
def test_the_smooth_fit_holds_on_the_edge_of_the_gamut(rgb):
    np.testing.assert_allclose(colour.rec709(uplift.smooth_reflectance(rgb) * colour.white()), rgb, atol=1e-3)


def test_absorption_turns_white_into_its_colour():
    sigma = uplift.absorption((0.6, 0.1, 0.2), 0.005)
    np.testing.assert_allclose(colour.rec709(colour.white() * np.exp(-sigma * 0.005)), (0.6, 0.1, 0.2), atol=1e-5)


@pytest.mark.parametrize(("rgb", "depth"), [((1.2, 0, 0), 1), ((0.5, np.nan, 0), 1), ((0.5, 0.5, 0.5), 0), ((0.5, 0.5, 0.5), -1)])
def test_impossible_absorption_is_refused(rgb, depth):
    with pytest.raises(ValueError):
        uplift.absorption(rgb, depth)
