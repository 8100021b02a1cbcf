# SPDX-License-Identifier: GPL-3.0-or-later
"""A traced wavefront keeps its energy, its phase and its polarisation: patches beside rays, Lorenz-Mie and the uniform approximation."""

import numpy as np
import pytest
from opal_kernels.optics import rainbow
from opal_kernels.optics.rainbow import background, coherent, drop_shapes, droplet, geometric, mie, patches, wavefront

N = 1.333
FAMILIES = (-1, 0, 1, 2)  # reflected outside, passed through, primary, secondary
ROUND = wavefront.trace(drop_shapes.SPHERE, N, 0.3, FAMILIES, 385, 48)
PATCHES = {k: patches.Patches(wave) for k, wave in ROUND.items()}
FALLING = drop_shapes.falling(1.0)


# ---- Energy ---------------------------------------------------------------------------------------------------------


def test_the_families_carry_the_light_that_rays_carry():
    """In all, by family, and in directions, twelve degrees a bin: a thousandth of the light on the drop."""
    edges = np.linspace(0, np.pi, 16)
    fine = wavefront.trace(drop_shapes.SPHERE, N, 0.3, FAMILIES, 1025, 32)
    total = expected_total = 0.0
    for k in FAMILIES:
        expected = geometric.energy(N, k, edges).mean(axis=0)
        traced = patches.Patches(fine[k])
        seen = np.histogram(traced.centres(), edges, weights=traced.power)[0]
        assert traced.power.sum() == pytest.approx(expected.sum(), abs=1e-4)
        np.testing.assert_allclose(seen, expected, atol=1e-3)
        total, expected_total = total + seen.sum(), expected_total + expected.sum()
    assert total == pytest.approx(expected_total, abs=1e-4)


@pytest.mark.parametrize("diameter", [1.0, 2.0])
def test_all_orders_of_a_falling_drop_carry_all_light(diameter):
    orders = tuple(range(-1, 13))
    waves = wavefront.trace(drop_shapes.falling(diameter), N, 0.5, orders, 129, 24, focal_lines=False)
    # What is totally reflected again and again near the edge is still inside after twelve reflections.
    assert sum(patches.Patches(wave).power.sum() for wave in waves.values()) == pytest.approx(1, abs=3e-3)


def test_the_shadow_of_a_tilted_spheroid_has_its_area():
    for elevation in (0.0, 0.7, np.pi / 2):
        ratio = 0.8
        wave = wavefront.trace(drop_shapes.Spheroid(ratio), N, elevation, (-1,), 257, 16)[-1]
        wide, high = ratio ** (-1 / 3), ratio ** (2 / 3)
        assert wave.shadow == pytest.approx(np.pi * wide * np.hypot(high * np.cos(elevation), wide * np.sin(elevation)), rel=2e-5)


@pytest.mark.parametrize("clock", [0.0, 1.1, 2.6])
@pytest.mark.parametrize("radius", [300.0, 1200.0])
def test_what_one_place_of_the_sky_shows_integrates_to_one(clock, radius):
    angles = np.linspace(0, np.pi, 3601)
    p = rainbow.phase_function(
        "DROPLET", radius, [550.0], angles, 0.05, sizes=3, flattening=1.0, sun_elevation_rad=0.3, clock_rad=clock, diffraction=False
    )
    assert np.trapezoid(p.mean(axis=(0, 1)) * np.sin(angles) * 2 * np.pi, angles) == pytest.approx(1, abs=1e-5)


def test_a_bow_of_summed_patches_keeps_its_light():
    """All round a drop whose secondary folds more than once: its blurred waves carry what its rays carry, but for what they leave of fringes."""
    surface = drop_shapes.falling(2.4)
    traced = patches.Patches(wavefront.trace(surface, N, 0.4, (2,), 257, 48)[2])
    clocks = (np.arange(24) + 0.5) * np.pi / 24
    angles = np.linspace(0, np.pi, 3601)
    light = [np.trapezoid(patches.Bow(traced, c).intensity(angles, 13000.0).mean(axis=0) * np.sin(angles), angles) for c in clocks]
    assert 2 * np.pi * np.mean(light) == pytest.approx(traced.power.sum(), rel=0.03)


# ---- Phase ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("k", FAMILIES)
def test_the_paths_slope_over_the_direction_is_the_lever_arm(k):
    """Malus's theorem, along the wavefront of a drop that is not round: d(path) = -x_out . du between neighbours, with an error of their
    distance's third power, (pi/2/256)^3 = 2e-7 times a few."""
    wave = wavefront.trace(FALLING, N, 0.3, (k,), 257, 48)[k]
    rows = slice(5, 230)
    turned = wave.direction[:, 1:] - wave.direction[:, :-1]
    arm = 0.5 * (wave.exit[:, 1:] + wave.exit[:, :-1])
    error = (wave.path[1:] - wave.path[:-1] + (arm * turned).sum(axis=0))[rows]
    assert np.abs(error).max() < 5e-6


