# SPDX-License-Identifier: GPL-3.0-or-later
"""Bows where the sky has them: rays, Airy, Lorenz-Mie and the traced drop against tables and against each other."""

import csv
from pathlib import Path

import numpy as np
import pytest
from opal_kernels.charts import rainbow_data
from opal_kernels.optics import colour, rainbow
from opal_kernels.optics.rainbow import airy, airy_function, descartes, drop_shapes, droplet, drops, geometric, mie, sun, water

REFERENCE = Path(__file__).resolve().parents[1] / "reference_data"
SUN = sun.MEAN_RADIUS_RAD


def table(name):
    return np.genfromtxt(REFERENCE / name, delimiter=",", names=True)


def bow_angles(first=34.0, last=60.0, step=0.02):
    """Angles over both bows and their radii (degrees from the antisolar point)."""
    radius = np.arange(first, last, step)
    return np.radians(180 - radius), radius


# ---- Water and rays -------------------------------------------------------------------------------------------------


def test_water_has_its_published_index():
    rows = table("water_index.csv")
    nm = rows["lambda_nm"]
    np.testing.assert_allclose(water.daimon(nm), rows["n_Daimon2007_20C_abs"], atol=1e-9)
    np.testing.assert_allclose(water.index(nm), rows["n_Daimon_rel_air"], atol=1e-8)
    np.testing.assert_allclose(water.iapws(nm, 10.0), rows["n_IAPWS97_10C_abs"], atol=2e-7)
    assert water.iapws(589.3, 25.0, 997.047435) == pytest.approx(1.3328581926, abs=1e-9)


def test_sea_water_refracts_more():
    # Quan and Fry 1995: 35 parts per thousand raise the index by about 0.0065; the primary shrinks by 0.9 degrees.
    shift = water.index(550.0, salinity=35.0) - water.index(550.0)
    assert shift == pytest.approx(0.0065, abs=3e-4)


@pytest.mark.parametrize(("celsius", "salinity"), [(-1, 0), (101, 0), (20, -1), (np.nan, 0)])
def test_impossible_water_is_refused(celsius, salinity):
    with pytest.raises(ValueError):
        water.index(550.0, celsius, salinity)


def test_caustics_lie_where_the_table_has_them():
    rows = table("rainbow_caustics.csv")
    for k in (1, 2):
        n = rows["n_rel_air"]
        np.testing.assert_allclose(np.degrees(geometric.bow_radius(n, k)), rows[f"bowradius_k{k}_rel"], atol=1e-6)
        np.testing.assert_allclose(np.degrees(geometric.caustic_incidence(n, k)), rows[f"i_k{k}_rel"], atol=1e-6)


@pytest.mark.parametrize(("k", "deviation"), [(3, 318.26), (4, 403.70), (5, 488.23)])
def test_higher_orders_have_their_deviations(k, deviation):
    assert np.degrees(geometric.caustic_deviation(1.333, k)) == pytest.approx(deviation, abs=6e-3)


def test_a_glass_bead_bow_has_22_degrees():
    assert np.degrees(geometric.bow_radius(1.51, 1)) == pytest.approx(22.0, abs=0.6)


@pytest.mark.parametrize("k", [1, 2, 3])
def test_the_angle_gives_the_index_back(k):
    n = np.linspace(1.2, 1.6, 9)
    np.testing.assert_allclose(geometric.index_of_deviation(geometric.caustic_deviation(n, k), k), n, atol=1e-12)
    assert np.isnan(geometric.index_of_deviation((k + 0.5) * np.pi, k))


def test_the_primary_has_its_closed_inverse():
    i = geometric.caustic_incidence(1.334, 1)
    t = np.tan(i)
    assert np.tan(geometric.bow_radius(1.334, 1) / 2) == pytest.approx(t**3 / (4 + 3 * t**2))


def test_the_angle_gives_the_wavelength_back():
    nm = np.arange(380.0, 781)
    angles = geometric.caustic_deviation(water.index(np.array([420.0, 600.0])), 1)
    np.testing.assert_allclose(descartes.wavelength_at(angles, 1, nm, water.index(nm)), [420, 600], atol=1e-3)


