# SPDX-License-Identifier: GPL-3.0-or-later
"""The gem boundary: Fresnel's shares, Snell's directions, nothing lost, and every wavelength served."""

import numpy as np
import pytest
from bsdf_under_test import DISPERSIVE, REFLECT, SPECULAR, TRANSMIT, Bsdf, direction, points

SPREAD = np.array([2.40, 2.41, 2.42, 2.44, 2.46, 2.39, 2.45, 2.43])  # a diamond's, wider
OUTSIDE, INSIDE = SPREAD, 1 / SPREAD


@pytest.mark.parametrize(
    ("n", "theta", "reflectance"),
    # PHYSICS 2.4
    [(1.5, 45, 0.050240), (1.5, 60, 0.089187), (1.5, 75, 0.253061), (1.5, 85, 0.612800), (2.4173, 0, 0.172011), (2.4173, 45, 0.181157),
     (2.4173, 60, 0.211295), (2.4173, 85, 0.621700), (1.333, 60, 0.059691), (1.333, 85, 0.583523)],
)  # fmt: skip
def test_reflectance_is_fresnels(n, theta, reflectance):
    s = Bsdf("GEM", direction(theta), eta=[n] * 8).sample(points(64))
    reflected = (s["scattering"] & REFLECT) != 0
    assert reflected.any()
    np.testing.assert_allclose(s["pdf"][reflected], reflectance, atol=1.5e-6)


def schlick(n, cosine):
    r0 = ((n - 1) / (n + 1)) ** 2
    return r0 + (1 - r0) * (1 - cosine) ** 5


def test_schlick_uses_the_cosine_on_the_thin_side():
    inside = Bsdf("GEM", direction(30), eta=[1 / 1.5] * 8, schlick=1).sample(points(64))
    through = (inside["scattering"] & TRANSMIT) != 0
    cos_outside = np.sqrt(1 - (1.5 * np.sin(np.radians(30))) ** 2)
    np.testing.assert_allclose(1 - inside["pdf"][through], schlick(1.5, cos_outside), atol=1e-6)
    outside = Bsdf("GEM", direction(60), eta=[1.5] * 8, schlick=1).sample(points(64))
    through = (outside["scattering"] & TRANSMIT) != 0
    np.testing.assert_allclose(1 - outside["pdf"][through], schlick(1.5, 0.5), atol=1e-6)


@pytest.mark.parametrize(("n", "critical"), [(2.41726, 24.437), (1.76808, 34.443), (1.33335, 48.590), (1.51673, 41.248)])
def test_total_reflection_sets_in_at_the_critical_angle(n, critical):
    for off, total in ((-0.01, False), (0.01, True)):
        s = Bsdf("GEM", direction(critical + off), eta=[1 / n] * 8).sample(points(4096))
        assert ((s["scattering"] & TRANSMIT) == 0).all() == total


def test_each_wavelength_has_its_own_share_of_a_reflection_and_the_hero_alone_the_refraction():
    s = Bsdf("GEM", direction(50), eta=OUTSIDE).sample(points(256))
    reflected = (s["scattering"] & REFLECT) != 0
    c = np.cos(np.radians(50))
    t = np.sqrt(1 - (1 - c * c) / SPREAD**2)
    fresnel = (((c - SPREAD * t) / (c + SPREAD * t)) ** 2 + ((SPREAD * c - t) / (SPREAD * c + t)) ** 2) / 2
    np.testing.assert_allclose(s["pdf"][reflected], np.broadcast_to(fresnel, (reflected.sum(), 8)), rtol=1e-5)
    np.testing.assert_allclose(s["weight"][reflected], np.broadcast_to(fresnel / fresnel[0], (reflected.sum(), 8)), rtol=1e-5)
    assert (s["scattering"][~reflected] == TRANSMIT | SPECULAR | DISPERSIVE).all()
    assert (s["pdf"][~reflected][:, 1:] == 0).all() and (s["weight"][~reflected][:, 1:] == 0).all()
    np.testing.assert_allclose(np.hypot(*s["wi"][~reflected][:, :2].T), np.sin(np.radians(50)) / SPREAD[0], atol=1e-6)