def test_a_focal_line_lies_between_the_two_rays_of_a_bow():
    wave = ROUND[1]
    incidence = wave.rows * np.pi / 2
    caustic = float(geometric.caustic_incidence(N, 1))
    inside, outside = (incidence > 0.05) & (incidence < caustic - 0.02), (incidence > caustic + 0.02) & (incidence < 1.2)
    assert (wave.focal[inside] == 2).all() and (wave.focal[outside] == 3).all()


@pytest.mark.parametrize("clock", [0.0, 0.7])
@pytest.mark.parametrize("x", [1142.0, 5712.0])
def test_summed_patches_are_the_uniform_approximation_inside_the_bow(clock, x):
    """Wave by wave, every fringe: rms 2 per cent from three degrees inside the caustic, 1 per cent from seven on."""
    for first, last, limit in ((141.0, 145.0, 0.025), (145.0, 158.0, 0.0125)):
        angles = np.radians(np.linspace(first, last, 600))
        summed = (np.abs(PATCHES[1].hits(clock, angles).field(x, angles.size)) ** 2).sum(axis=1)
        uniform = droplet.fold(N, 1, drop_shapes.SPHERE, 0.0, 0.0).intensity(angles, x)
        rms = np.sqrt(((summed - uniform) ** 2).mean(axis=1)) / uniform.mean(axis=1)
        assert (rms < limit).all(), rms


def test_families_summed_as_waves_ripple_as_lorenz_mie_does():
    """One sphere, every fringe: correlation 0.97 with Mie's once the light reflected outside joins the primary, under 0.9 before.

    What remains are orders from three on, which carry 8 per cent of the light there.
    """
    x = 1142.4
    angles = np.radians(np.linspace(145.0, 160.0, 1500))
    exact = np.abs(np.array(mie.amplitudes(N, x, angles))) ** 2 / (np.pi * x * x)
    for families, low, high in ((coherent.FAMILIES, 0.97, 1.0), ((1, 2), 0.7, 0.9)):
        summed = coherent.intensity(angles, N, x, sun_elevation_rad=0.3, clock_rad=0.7, families=families)
        for ours, mies in zip(summed, exact, strict=True):
            assert low < np.corrcoef(ours, mies)[0, 1] < high
            if -1 in families:
                assert ours.mean() == pytest.approx(mies.mean(), rel=0.09)


def test_all_families_of_a_falling_drop_add_as_waves_to_what_they_are_as_power():
    """A drop that is not round, all in one sum: means over a degree from five degrees inside the primary on are those of its bow and of the light that is
    reflected outside, to 2.5 per cent."""
    x, clock, elevation = 5712.0, 0.8, 0.3
    angles = np.radians(np.arange(144.0, 153.0, 0.01))
    summed = coherent.intensity(angles, N, x, FALLING, elevation, clock)
    reflected = patches.Patches(wavefront.trace(FALLING, N, elevation, (-1,), 385, 64)[-1]).means(
        clock, np.radians(np.arange(144.0, 153.1, 1.0))
    )
    bow = droplet.fold(N, 1, FALLING, elevation, clock).intensity(angles, x).reshape(2, -1, 100).mean(axis=2)
    np.testing.assert_allclose(summed.reshape(2, -1, 100).mean(axis=2).mean(axis=0), (bow + reflected).mean(axis=0), rtol=0.025)


# ---- Drops that are not round ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("clock", [0.0, 0.8, np.pi / 2, 2.7])
def test_folds_and_patches_of_a_falling_drop_agree(clock):
    """Two ways to one bow, out of the plane of symmetry too: means over half a degree within 1 per cent from two to ten degrees inside
    the caustic, and the mean of what is totally reflected on its way, further inside, within 5."""
    elevation, x = 0.3, 5712.0
    fold = droplet.fold(N, 1, FALLING, elevation, clock)
    angles = np.degrees(fold.angle) + np.arange(2.0, 14.0, 0.01)
    traced = patches.Patches(wavefront.trace(FALLING, N, elevation, (1,), 385, 64)[1])
    summed = (np.abs(traced.hits(clock, np.radians(angles)).field(x, angles.size)) ** 2).sum(axis=1)
    means = [rows.reshape(2, -1, 50).mean(axis=2) for rows in (summed, fold.intensity(np.radians(angles), x))]
    np.testing.assert_allclose(means[0][:, :16], means[1][:, :16], rtol=0.01)
    np.testing.assert_allclose(means[0][:, 16:].mean(), means[1][:, 16:].mean(), rtol=0.05)


