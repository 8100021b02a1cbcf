# SPDX-License-Identifier: GPL-3.0-or-later
"""Dispersion, species and Fresnel against handbook values, published tables and closed forms."""

import csv
from pathlib import Path

import numpy as np
import pytest
from opal_kernels.optics import colour, dispersion, fresnel, illuminants, species

REFERENCE = Path(__file__).resolve().parents[1] / "reference_data"
TABLE_NAMES = {
    "DIAMOND": "diamond (Peter 1923)",
    "RUBY": "sapphire o (Malitson&Dodge 1972)",
    "QUARTZ": "quartz o (Ghosh 1999)",
    "FUSED_SILICA": "fused silica (Malitson 1965)",
    "SPINEL": "spinel (Tropf&Thomas)",
    "CUBIC_ZIRCONIA": "cubic zirconia 12% Y2O3 (Wood&Nassau 1982)",
    "YAG": "YAG (Zelmon 1998)",
    "STRONTIUM_TITANATE": "SrTiO3 (Bond/Dodge)",
    "BK7": "N-BK7 (Schott)",
    "SF10": "SF10 (Schott)",
    "SF11": "SF11 (Schott)",
    "MOISSANITE": "moissanite 6H o (Wang 2013)",
    "EMERALD": "emerald o (Cauchy fit)",
    "TOPAZ": "topaz (mean) (Cauchy fit)",
    "ZIRCON": "zircon high o (Cauchy fit)",
    "PYROPE": "pyrope (Cauchy fit)",
    "ALMANDINE": "almandine (Cauchy fit)",
    "SPESSARTINE": "spessartine (Cauchy fit)",
    "DEMANTOID": "demantoid (Cauchy fit)",
    "TOURMALINE": "tourmaline o (Cauchy fit)",
    "PERIDOT": "peridot (mean) (Cauchy fit)",
    "ALEXANDRITE": "chrysoberyl (mean) (Cauchy fit)",
    "TANZANITE": "tanzanite (mean) (Cauchy fit)",
    "WATER": "water 20C (Daimon)",
}