@pytest.mark.parametrize("flux", [0, 1])
@pytest.mark.parametrize("roughness", [0, 0.3, 0.6, 0.9])
@pytest.mark.parametrize("theta", [0, 20, 45, 70])
@pytest.mark.parametrize("side", ["outside", "inside"])
def test_a_lossless_gem_disappears_in_a_furnace(side, theta, roughness, flux):
    """Radiance n^2 on either side is in balance, and so is flux; every wavelength's estimate is, over all heroes.

    Each wavelength in turn is the hero; its estimate is weight / mean(pdf / pdf of the hero) (Wilkie et al. 2014).
    """
    spread = OUTSIDE if side == "outside" else INSIDE
    total = np.zeros(8)
    for hero in range(8):
        eta = np.roll(spread, -hero)
        s = Bsdf("GEM", direction(theta), eta=eta, roughness=roughness, flux=flux).sample(points(1 << 12))
        ok = s["scattering"] != 0
        ratio = s["pdf"][ok] / s["pdf"][ok][:, :1]
        light = np.where((s["scattering"][ok] & TRANSMIT)[:, None] != 0, 1 if flux else eta**2, 1)
        estimate = (s["weight"][ok] * light / ratio.mean(axis=1, keepdims=True)).sum(axis=0) / len(s["eta"])
        total += np.roll(estimate, hero) / 8
    np.testing.assert_allclose(total, 1, atol=0.006 if roughness < 0.5 else 0.02)


def test_radiance_is_diluted_and_flux_is_not():
    for flux, scale in ((0, 1 / 1.5**2), (1, 1)):
        s = Bsdf("GEM", direction(40), eta=[1.5] * 8, flux=flux).sample(points(64))
        through = (s["scattering"] & TRANSMIT) != 0
        np.testing.assert_allclose(s["weight"][through], scale, rtol=1e-5)
        np.testing.assert_allclose(s["eta"][through], 1.5)


def test_an_interpolated_normal_never_loses_light():
    """Where it would send the mirror direction into the stone, the facet's own normal serves."""
    s = Bsdf("GEM", direction(80, 180), eta=[2.4] * 8, shading_normal=direction(30)).sample(points(512))
    assert (s["scattering"] != 0).all()
    sides = np.where(s["scattering"] & TRANSMIT, -1, 1) * s["wi"][:, 2]
    assert (sides > 0).all()


def test_no_boundary_bends_nothing():
    s = Bsdf("GEM", direction(50, 30), eta=[1] * 8).sample(points(16))
    np.testing.assert_allclose(s["wi"], np.broadcast_to(-direction(50, 30), (16, 3)), atol=1e-6)
    np.testing.assert_allclose(s["weight"], 1, rtol=1e-6)


def refracted(incoming, outward, n_front, n_behind):
    """The direction in which the boundary with this outward normal lets a ray through."""
    facing = -np.sign(incoming @ outward) * outward
    s = Bsdf("GEM", -incoming, geometric_normal=facing, shading_normal=facing, eta=[n_behind / n_front] * 8).sample(points(256))
    return s["wi"][(s["scattering"] & TRANSMIT) != 0][0]


def axis_crossing(n, height):
    """Where a ray that runs along +z at this height over the axis, through a ball of radius 1 about the origin, meets the axis, or came from."""
    forward = np.array([0.0, 0, 1])
    entry = np.array([height, 0, -np.sqrt(1 - height**2)])
    inside = refracted(forward, entry, 1, n)
    leave = entry - 2 * (entry @ inside) * inside
    out = refracted(inside, leave / np.linalg.norm(leave), n, 1)
    return leave[2] - leave[0] * out[2] / out[0]


@pytest.mark.parametrize(("n", "focus"), [(1.333, 2.001502), (1.5, 1.5), (1.7682, 1.150872), (2.0, 1.0), (2.417259, 0.852783)])
def test_a_ball_brings_paraxial_rays_to_its_focus(n, focus):
    """PHYSICS 5.8. Spherical aberration grows with the square of the height and is taken off with two of them."""
    assert (4 * axis_crossing(n, 0.02) - axis_crossing(n, 0.04)) / 3 == pytest.approx(focus, abs=1e-4)


@pytest.mark.parametrize(("height", "crossing"), [(0.1, 1.49583), (0.4, 1.43164), (0.8, 1.20028)])
def test_marginal_rays_cross_the_axis_before_the_focus(height, crossing):
    assert axis_crossing(1.5, height) == pytest.approx(crossing, abs=1e-4)