@pytest.mark.parametrize(("k", "perpendicular", "polarisation"), [(1, 0.0877915, 0.9241), (2, 0.03515625, 0.8071)])
def test_light_at_the_caustic_is_polarised_as_known(k, perpendicular, polarisation):
    sine = np.sin(geometric.caustic_incidence(1.333, k))
    s, p = (t**2 for t in geometric.amplitudes(sine, 1.333, k))
    assert s == pytest.approx(perpendicular, abs=1e-7)
    assert (s - p) / (s + p) == pytest.approx(polarisation, abs=1e-4)


def test_all_orders_together_carry_all_light():
    edges = np.linspace(0, np.pi, 361)
    total = sum(geometric.energy(1.333, k, edges).sum(axis=1) for k in range(-1, 40))
    np.testing.assert_allclose(total, 1, atol=5e-6)


# ---- Airy -----------------------------------------------------------------------------------------------------------


def test_airys_function_has_its_published_values():
    x = np.array([0, 1, 2, 5, 8, -1, -2.338107410459767, -5, -10, -50])
    # DLMF table 9.8 and Abramowitz and Stegun table 10.11.
    ai = [0.3550280539, 0.1352924163, 0.03492413042, 1.083444281e-4, 4.692207616e-8, 0.5355608833, 0, 0.3507610090, 0.04024123849, -0.16188]
    np.testing.assert_allclose(airy_function.airy(x)[0], ai, rtol=1e-6, atol=6e-6)
    assert airy_function.airy(0.0)[1] == pytest.approx(-0.2588194037928068)


@pytest.mark.parametrize("x", [-40.0, -7.0, -3.0, 0.7, 5.0, 9.0])
def test_airys_function_solves_its_equation(x):
    h = 1e-3
    before, after = airy_function.airy(x - h), airy_function.airy(x + h)
    value, slope = airy_function.airy(x)
    assert (after[0] - before[0]) / (2 * h) == pytest.approx(slope, rel=1e-4)
    assert (after[1] - before[1]) / (2 * h) == pytest.approx(x * value, rel=1e-3)


def test_the_table_of_squares_follows_the_function():
    x = np.linspace(-8, 40, 7919)
    value, slope = airy_function.airy(-x)
    for got, exact in zip(airy_function.squares(x), (value**2, slope**2), strict=True):
        np.testing.assert_allclose(got, exact, atol=2e-4 * exact.max())


def test_supernumeraries_stand_where_the_table_has_them():
    with open(REFERENCE / "airy_supernumeraries.csv", encoding="utf-8") as file:
        checked = 0
        for row in csv.DictReader(file):
            if float(row["radius_um"]) < 100:
                continue
            n, k, x = float(row["n_rel_air"]), int(row["k"]), float(row["x"])
            assert geometric.curvature(n, k) == pytest.approx(float(row["h"]), rel=1e-6)
            expected = [float(row[f"max{i}_radius_deg"]) for i in (1, 2, 3)]
            low, high = min(expected) - 0.5, max(expected) + 0.5
            radius = np.arange(low, high, 0.0005)
            p = airy.bow(np.radians(180 - radius), n, x, k)[0]
            tops = radius[1:-1][(p[1:-1] > p[:-2]) & (p[1:-1] > p[2:])]
            for top in expected:
                # Ai'^2 moves the maxima of the sum by a few thousandths of a degree from those of Ai^2 alone.
                assert np.abs(tops - top).min() < 0.03, (row["radius_um"], k, top)
            checked += 1
    assert checked >= 6


