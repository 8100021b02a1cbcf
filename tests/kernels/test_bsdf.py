# SPDX-License-Identifier: GPL-3.0-or-later
"""Surface scattering: samplers draw what their densities say, energy is kept, light's two directions agree."""

import numpy as np
import pytest
from bsdf_under_test import REFLECT, SPECULAR, STRAIGHT, TRANSMIT, Bsdf, direction, points

OBLIQUE = direction(50, 20)
GRAY = (0.8, 0.5, 0.2)
TANGENT = (1, 0.3, 0)
SMOOTH = {
    "lambert": Bsdf("DIFFUSE", OBLIQUE, color=GRAY),
    "oren_nayar": Bsdf("DIFFUSE", OBLIQUE, color=GRAY, roughness=0.8),
    "translucent": Bsdf("TRANSLUCENT", OBLIQUE, color=GRAY),
    "sheen": Bsdf("SHEEN", OBLIQUE, color=GRAY, roughness=0.4),
    "sheen_narrow": Bsdf("SHEEN", direction(80), color=GRAY, roughness=0.15),
    "ggx_rough": Bsdf("GLOSSY", OBLIQUE, color=GRAY, roughness=0.8),
    "ggx_sharp": Bsdf("GLOSSY", OBLIQUE, color=GRAY, roughness=0.35),
    "ggx_anisotropic": Bsdf("GLOSSY", OBLIQUE, roughness=0.6, anisotropy=0.6, rotation=0.1, tangent=TANGENT),
    "metal_f82": Bsdf("METAL_F82", OBLIQUE, color=(1, 0.7, 0.3), color_2=(0.9, 0.5, 0.9), roughness=0.6),
    "conductor": Bsdf("CONDUCTOR", OBLIQUE, color=(0.2, 0.9, 1.1), color_2=(3.1, 2.3, 2.2), roughness=0.5),
    "glass_outside": Bsdf("GLASS", OBLIQUE, color=GRAY, roughness=0.6, ior=1.5),
    "glass_inside": Bsdf("GLASS", OBLIQUE, roughness=0.6, ior=1.5, backfacing=1),
    "refraction": Bsdf("REFRACTION", OBLIQUE, roughness=0.7, ior=1.33),
    "gem_outside": Bsdf("GEM", OBLIQUE, roughness=0.6, eta=[2.4] * 8),
    "gem_inside": Bsdf("GEM", direction(20), roughness=0.5, eta=[1 / 2.4] * 8),
    "principled": Bsdf(
        "PRINCIPLED", OBLIQUE, color=GRAY, roughness=0.5, metallic=0.3, transmission=0.4, coat=0.6, coat_roughness=0.4, sheen=0.5,
        diffuse_roughness=0.5, multiscatter=1,
    ),  # fmt: skip
}  # fmt: skip
smooth = pytest.mark.parametrize("bsdf", SMOOTH.values(), ids=SMOOTH.keys())


def sphere_grid(n_z, n_phi, fine):
    """Directions on fine x fine points in each of n_z x n_phi equal cells of (z, phi), shape (cells, fine * fine, 3)."""
    z = -1 + 2 * (np.arange(n_z * fine) + 0.5) / (n_z * fine)
    phi = 2 * np.pi * (np.arange(n_phi * fine) + 0.5) / (n_phi * fine)
    z, phi = np.meshgrid(z, phi, indexing="ij")
    r = np.sqrt(1 - z * z)
    d = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    return d.reshape(n_z, fine, n_phi, fine, 3).swapaxes(1, 2).reshape(n_z * n_phi, fine * fine, 3)


def expected_share(bsdf, n_z, n_phi, fine):
    """Integral of the hero's pdf over each cell."""
    grid = sphere_grid(n_z, n_phi, fine)
    pdf = bsdf.eval(grid.reshape(-1, 3))[1][:, 0].reshape(grid.shape[:2])
    return pdf.mean(axis=1) * 4 * np.pi / (n_z * n_phi)


