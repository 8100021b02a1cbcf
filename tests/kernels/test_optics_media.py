# SPDX-License-Identifier: GPL-3.0-or-later
"""Phase functions and closed forms of media against integrals, samples and published numbers."""

import csv
from pathlib import Path

import numpy as np
import pytest
from opal_kernels.optics import media, phase_functions

REFERENCE = Path(__file__).resolve().parents[1] / "reference_data"
ANGLES = np.linspace(0, np.pi, 721)
TABLE = phase_functions.Table(ANGLES, np.exp(-3 * ANGLES) + 0.3 * np.exp(-(((ANGLES - 2.4) / 0.05) ** 2)))

KINDS = {
    "isotropic": (phase_functions.isotropic, phase_functions.sample_isotropic, 0.0),
    "rayleigh": (phase_functions.rayleigh, phase_functions.sample_rayleigh, 0.0),
    "table": (TABLE.value, TABLE.sample, TABLE.mean_cosine()),
    **{
        f"g={g}": (
            lambda c, g=g: phase_functions.henyey_greenstein(c, g),
            lambda u, g=g: phase_functions.sample_henyey_greenstein(u, g),
            g,
        )
        for g in (-0.5, 1e-5, 0.3, 0.9)
    },
}


@pytest.mark.parametrize("kind", KINDS)
def test_phase_functions_integrate_to_one_and_have_their_mean_cosine(kind):
    value, _, g = KINDS[kind]
    edges = np.cos(np.linspace(np.pi, 0, 40001))
    middle, width = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
    assert 2 * np.pi * (value(middle) * width).sum() == pytest.approx(1, abs=1e-5)
    assert 2 * np.pi * (value(middle) * middle * width).sum() == pytest.approx(g, abs=1e-5)


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_sampled_is_the_phase_function(kind):
    value, sample, _ = KINDS[kind]
    # u on a grid: the sampled cosines are then quantiles, and the integral of the value up to each of them must be u.
    u = np.linspace(0.001, 0.999, 999)
    cosine = sample(u)
    assert (np.diff(cosine) > 0).all()
    fine = np.cos(np.linspace(np.pi, 0, 200001))
    middle = (fine[1:] + fine[:-1]) / 2
    cumulative = np.append(0, np.cumsum(2 * np.pi * value(middle) * np.diff(fine)))
    np.testing.assert_allclose(np.interp(cosine, fine, cumulative), u, atol=3e-5)


@pytest.mark.parametrize(
    ("angles", "values"),
    [([0, 1, np.pi], [1, -1, 1]), ([0, 1, np.pi], [0, 0, 0]), ([0, 1, 2], [1, 1, 1]), ([0, np.pi], [1, np.nan]), ([0, 1, np.pi], [1, 1])],
)
def test_impossible_tables_are_refused(angles, values):
    with pytest.raises(ValueError):
        phase_functions.Table(angles, values)


@pytest.mark.parametrize(
    ("n", "depth", "t", "r"),
    [(1.5, 0, 0.923077, 0.076923), (1.5, 1, 0.339111, 0.044990), (2.4173, 0.5, 0.420392, 0.215871), (2.4173, 2, 0.092831, 0.174172)],
)
def test_a_plate_with_inner_reflections(n, depth, t, r):
    np.testing.assert_allclose(media.coated_slab(n, depth), [t, r], atol=1e-6)


def test_single_scattering_in_a_slab():
    with open(REFERENCE / "single_scatter_slab.csv", encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            got = media.single_scattering_slab(float(row["tau"]), float(row["mu0"]), float(row["mu"]))
            np.testing.assert_allclose(got, [float(row["Lr_over_wF"]), float(row["Lt_over_wF"])], rtol=1e-6)


@pytest.mark.parametrize(
    ("distance", "extinction", "expected"),
    [(1, 0, 0.17620819), (1, 0.1, 0.12718907), (1, 0.5, 0.03714498), (0.1, 0, 2.42048874), (0.1, 0.1, 1.93599726), (0.1, 0.5, 0.80336020)],
)
def test_airlight(distance, extinction, expected):
    assert media.airlight(distance, -2, 2, extinction) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(("albedo", "rate"), [(0.9, 0.525430), (0.99, 0.172511), (0.999, 0.054750)])
def test_light_decays_at_the_diffusion_rate(albedo, rate):
    assert media.attenuation_rate(albedo) == pytest.approx(rate, abs=1e-6)


def test_beer_lambert_and_the_integrating_sphere():
    np.testing.assert_allclose(media.transmittance(0.5, np.array([1, 2, 4])), [0.606531, 0.367879, 0.135335], atol=1e-6)
    assert [media.sphere_multiplier(r) for r in (0.2, 0.5, 0.8, 0.9)] == pytest.approx([1.25, 2, 5, 10])


@pytest.mark.parametrize(
    ("albedo", "normal", "diffuse"),
    [
        (0.5, 0.115226, 0.146544),
        (0.8, 0.285255, 0.341867),
        (0.9, 0.414947, 0.478024),
        (0.95, 0.535541, 0.596669),
        (0.99, 0.752721, 0.794564),
        (0.999, 0.912845, 0.929713),
    ],
)
def test_a_half_space_reflects_what_chandrasekhar_says(albedo, normal, diffuse):
    assert media.half_space_albedo(1.0, albedo) == pytest.approx(normal, abs=2e-6)
    assert media.half_space_diffuse_albedo(albedo) == pytest.approx(diffuse, abs=2e-5)


def test_the_h_function_of_a_half_space_that_absorbs_nothing():
    assert media.chandrasekhar_h(1.0, 1.0) == pytest.approx(2.907811, abs=2e-5)  # Chandrasekhar: 2.9078