@pytest.mark.parametrize("radius", [100.0, 250.0])
def test_airy_agrees_with_mie_on_the_bow(radius):
    rows = table("rainbow_mie_airy_550nm.csv")
    rows = rows[rows["radius_um"] == radius]
    bow = (rows["theta_scat_deg"] >= 137) & (rows["theta_scat_deg"] <= 143)
    p = rainbow.phase_function("AIRY", radius, [550.0], np.radians(rows["theta_scat_deg"]), sun_radius_rad=SUN)[:, 0]
    assert p[0, bow].mean() == pytest.approx(rows["p_perp_mie"][bow].mean(), rel=0.03)
    assert p[1, bow].mean() == pytest.approx(rows["p_par_mie"][bow].mean(), rel=0.03)
    peak = (rows["p_perp_mie"] + rows["p_par_mie"]).max() / 2
    assert p.mean(axis=0).max() == pytest.approx(peak, rel=0.09)


def test_airy_and_mie_at_half_a_millimetre_differ_as_the_sheet_says():
    """550 nm under the sun, a = 500 um (PHYSICS 1.3): peaks 0.0879 and 0.0874/sr, Lorenz-Mie's of one size with what is left of its ripple; over 137 to
    143 degrees Airy's perpendicular light is 6 per cent high and its parallel right."""
    degrees = np.arange(135.0, 148.0, 0.01)
    x = 2000 * np.pi * 500 / 550
    formula = rainbow_data._under_the_sun(0.5 * airy.bow(np.radians(degrees), float(water.index(550.0)), x, 1), np.radians(0.01))
    exact = rainbow.phase_function("MIE", 500.0, [550.0], np.radians(degrees), sun_radius_rad=SUN)[:, 0]
    assert formula.mean(axis=0).max() == pytest.approx(0.0879, abs=2e-4)
    assert exact.mean(axis=0).max() == pytest.approx(0.0874, abs=2e-4)
    bow = (degrees > 137) & (degrees < 143)
    ratio = formula[:, bow].mean(axis=1) / exact[:, bow].mean(axis=1)
    assert ratio == pytest.approx([1.06, 1.0], abs=0.01)


def test_the_second_airy_term_carries_the_parallel_component():
    n, x = 1.3343, 2856.0
    _, _, _, t0, t1 = airy.caustic(n, 1)
    assert abs(t0[1]) == pytest.approx(0.0579, abs=1e-4) and abs(t1[1]) == pytest.approx(1.223, abs=1e-3)
    angles = np.radians(np.linspace(138.5, 143, 901))
    assert airy.bow(angles, n, x, 1)[1].mean() > 3 * (airy.bow(angles, n, x, 1)[0] * (t0[1] / t0[0]) ** 2).mean()


# ---- Tables ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("radius", [100.0, 250.0])
def test_mie_tables_under_the_sun_agree_with_the_reference(radius):
    rows = table("rainbow_mie_airy_550nm.csv")
    rows = rows[rows["radius_um"] == radius]
    p = rainbow.phase_function("MIE", radius, [550.0], np.radians(rows["theta_scat_deg"]), sun_radius_rad=SUN)[:, 0]
    # The reference's own smoothing has steps of 0.02 degrees.
    np.testing.assert_allclose(p, [rows["p_perp_mie"], rows["p_par_mie"]], rtol=0.02)
    assert np.abs(p[0] / rows["p_perp_mie"] - 1).mean() < 0.003


@pytest.mark.parametrize("theory", rainbow.THEORIES)
@pytest.mark.parametrize("radius", [60.0, 300.0])
def test_every_table_integrates_to_one_and_has_lorenz_mies_asymmetry(theory, radius):
    angles = np.concatenate([np.linspace(0, 0.1, 8001)[:-1], np.linspace(0.1, np.pi, 30001)])
    p = rainbow.phase_function(theory, radius, [550.0], angles)
    assert p.shape == (2, 1, angles.size) and p.min() >= 0
    f = p.mean(axis=(0, 1)) * np.sin(angles)
    assert 2 * np.pi * np.trapezoid(f, angles) == pytest.approx(1, abs=1e-4)
    # Rays know nothing of a drop's size; Lorenz-Mie's asymmetry of small drops is a little less.
    g = mie.efficiencies(water.index(550.0), 2000 * np.pi * radius / 550.0)[2]
    assert 2 * np.pi * np.trapezoid(f * np.cos(angles), angles) == pytest.approx(g, abs=1e-5 if theory == "MIE" else 0.005)