@smooth
def test_the_pdf_is_that_of_the_sampler(bsdf):
    n, n_z, n_phi = 1 << 17, 16, 16
    s = bsdf.sample(np.random.default_rng(1).random((n, 3), np.float32))
    wi = s["wi"][s["scattering"] != 0]
    cell = np.minimum(((wi[:, 2] + 1) / 2 * n_z).astype(int), n_z - 1) * n_phi
    cell += np.minimum((np.arctan2(wi[:, 1], wi[:, 0]) / (2 * np.pi) % 1 * n_phi).astype(int), n_phi - 1)
    found = np.bincount(cell, minlength=n_z * n_phi)
    expected = expected_share(bsdf, n_z, n_phi, 24) * n
    # Rare cells together, then chi-squared with the Wilson-Hilferty normal approximation.
    rare = expected < 20
    found, expected = (np.append(a[~rare], a[rare].sum()) for a in (found, expected))
    keep = expected > 5
    degrees = keep.sum() - 1
    chi2 = ((found - expected)[keep] ** 2 / expected[keep]).sum()
    # Quadrature of a peaked density errs too: 1 % of a cell's count is granted.
    chi2_granted = (np.maximum(0, np.abs(found - expected) - 0.01 * expected)[keep] ** 2 / expected[keep]).sum()
    deviation = ((chi2_granted / degrees) ** (1 / 3) - (1 - 2 / (9 * degrees))) / np.sqrt(2 / (9 * degrees))
    assert deviation < 4, f"chi2 {chi2:.0f} of {degrees} degrees, {found.sum()} of {expected.sum():.0f} samples"


@smooth
def test_the_pdf_integrates_to_the_share_of_samples_that_succeed(bsdf):
    share = (bsdf.sample(points(1 << 15))["scattering"] != 0).mean()
    total = expected_share(bsdf, 16, 16, 24).sum()
    assert total == pytest.approx(share, abs=0.01)
    assert total < 1.01


@smooth
def test_a_sample_weighs_what_eval_says(bsdf):
    s = bsdf.sample(points(2000))
    ok = s["scattering"] != 0
    value, pdf = bsdf.eval(s["wi"][ok])
    np.testing.assert_allclose(s["pdf"][ok], pdf, rtol=2e-3)
    np.testing.assert_allclose(s["weight"][ok] * s["pdf"][ok][:, :1], value, rtol=4e-3, atol=1e-6)


@smooth
def test_no_surface_gives_back_more_than_it_gets(bsdf):
    for theta in (0, 30, 60, 80, 88):
        back = bsdf.but(wo=direction(theta), flux=1).furnace(1 << 13)  # flux: without the (n2/n1)^2 of gem boundaries
        if bsdf.fields["node"] in ("GLASS", "REFRACTION"):
            back = bsdf.but(wo=direction(theta)).furnace(1 << 13)
        assert (back < 1.015).all(), f"{theta} degrees: {back[:3]}"


@pytest.mark.parametrize("roughness", [0.1, 0.3, 0.5, 0.75, 1.0])
@pytest.mark.parametrize("theta", [0, 40, 70, 85])
def test_compensated_white_ggx_returns_the_furnace(roughness, theta):
    back = Bsdf("GLOSSY", direction(theta), roughness=roughness, multiscatter=1).furnace()
    assert back[0] == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize("roughness", [0.1, 0.4, 0.7, 1.0])
@pytest.mark.parametrize("theta", [0, 40, 70])
@pytest.mark.parametrize("node", ["GLASS", "PRINCIPLED"])
def test_compensated_white_glass_returns_the_furnace_from_outside(node, roughness, theta):
    back = Bsdf(node, direction(theta), roughness=roughness, multiscatter=1, transmission=1, ior=1.45).furnace()
    assert back[0] == pytest.approx(1, abs=0.012)


def test_without_compensation_rough_ggx_loses_energy():
    assert Bsdf("GLOSSY", direction(0), roughness=1).furnace()[0] < 0.75


@pytest.mark.parametrize("roughness", [0, 0.3, 1])
def test_white_diffuse_returns_the_furnace(roughness):
    for theta in (0, 60, 85):
        assert Bsdf("DIFFUSE", direction(theta), roughness=roughness).furnace()[0] == pytest.approx(1, abs=0.006)