def test_rays_that_leave_beside_the_plane_of_symmetry_entered_elsewhere():
    """A drop that is not round turns light out of its plane of incidence; at the top of the bow it cannot, by symmetry."""
    for clock, least, most in ((0.0, 0.0, 1e-9), (0.8, 0.01, 0.5)):
        wave = wavefront.trace(FALLING, N, 0.3, (1,), 129, 24)[1]
        side = np.cross(wave.frame.sun, np.cos(clock) * wave.frame.up + np.sin(clock) * wave.frame.side)
        row = np.tensordot(side, wave.direction, 1)[80]  # turned out of the half plane, of rays that entered anywhere on one ring
        left = np.interp(clock, wave.columns[:20], row[:20]) if clock else 0.5 * (row[0] + row[-1])
        assert least <= abs(left) <= most, left


def test_the_real_shape_is_not_the_spheroids():
    """The flat base: the bow's top under a sun at the horizon moves by half of what a spheroid of the same axis ratio says, its bottom by more."""
    top, bottom = (np.degrees(droplet.fold(N, 1, FALLING, 0.0, c).angle) for c in (0.0, np.pi))
    same = drop_shapes.Spheroid(FALLING.ratio)
    both = [np.degrees(droplet.fold(N, 1, same, 0.0, c).angle) for c in (0.0, np.pi)]
    assert both[0] == pytest.approx(both[1], abs=1e-6)
    sphere = 180 - np.degrees(geometric.bow_radius(N, 1))
    assert 0.4 * (both[0] - sphere) < top - sphere < 0.8 * (both[0] - sphere)
    assert bottom - sphere > 1.2 * (both[0] - sphere)


@pytest.mark.parametrize(("diameter", "elevation"), [(1.5, 0.2), (1.8, 0.5), (3.0, 0.2)])
def test_neighbouring_wavelengths_show_the_same_bow(diameter, elevation):
    """However a bow is drawn, folded or summed: its light, a mean over five degrees, moves little within 20 nm; and none lies outside the drop's bows."""
    angles = np.linspace(np.radians(95), np.pi, 1700)
    p = rainbow.phase_function(
        "DROPLET", 500 * diameter, np.arange(520, 561, 20.0), angles, 0.1, 0.02, sizes=3, flattening=1.0, sun_elevation_rad=elevation
    ).mean(axis=0)
    coarse = p.reshape(len(p), 17, 100).mean(axis=2)
    assert p.min() >= 0
    assert np.abs(np.diff(coarse, axis=0)).max() < 0.15 * coarse.max()
    assert coarse[:, 0].max() < 0.2 * coarse.max()


@pytest.mark.parametrize(("diameter", "k"), [(1.0, 1), (1.0, 2), (1.6, 1)])
def test_summed_patches_with_their_blur_stand_in_for_folds(diameter, k):
    """Where both can draw a bow, means over two degrees differ by less than 15 per cent of the peak, at its top, its side and below."""
    surface, x = drop_shapes.falling(diameter), 5712.0 * diameter
    traced = patches.Patches(wavefront.trace(surface, N, 0.2, (k,), 257, 48)[k])
    angles = np.radians(np.arange(100.0, 180.0, 0.05))
    for clock in (0.0, np.pi / 2, np.pi):
        drawn = (droplet.fold(N, k, surface, 0.2, clock), patches.Bow(traced, clock))
        fold, summed = (bow.intensity(angles, x).mean(axis=0).reshape(-1, 40).mean(axis=1) for bow in drawn)
        assert np.abs(fold - summed).max() < 0.15 * fold.max()


def test_the_blur_at_a_caustic_is_the_papers_table():
    """Sadeghi et al. 2012, table II: 0.70, 0.22 and 0.15 degrees at 0.1, 0.5 and 1 mm radius; within 10 per cent by the x^(-2/3) law at 550 nm."""
    for radius, sigma in ((100.0, 0.70), (500.0, 0.22), (1000.0, 0.15)):
        x = 2000 * np.pi * radius / 550
        ours = np.degrees(patches.blur(1, x))
        assert ours == pytest.approx(sigma, rel=0.1)
        assert patches.blur(2, x) == pytest.approx(2 * patches.blur(1, x))


def test_the_sky_about_round_drops_is_that_of_rays():
    """Reflected and transmitted light as patches, where the drop is so small that it is round: 2 per cent of what rays say, in means over three degrees."""
    sky = droplet._sky(N, droplet.Shape(1.0, 0.3, 0.9), np.array([20.0]), np.array([1.0]))
    centres = np.degrees(background.CENTRES)
    for k, span in ((-1, (5, 175)), (0, (2, 75))):
        inside = (centres > span[0]) & (centres < span[1])
        ours, rays = (
            d[:, inside].mean(axis=0)[: inside.sum() // 60 * 60].reshape(-1, 60).mean(axis=1) for d in (sky[k], background.orders(N)[k])
        )
        np.testing.assert_allclose(ours, rays, rtol=0.02)