@pytest.mark.parametrize("theory", rainbow.THEORIES)
@pytest.mark.parametrize(("radius", "spread"), [(0.144, 0.0), (1.0, 0.1), (5.0, 0.05), (50.0, 0.05), (250.0, 0.05)])
def test_without_diffraction_a_table_integrates_to_one_too(theory, radius, spread):
    angles = np.concatenate([np.linspace(0, 0.3, 6001)[:-1], np.linspace(0.3, np.pi, 18001)])
    p = rainbow.phase_function(theory, radius, [550.0], angles, spread, sizes=20 if radius > 100 else None, diffraction=False)
    assert 2 * np.pi * np.trapezoid(p.mean(axis=(0, 1)) * np.sin(angles), angles) == pytest.approx(1, abs=2e-4)


@pytest.mark.parametrize("theory", rainbow.THEORIES)
def test_without_diffraction_the_rest_is_doubled(theory):
    angles = np.radians(np.linspace(30, 170, 50))
    kept = rainbow.phase_function(theory, 250.0, [550.0], angles, spread=0.05, sizes=5)
    removed = rainbow.phase_function(theory, 250.0, [550.0], angles, spread=0.05, sizes=5, diffraction=False)
    np.testing.assert_allclose(removed, 2 * kept, rtol=2e-2, atol=2e-5)


@pytest.mark.parametrize("k", [1, 2])
def test_tables_by_rays_have_their_bows_at_descartes_radii(k):
    """Seven wavelengths: the line's centroid within 0.02 degrees of the sheet's radii, the sampled bow's brightest cell of 0.05 within 0.06."""
    rows = table("rainbow_caustics.csv")
    for nm, expected in zip(rows["lambda_nm"], rows[f"bowradius_k{k}_rel"], strict=True):
        radius = np.arange(expected - 0.3, expected + 0.3, 0.0025)
        line, sampled = (
            rainbow.phase_function(theory, 500.0, [nm], np.radians(180 - radius))[:, 0].mean(axis=0)
            for theory in ("DESCARTES", "DESCARTES_SAMPLED")
        )
        line = line * (np.abs(radius - expected) < 0.16)
        assert (line * radius).sum() / line.sum() == pytest.approx(expected, abs=0.02), nm
        assert radius[sampled.argmax()] == pytest.approx(expected, abs=0.06), nm


@pytest.mark.parametrize("theory", rainbow.THEORIES)
def test_bows_lie_where_rays_put_them_and_red_is_outside(theory):
    angles, radius = bow_angles(step=0.05)
    nm = np.array([450.0, 650.0])
    p = rainbow.phase_function(theory, 500.0, nm, angles, spread=0.05, sizes=9, sun_radius_rad=SUN).mean(axis=0)
    primary, secondary = radius < 46, radius > 46
    first = [radius[primary][row[primary].argmax()] for row in p]
    second = [radius[secondary][row[secondary].argmax()] for row in p]
    expected = np.degrees([geometric.bow_radius(water.index(nm), k) for k in (1, 2)])
    np.testing.assert_allclose(first, expected[0], atol=0.45)
    np.testing.assert_allclose(second, expected[1], atol=0.75)
    assert first[1] - first[0] == pytest.approx(expected[0][1] - expected[0][0], abs=0.3)
    assert second[0] > second[1], "the secondary's colours are reversed"
    dark = p[:, np.abs(radius - 46.5).argmin()]
    assert (p[:, primary].max(axis=1) / dark > 20).all(), "Alexander's band is dark"


NM = np.arange(380.0, 781, 20)
MATCHING = colour.observer()[:, 20:421:20] * 20 / colour.observer()[1].sum()