@pytest.mark.parametrize("name", ["lambert", "oren_nayar", "ggx_rough", "ggx_anisotropic", "metal_f82", "conductor"])
def test_reflection_is_reciprocal(name):
    for a, b in ((direction(10), direction(70, 100)), (direction(85), direction(30, 190)), (direction(45, 30), direction(60, -80))):
        forth, back = (SMOOTH[name].but(wo=o).eval(i)[0][0] / i[2] for o, i in ((a, b), (b, a)))
        np.testing.assert_allclose(forth, back, rtol=1e-3)


def test_oren_nayar_is_reciprocal_with_its_multiple_scattering():
    forth, back = (
        Bsdf("DIFFUSE", o, color=GRAY, roughness=1).eval(i)[0][0] / i[2]
        for o, i in ((direction(15), direction(75, 40)), (direction(75, 40), direction(15)))
    )
    np.testing.assert_allclose(forth, back, rtol=1e-3)


TILTED = direction(25, 70)


@pytest.mark.parametrize("shading_normal", [(0, 0, 1), TILTED], ids=["flat", "interpolated"])
@pytest.mark.parametrize("name", ["lambert", "oren_nayar", "translucent", "ggx_rough", "glass_outside", "refraction", "gem_outside"])
def test_flux_meets_the_adjoint_of_what_radiance_meets(name, shading_normal):
    """Light from a to b: eval_flux(wo=a, wi=b) = eval_radiance(wo=b, wi=a) |b.ng| / |a.ng| (Veach 1997, 5.3)."""
    bsdf = SMOOTH[name]
    transmission = name in ("translucent", "refraction", "glass_outside", "gem_outside")
    a, b = direction(40, 10), direction(60, 120)
    if transmission:
        b = -direction(25, 355)
    flux = bsdf.but(wo=a, shading_normal=shading_normal, flux=1).eval(b)[0][0]
    turned = {"wo": b, "shading_normal": shading_normal}
    if transmission:  # seen from behind, both normals turn and the index ratio inverts
        turned = {"wo": b, "shading_normal": -np.array(shading_normal), "geometric_normal": (0, 0, -1), "backfacing": 1}
        turned["eta"] = 1 / np.array(bsdf.fields.get("eta", [1.5] * 8))
    # Energy compensation is a function of the viewer's side alone; gems have it, so it is divided out.
    scale = np.ones(8)
    if name == "gem_outside":
        scale *= lost_in_single_scattering(bsdf, turned) / lost_in_single_scattering(bsdf, {"wo": a, "shading_normal": shading_normal})
    radiance = bsdf.but(**turned).eval(a)[0][0]
    assert flux[0] > 0
    np.testing.assert_allclose(flux, radiance * scale * abs(b[2]) / abs(a[2]), rtol=5e-3 if name == "gem_outside" else 1e-3)


def lost_in_single_scattering(bsdf, fields):
    """Single-scattering albedo of a Glass node at the gem's index and view: the inverse of the gem's compensation."""
    n = fields["shading_normal"]
    cosine = float(np.dot(fields["wo"], n))
    eta = fields.get("eta", bsdf.fields["eta"])[0]
    wo = direction(np.degrees(np.arccos(cosine)))
    return Bsdf("GLASS", wo, roughness=bsdf.fields["roughness"], ior=eta).furnace(1 << 15)[0]


@pytest.mark.parametrize("name", [n for n in SMOOTH if n not in ("translucent", "refraction")])
def test_nothing_reflects_through_the_surface(name):
    """With an interpolated normal far from the face's, light from behind the face is no reflection."""
    bsdf = SMOOTH[name].but(shading_normal=direction(50, 20), wo=direction(45, 20))
    wi = direction(100, 20)
    assert np.dot(wi, direction(50, 20)) > 0
    assert bsdf.eval(wi)[0].max() == 0
    s = bsdf.sample(points(4000))
    sides = np.where(s["scattering"] & TRANSMIT, -1, 1) * s["wi"][:, 2]
    assert (sides[s["scattering"] != 0] > 0).all()