def rows(name):
    with open(REFERENCE / name, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


@pytest.mark.parametrize("name", TABLE_NAMES)
def test_indices_are_those_of_the_reference_table(name):
    row = next(row for row in rows("gem_indices.csv") if row["material"] == TABLE_NAMES[name])
    n = species.index(name, np.array([589.3, 400, 450, 550, 650, 700]))
    expected = [float(row[key]) for key in ("nD_589.3", "n400", "n450", "n550", "n650", "n700")]
    np.testing.assert_allclose(n, expected, atol=2e-6)
    assert np.degrees(dispersion.critical_angle(n[0])) == pytest.approx(float(row["critical_deg"]), abs=2e-4)
    assert np.degrees(dispersion.brewster_angle(n[0])) == pytest.approx(float(row["brewster_deg"]), abs=2e-4)
    assert fresnel.reflectance(1.0, n[0]) == pytest.approx(float(row["R0"]), abs=2e-6)
    assert dispersion.b_to_g(lambda nm: species.index(name, nm)) == pytest.approx(float(row["B-G"]), abs=3e-6)


@pytest.mark.parametrize(("name", "abbe"), [("BK7", 64.17), ("SF10", 28.41), ("SF11", 25.76)])
def test_abbe_numbers_are_those_of_the_catalogue(name, abbe):
    assert dispersion.abbe_number(lambda nm: species.index(name, nm)) == pytest.approx(abs(abbe), abs=0.015)


@pytest.mark.parametrize(
    ("name", "n_d"), [("RUBY", 1.76000), ("QUARTZ", 1.55331), ("MOISSANITE", 2.68897), ("ZIRCON", 1.984), ("EMERALD", 1.577)]
)
def test_the_extraordinary_ray_has_its_own_index(name, n_d):
    assert species.index(name, 589.3, ray="e") == pytest.approx(n_d, abs=1e-5)


def test_a_species_with_one_ray_gives_it_for_both():
    assert species.index("DIAMOND", 550, ray="e") == species.index("DIAMOND", 550)


def test_there_are_at_least_24_species_with_sources():
    table = species.table()
    assert len(table) >= 24
    for row in table.values():
        assert row.label and row.source and row.density > 0, row.name
        assert row.absorption_source or not (row.bands or row.curve), row.name


@pytest.mark.parametrize("name", list(species.table()))
def test_every_species_is_physical_over_the_spectrum(name):
    n, sigma = species.index(name, colour.WAVELENGTHS_NM), species.absorption(name, colour.WAVELENGTHS_NM)
    assert np.isfinite(n).all() and n.min() > 1 and n.max() < 3
    assert (np.diff(n) < 0).all(), "dispersion is normal"
    assert np.isfinite(sigma).all() and sigma.min() >= 0


def test_an_unknown_species_is_refused_with_the_names_there_are():
    with pytest.raises(KeyError, match="DIAMOND"):
        species.index("PLASTIC", 550)


def through(name, lamp, metres):
    """Colour of a lamp seen through a stone, relative to the lamp's own: what an adapted eye sees."""
    seen = colour.rec709(lamp * np.exp(-species.absorption(name, colour.WAVELENGTHS_NM) * metres))
    return seen, seen / colour.rec709(lamp)


# The bands of this and the next test were adjusted to these colours: they guard the table, they do not confirm it.
@pytest.mark.parametrize("millimetres", [3, 4, 6])
def test_alexandrite_is_green_by_day_and_red_by_lamplight(millimetres):
    day, _ = through("ALEXANDRITE", illuminants.lamp("D65"), millimetres * 1e-3)
    lamp, adapted = through("ALEXANDRITE", illuminants.blackbody(2800), millimetres * 1e-3)
    assert day[1] > 1.25 * day[0] and day[1] > 1.2 * day[2]
    assert lamp[0] > 3 * lamp[1] and adapted[0] > 1.25 * max(adapted[1], adapted[2])


@pytest.mark.parametrize(
    ("name", "strongest", "weakest"),
    [("RUBY", 0, 1), ("SAPPHIRE_BLUE", 2, 0), ("SAPPHIRE_YELLOW", 0, 2), ("EMERALD", 1, 0), ("AMETHYST", 2, 1)]
    + [("CITRINE", 0, 2), ("PERIDOT", 0, 2), ("SPINEL", 0, 1), ("PYROPE", 0, 1), ("DEMANTOID", 1, 0), ("TANZANITE", 2, 0)],
)
def test_stones_have_the_colours_they_are_known_by(name, strongest, weakest):
    rgb, _ = through(name, illuminants.lamp("D65"), 6e-3)
    assert (rgb.argmax(), rgb.argmin()) == (strongest, weakest), rgb


def test_a_band_has_its_height_and_half_width():
    sigma = species.gaussian_bands([(20000, 2000, 0.5)], 1e7 / np.array([20000, 21000, 19000]))
    np.testing.assert_allclose(sigma, [500, 250, 250])


def test_the_handbook_cauchy_returns_what_it_was_made_from():
    a, b = dispersion.cauchy_from_handbook(1.888, 0.057)
    assert (a, b) == (pytest.approx(1.837769, abs=1e-6), pytest.approx(0.017444, abs=1e-6))


def test_air_is_ciddors():
    assert dispersion.air(589.3) - 1 == pytest.approx(2.771e-4, abs=3e-7)


def test_minimum_deviation_of_a_prism_matches_snell():
    names = {"N-BK7 (Schott)": "BK7", "SF11 (Schott)": "SF11"}
    checked = 0
    for row in rows("prism_min_deviation.csv"):
        if row["material"] in names:
            n = species.index(names[row["material"]], float(row["lambda_nm"]))
            deviation = np.degrees(dispersion.minimum_deviation(n, np.radians(float(row["apex_deg"]))))
            assert deviation == pytest.approx(float(row["min_deviation_deg"]), abs=1e-4)
            checked += 1
    assert checked >= 16


def test_a_diamond_prism_of_60_degrees_lets_nothing_through():
    with pytest.raises(ValueError, match="no ray"):
        dispersion.minimum_deviation(2.41726, np.radians(60))
    assert dispersion.minimum_deviation(2.41726, np.radians(40)) > 0


@pytest.mark.parametrize(
    ("n", "degrees", "r_s", "r_p"),
    [(1.5, 45, 0.092013, 0.008466), (1.5, 60, 0.176571, 0.001802), (1.5, 75, 0.399356, 0.106765), (2.4173, 45, 0.282505, 0.079809)],
)
def test_fresnel_reflectances(n, degrees, r_s, r_p):
    np.testing.assert_allclose(fresnel.polarised_reflectance(np.cos(np.radians(degrees)), n), [r_s, r_p], atol=1e-6)


@pytest.mark.parametrize(
    ("n", "degrees", "r"),
    [(1.5, 85, 0.612800), (2.4173, 60, 0.211295), (2.4173, 85, 0.621700), (1.333, 60, 0.059691), (1.333, 85, 0.583523)],
)
def test_unpolarised_reflectances(n, degrees, r):
    assert fresnel.reflectance(np.cos(np.radians(degrees)), n) == pytest.approx(r, abs=1e-6)


@pytest.mark.parametrize(
    ("n", "external", "internal"), [(1.333, 0.066406, 0.474591), (1.5, 0.091778, 0.596346), (2.4173, 0.212223, 0.865184)]
)
def test_diffuse_reflectances(n, external, internal):
    assert fresnel.diffuse_reflectance(n) == pytest.approx(external, abs=2e-6)
    assert fresnel.diffuse_reflectance(1 / n) == pytest.approx(internal, abs=2e-5)


def test_total_reflection_switches_at_the_critical_angle():
    n = float(species.index("DIAMOND", 589.3))
    below, above = np.cos(np.radians([24.427, 24.447]))
    assert fresnel.reflectance(below, 1 / n) < 0.9
    assert fresnel.reflectance(above, 1 / n) == pytest.approx(1, abs=1e-12)


def test_total_reflection_phases_are_those_of_the_amplitudes():
    cosines = np.cos(np.radians([45, 60, 80]))
    for amplitude, delta, sign in zip(
        fresnel.amplitudes(cosines, 1 / 1.5), fresnel.total_reflection_phases(cosines, 1 / 1.5), (1, 1), strict=True
    ):
        np.testing.assert_allclose(np.cos(np.angle(amplitude)), np.cos(sign * delta), atol=1e-12)
    assert fresnel.total_reflection_phases(0.99, 1 / 1.5) == (0, 0)


def test_fresnel_rhomb_makes_circular_light():
    # Born and Wolf 1.5.4: for n = 1.51 two total reflections at 54 deg 37 min differ by 45 degrees each.
    delta_s, delta_p = fresnel.total_reflection_phases(np.cos(np.radians(54 + 37 / 60)), 1 / 1.51)
    assert np.degrees(delta_p - delta_s) == pytest.approx(45, abs=0.05)


def test_schlick_errs_no_more_than_known():
    for row in rows("fresnel_schlick.csv"):
        n, limit = float(row["n"]), float(row["ext_max_abs_err"])
        cosines = np.cos(np.linspace(0, np.pi / 2, 4001))
        for eta in (n, 1 / n):
            error = np.abs(fresnel.schlick(cosines, eta) - fresnel.reflectance(cosines, eta)).max()
            assert error == pytest.approx(abs(limit), abs=5e-4), (n, eta)


def test_a_chain_keeps_polarisation():
    cos_i = np.cos(np.radians(56.3099))
    cos_t = np.sqrt(1 - (1 - cos_i**2) / 1.5**2)
    assert fresnel.chain([("T", cos_i, 1.5), ("T", cos_t, 1 / 1.5)]) == pytest.approx(0.863012, abs=1e-6)
    with pytest.raises(ValueError, match="R or T"):
        fresnel.chain([("X", 1, 1.5)])