@pytest.mark.parametrize(
    ("theory", "key", "largest", "rms"),
    [
        ("MIE", "mie_50", 0.02, 0.006),
        ("MIE", "mie_250", 0.01, 0.003),
        ("DROPLET", "mie_250", 0.013, 0.003),
        ("AIRY", "mie_250", 0.022, 0.006),
    ],
)
def test_the_colours_of_a_bow_are_those_of_the_reference(theory, key, largest, rms):
    """XYZ of both bows and all between, against the brightest value; Airy's cubic is what parts it from Lorenz-Mie."""
    reference = np.load(REFERENCE / "rainbow_xyz.npz")
    choose = slice(0, None, 4)
    angles = np.radians(180 - reference["radius_deg"][choose])
    sizes = {"mie_50": 24, "mie_250": 16}[key] if theory == "MIE" else None
    p = rainbow.phase_function(theory, float(key[4:]), NM, angles, spread=0.05, sizes=sizes, sun_radius_rad=SUN).mean(axis=0)
    error = ((MATCHING @ p).T - reference[key][choose]) / reference[key].max()
    assert np.abs(error).max() < largest and np.sqrt((error**2).mean(axis=0)).max() < rms, (np.abs(error).max(), (error**2).mean())


@pytest.mark.parametrize("radius", [50, 250])
def test_airys_formula_alone_has_the_colours_of_the_reference(radius):
    """Both bows without any background, as `airy.bow` gives them per pi a^2: half of that with the diffraction lobe. XYZ within half a per cent of
    the brightest."""
    reference = np.load(REFERENCE / "rainbow_xyz.npz")
    degrees = np.arange(120.0, 148.0, 0.02)
    radii, weights = drops.quadrature(radius, 0.05, "LOG_NORMAL", 31)
    area = weights * radii**2 / (weights * radii**2).sum()
    n = water.index(NM)
    p = np.zeros((NM.size, degrees.size))
    for row, index, nm in zip(p, n.tolist(), NM.tolist(), strict=True):
        for a, share in zip(radii.tolist(), area.tolist(), strict=True):
            row += 0.5 * share * sum(airy.bow(np.radians(degrees), index, 2000 * np.pi * a / nm, k).mean(axis=0) for k in (1, 2))
    xyz = rainbow_data._under_the_sun(MATCHING @ p, np.radians(0.02))
    seen = np.array([np.interp(180 - reference["radius_deg"], degrees, row) for row in xyz]).T
    expected = reference[f"airy_{radius}"]
    assert np.abs(seen - expected).max() < 0.005 * expected.max()


@pytest.mark.parametrize("radius", [100.0, 250.0])
def test_the_traced_drop_agrees_with_mie_when_round(radius):
    rows = table("rainbow_mie_airy_550nm.csv")
    rows = rows[rows["radius_um"] == radius]
    p = rainbow.phase_function("DROPLET", radius, [550.0], np.radians(rows["theta_scat_deg"]), sun_radius_rad=SUN)[:, 0]
    mie = (rows["p_perp_mie"] + rows["p_par_mie"]) / 2
    bow = (rows["theta_scat_deg"] >= 137) & (rows["theta_scat_deg"] <= 145)
    assert p.mean(axis=0)[bow].mean() == pytest.approx(mie[bow].mean(), rel=0.03)
    peaks = [rows["theta_scat_deg"][bow][row[bow].argmax()] for row in (p.mean(axis=0), mie)]
    assert peaks[0] == pytest.approx(peaks[1], abs=0.0501)
    assert p[1, bow].mean() == pytest.approx(rows["p_par_mie"][bow].mean(), rel=0.05)


@pytest.mark.parametrize(("theory", "radius", "shift"), [("DROPLET", 400.0, 0.05), ("AIRY", 300.0, 0.1)])
def test_the_luminance_of_both_bows_and_the_band_between_is_mies(theory, radius, shift):
    mie = rainbow_data.bow("MIE", radius, 0.05, 40.0, 0.04)
    other = rainbow_data.bow(theory, radius, 0.05, 40.0, 0.04)
    degree = np.ones(25) / 25
    ratio = np.convolve(other.luminance, degree, "valid") / np.convolve(mie.luminance, degree, "valid")
    assert np.abs(ratio - 1).max() < 0.1
    for span in (rainbow_data._PRIMARY, rainbow_data._SECONDARY):
        assert rainbow_data._top(other, span)[0] == pytest.approx(rainbow_data._top(mie, span)[0], abs=shift)