def test_a_mirror_reflects_and_says_so():
    s = Bsdf("GLOSSY", OBLIQUE, color=GRAY).sample(points(4))
    np.testing.assert_allclose(s["wi"], np.broadcast_to(OBLIQUE * (-1, -1, 1), (4, 3)), atol=1e-6)
    np.testing.assert_allclose(s["weight"][:, :3], np.broadcast_to(GRAY, (4, 3)), rtol=1e-5)
    assert (s["scattering"] == REFLECT | SPECULAR).all()
    assert Bsdf("GLOSSY", OBLIQUE).eval(s["wi"])[0].max() == 0


def test_smooth_glass_splits_by_fresnel_and_bends_by_snell():
    s = Bsdf("GLASS", direction(60), ior=1.5).sample(points(1 << 12))
    reflected = (s["scattering"] & REFLECT) != 0
    assert reflected.mean() == pytest.approx(0.089187, abs=1e-3)  # PHYSICS 2.4
    np.testing.assert_allclose(s["pdf"][reflected], 0.089187, atol=1e-5)
    np.testing.assert_allclose(np.hypot(*s["wi"][~reflected][:, :2].T), np.sin(np.radians(60)) / 1.5, atol=1e-6)
    np.testing.assert_allclose(s["weight"], 1, rtol=1e-5)
    np.testing.assert_allclose(s["eta"][~reflected], 1.5)


def test_flux_into_a_glass_node_is_carried_over_n_squared():
    s = Bsdf("GLASS", direction(30), ior=1.5, flux=1).sample(points(64))
    through = (s["scattering"] & TRANSMIT) != 0
    np.testing.assert_allclose(s["weight"][through], 1 / 1.5**2, rtol=1e-5)
    np.testing.assert_allclose(s["weight"][~through], 1, rtol=1e-5)


def test_transparency_goes_straight_on():
    bsdf = Bsdf("TRANSPARENT", OBLIQUE, color=GRAY)
    s = bsdf.sample(points(4))
    assert (s["scattering"] & STRAIGHT).all()
    np.testing.assert_allclose(s["wi"], np.broadcast_to(-OBLIQUE, (4, 3)), atol=1e-6)
    np.testing.assert_allclose(bsdf.summary()["transparency"], GRAY, rtol=1e-6)


def test_photons_are_left_for_what_is_rough():
    wi = direction(50, 200)
    for name, rough in (("lambert", True), ("ggx_rough", True), ("glass_outside", True)):
        value, left = (SMOOTH[name].eval(wi, rough_only=r)[0][0] for r in (False, True))
        np.testing.assert_allclose(left, value if rough else 0)
    assert Bsdf("GLOSSY", OBLIQUE, roughness=0.3).eval(wi, rough_only=True)[0].max() == 0


def test_bent_normals_and_wild_numbers_stay_finite():
    random = np.random.default_rng(5)
    for node in ("DIFFUSE", "GLOSSY", "GLASS", "REFRACTION", "SHEEN", "METAL_F82", "CONDUCTOR", "PRINCIPLED", "GEM"):
        for _ in range(40):
            wo = direction(random.choice([0, 30, 89.99]), random.uniform(0, 360))
            bsdf = Bsdf(
                node, wo, color=random.choice([0, 1e-6, 1, 4], 3), color_2=random.choice([0, 0.5, 5], 3), roughness=random.choice([0, 0.01, 0.02, 1]),
                ior=random.choice([1e-6, 0.7, 1, 1.0001, 1.5, 100]), anisotropy=random.choice([-1, 0, 0.9, 1]), tangent=random.normal(size=3),
                normal=random.choice([0, 1]) * random.normal(size=3), shading_normal=direction(random.uniform(0, 60), random.uniform(0, 360)),
                eta=[random.choice([1e-3, 0.4, 1, 1.0001, 2.4])] * 8, multiscatter=int(random.integers(2)), backfacing=int(random.integers(2)),
                flux=int(random.integers(2)), coat=random.choice([0, 1]), sheen=random.choice([0, 3]), transmission=random.choice([0, 0.5, 1]),
            )  # fmt: skip
            s = bsdf.sample(points(64))
            value, pdf = bsdf.eval(np.vstack([s["wi"], -s["wi"], wo, -wo]))
            for array in (s["weight"], s["pdf"], value, pdf):
                assert np.isfinite(array).all() and (array >= 0).all(), bsdf.fields