@pytest.mark.parametrize("theory", ["AIRY", "DROPLET"])
@pytest.mark.parametrize(("radius", "nm"), [(80.0, 500.0), (120.0, 620.0), (300.0, 450.0)])
def test_alexanders_band_is_as_dark_as_mies(theory, radius, nm):
    # The share of grazing waves was taken at 150 and 400 um, 550 nm; half a degree about the band's middle, where no bow reaches.
    angles = np.radians(np.arange(132.5, 135.0, 0.05))
    band = [rainbow.phase_function(t, radius, [nm], angles, 0.06, sizes=60, sun_radius_rad=0.01).mean() for t in (theory, "MIE")]
    assert band[0] == pytest.approx(band[1], rel=0.1)


def test_flattened_drops_lower_the_top_of_the_bow():
    rows = table("oblate_bow_top.csv")
    n = 1.333
    for row in rows:
        for name, ratio in (("q0990", 0.99), ("q0975", 0.975), ("q0950", 0.95)):
            fold = droplet.fold(n, 1, drop_shapes.Spheroid(ratio), np.radians(row["sun_elev_deg"]), 0.0)
            assert 180 - np.degrees(fold.angle) == pytest.approx(row[name], abs=2e-3)


def test_the_feet_of_the_bow_keep_their_radius():
    fold = droplet.fold(1.333, 1, drop_shapes.Spheroid(0.975), 0.0, np.pi / 2)
    assert 180 - np.degrees(fold.angle) == pytest.approx(np.degrees(geometric.bow_radius(1.333, 1)), abs=1e-3)


def test_small_and_large_falling_drops_make_a_twinned_bow():
    angles, radius = bow_angles(37, 44)
    top = {}
    for micrometres in (200.0, 500.0):
        p = rainbow.phase_function(
            "DROPLET", micrometres, [600.0], angles, sun_radius_rad=SUN, flattening=1.0, sun_elevation_rad=np.radians(20)
        ).mean(axis=(0, 1))
        top[micrometres] = radius[p.argmax()]
    assert 1.0 < top[200.0] - top[500.0] < 3.0


def test_two_sizes_of_flattened_drops_show_two_bows_at_the_top_and_one_at_the_feet():
    angles, radius = bow_angles(37, 44)
    tops = []
    for clock, elevation in ((0.0, np.radians(10)), (np.pi / 2, 0.0)):  # the feet stand level with the point opposite a low sun
        p = rainbow.phase_function(
            "DROPLET",
            500.0,
            [600.0],
            angles,
            0.06,
            SUN,
            distribution="TWO_SIZES",
            sizes=16,
            flattening=1.0,
            sun_elevation_rad=elevation,
            clock_rad=clock,
        ).mean(axis=(0, 1))
        peaks = np.flatnonzero((p[1:-1] > p[:-2]) & (p[1:-1] > p[2:])) + 1
        tops.append(sorted(((p[i] / p.max(), radius[i]) for i in peaks), reverse=True)[:2])
    assert tops[0][1][0] > 0.8 and 1.0 < abs(tops[0][0][1] - tops[0][1][1]) < 3.0
    assert tops[1][1][0] < 0.5, "at the feet there is one bow and its supernumerary arcs"


def test_two_sizes_share_the_light():
    radii, weights = drops.quadrature(500.0, 0.06, "TWO_SIZES", 20)
    area = weights * radii**2
    assert area[radii > 350].sum() == pytest.approx(area.sum() / 2)
    assert drops.quadrature(500.0, 0.0, "TWO_SIZES", 20)[0].size == 2


@pytest.mark.parametrize("radius", [100.0, 500.0, 1000.0, 2500.0])
@pytest.mark.parametrize("elevation", [0.0, 0.4, 1.2])
def test_flat_drops_of_any_size_give_a_finite_table(radius, elevation):
    angles = np.linspace(0, np.pi, 181)
    for clock in (0.0, 0.8, np.pi / 2, 3.0):
        p = rainbow.phase_function("DROPLET", radius, [550.0], angles, flattening=2.0, sun_elevation_rad=elevation, clock_rad=clock)
        assert np.isfinite(p).all() and p.min() >= 0


def test_falling_drops_have_their_axis_ratio():
    rows = table("drop_axis_ratio.csv")
    got = [drop_shapes.axis_ratio(500 * d) for d in rows["diameter_mm"]]
    np.testing.assert_allclose(got, rows["axis_ratio_used"], atol=1e-9)


# ---- Sizes and sun --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("distribution", ["NORMAL", "LOG_NORMAL", "GAMMA"])
@pytest.mark.parametrize("spread", [0.05, 0.2])
def test_sizes_have_the_mean_and_the_spread_asked_for(distribution, spread):
    radii, weights = drops.quadrature(250.0, spread, distribution, 401)
    mean = (radii * weights).sum()
    assert mean == pytest.approx(250, rel=3e-3)
    assert np.sqrt(((radii - mean) ** 2 * weights).sum()) / mean == pytest.approx(spread, rel=1e-2)


@pytest.mark.parametrize(("rain", "extinction"), [(1, 3.6e-4), (5, 1.0e-3), (20, 2.4e-3), (50, 4.3e-3)])
def test_rain_has_its_extinction(rain, extinction):
    assert drops.marshall_palmer_extinction(rain) == pytest.approx(extinction, rel=0.03)


def test_the_sun_keeps_light_and_blurs_by_its_radius():
    values = np.zeros(36001)
    values[18000] = 1.0
    smoothed = sun.smooth(values, SUN)
    assert smoothed.sum() == pytest.approx(1)
    seen = np.flatnonzero(smoothed > 1e-9)
    assert (seen[-1] - seen[0]) * 0.005 / 2 == pytest.approx(0.2666, abs=0.006)
    assert np.array_equal(sun.smooth(values, 0.0), values)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"theory": "NEWTON"}, "no rainbow theory"),
        ({"radius_um": 0.0}, "radius"),
        ({"radius_um": 1e6}, "radius"),
        ({"radius_um": np.nan}, "radius"),
        ({"spread": 3.0}, "spread"),
        ({"sun_radius_rad": -1.0}, "sun"),
        ({"wavelengths_nm": []}, "wavelengths"),
        ({"wavelengths_nm": [50.0]}, "wavelengths"),
        ({"angles_rad": [4.0]}, "angles"),
        ({"index": [0.9]}, "index"),
        ({"distribution": "CAUCHY"}, "distribution"),
        ({"theory": "DROPLET", "flattening": 9.0}, "flattening"),
    ],
)
def test_impossible_requests_are_refused_in_a_sentence(change, said):
    arguments = {"theory": "AIRY", "radius_um": 250.0, "wavelengths_nm": [550.0], "angles_rad": [2.4]} | change
    with pytest.raises(ValueError, match=said):
        rainbow.phase_function(**arguments)


def test_a_chart_of_a_big_drop_stops_within_its_lorenz_mie_strip():
    """The strip is a third of the chart's work and many seconds of a big drop's; it tells how far it is and stops between two wavelengths."""
    seen = []

    def told(done):
        seen.append(done)
        return done < 0.09

    with pytest.raises(rainbow.Cancelled):
        rainbow_data.compute(700.0, 0.05, progress=told)
    assert seen == sorted(seen) and 0.09 <= seen[-1] < 0.2, seen


def test_a_table_can_be_watched_and_stopped():
    seen = []
    nm = np.linspace(400, 700, 6)
    rainbow.phase_function("AIRY", 250.0, nm, [2.4], progress=seen.append)
    assert seen == sorted(seen) and seen[-1] == 1
    with pytest.raises(rainbow.Cancelled):
        rainbow.phase_function("AIRY", 250.0, nm, [2.4], progress=lambda _: False)
