# SPDX-License-Identifier: GPL-3.0-or-later
"""Three ways to look up photons in media, three shares of the light for them to carry, one picture (PHYSICS §5.18)."""

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.descriptions import Carry, Density, Light, LightType, MaterialFlag, Phase, PhaseKind, VolumeEstimate
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, orthographic, perspective, picture, placed, sphere, square

TILTED = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.96, -0.28, 0.0], [0.0, 0.28, 0.96, 5.0]])
TURNED = np.array([[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]])


def fill(scene, low, high, medium):
    material = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)
    scene.add_instances(scene.add_mesh(*box(low, high)), IDENTITY, [material])


def means_of(scene, seeds=(1, 2, 3, 4), passes=4, **settings):
    """Means of the picture's channels, (3,), and their standard errors as these few seeds know them."""
    found = np.array([picture(scene, passes, seed=seed, max_depth=64, **settings).mean(axis=(0, 1)) for seed in seeds])
    return found.mean(axis=0), found.std(axis=0, ddof=1) / len(seeds) ** 0.5


def agrees(name, found, expected, tolerance=0.01):
    """Each channel within `tolerance`, noise included. Tests say how large a standard error is; the few seeds of a test, which know it to
    a factor of two, are to find no more than half of the tolerance."""
    error = np.hypot(found[1], expected[1]) / expected[0]
    assert error.max() < 0.5 * tolerance, f"{name}: too noisy to tell, {error}"
    ratio = found[0] / expected[0] - 1
    assert np.abs(ratio).max() < tolerance, f"{name}: {ratio}, error {error}"


@pytest.mark.parametrize("slant", [False, True])
def test_estimates_agree_with_each_other_and_with_paths(slant):
    """The inside of a box of fog under the sun, seen head on and at an angle of 37° to its faces.

    A kernel of 0.1 m reaches out of a box of 2 m for a twentieth of the way at either end; spheres that did not know would bring 3.5 %
    less. Within 1 %: of that the blur of beams takes 0.7 % where many of a box's edges are seen, with half of that radius; standard
    errors of the ratios are 0.2 to 0.3 %, of 16 seeds."""
    camera = np.eye(4)
    if slant:
        camera[:3, :3] = TURNED
    camera[:3, 3] = camera[:3, 2] * 10
    with Scene(threads=2) as scene:
        fill(scene, (-1, -1, -1), (1, 1, 1), scene.add_medium(1.0, 0.8, Phase(PhaseKind.HENYEY_GREENSTEIN, 0.3)))
        scene.add_light(Light(type=LightType.SUN, power=1.0, transform=TILTED))
        # Nearly the whole box, so that few photons are in vain; but none of the sides that the rays go along.
        width, height = (1.2 if slant else 0.8), 0.8
        scene.set_camera(**{**orthographic(1.0, camera[:3]), "window": (-width, width, -height, height)})
        scene.commit()
        expected = means_of(scene, samples_per_pass=64, photons_per_pass=0)
        for carry in (Carry.INDIRECT, Carry.ALL):
            for estimate in VolumeEstimate:
                radius = 0.05 if estimate == VolumeEstimate.BEAMS else 0.1
                settings = {"photons_carry": carry, "volume_estimate": estimate, "volume_radius": radius, "gather": 256, "march_steps": 4}
                photons = 60_000 if estimate == VolumeEstimate.POINTS else 30_000
                found = means_of(scene, samples_per_pass=8, photons_per_pass=photons, **settings)
                agrees(f"{carry.name} {estimate.name}", found, expected)


def test_the_blur_of_edges_goes_with_the_radius():
    """The whole box with its silhouette, where discs reach out to the side: what is missing halves with the radius."""
    with Scene(threads=2) as scene:
        fill(scene, (-1, -1, -1), (1, 1, 1), scene.add_medium(1.0, 0.8))
        scene.add_light(Light(type=LightType.POINT, power=60.0, radius=0.1, transform=placed(2.5, 0, 1.5)[:3]))
        scene.set_camera(**orthographic(0.99, looking_down(10.0)))
        scene.commit()
        expected = means_of(scene, samples_per_pass=32, photons_per_pass=0)[0]
        settings = {"photons_carry": Carry.ALL, "volume_estimate": VolumeEstimate.BEAM_RADIANCE}
        wide, narrow = (means_of(scene, samples_per_pass=4, photons_per_pass=50_000, volume_radius=r, **settings)[0] for r in (0.2, 0.05))
    missing, left = 1 - (wide / expected).mean(), 1 - (narrow / expected).mean()
    assert 0.02 < missing < 0.06
    assert abs(left) < 0.4 * missing


@pytest.mark.parametrize("carry", [Carry.INDIRECT, Carry.ALL])
def test_a_lamp_whose_sphere_lies_in_the_medium_shines_inwards_too(carry):
    """A sphere of 0.2 m in fog: photons that only left it outwards would miss the light that paths find inside of it.
    Within 1.5 %: the eight seeds' own spread puts the standard error at 0.55 %."""
    with Scene(threads=2) as scene:
        fill(scene, (-1, -1, -1), (1, 1, 1), scene.add_medium(0.5, 0.8))
        scene.add_light(Light(type=LightType.POINT, power=60.0, radius=0.2, soft_falloff=0, transform=placed()[:3]))
        scene.set_camera(**orthographic(0.99, looking_down(10.0)))
        scene.commit()
        expected = means_of(scene, samples_per_pass=64, photons_per_pass=0)
        settings = {"photons_carry": carry, "volume_estimate": VolumeEstimate.BEAM_RADIANCE, "volume_radius": 0.03}
        found = means_of(scene, range(1, 9), samples_per_pass=32, photons_per_pass=40_000, **settings)
    agrees(carry.name, found, expected, 0.015)


@pytest.mark.parametrize(("half", "carry"), [(0.5, Carry.INDIRECT), (None, Carry.ALL)])
def test_a_lamp_in_fog_without_an_end_shines_all_round(half, carry):
    """Five metres over a square of one and beside the view, far outside of the sphere round all there is (a fifth of the light is indirect), and over nothing."""
    with Scene(threads=2) as scene:
        scene.set_world_medium(scene.add_medium(0.1, 0.9))
        if half:
            scene.add_instances(scene.add_mesh(*square(half)), IDENTITY, [scene.add_material(programs.diffuse((0.5, 0.5, 0.5)))])
        scene.add_light(type=LightType.POINT, power=100.0, transform=placed(2.5, 0.0, 5.0)[:3])
        scene.set_camera(**orthographic(1.0, looking_down(10.0)))
        scene.commit()
        expected = means_of(scene, passes=1, samples_per_pass=64, photons_per_pass=0)
        settings = {"photons_carry": carry, "volume_estimate": VolumeEstimate.BEAMS, "volume_radius": 0.1}
        found = means_of(scene, passes=1, samples_per_pass=4, photons_per_pass=12_000, **settings)
    agrees(carry.name, found, expected, 0.08)


def fog_between_walls(scene):
    """A lamp over a floor and between two walls, in fog."""
    fill(scene, (-1.4, -1.4, -0.9), (1.4, 1.4, 1.4), scene.add_medium(0.5, 0.9))
    scene.add_instances(scene.add_mesh(*square(1.5, -1.0)), IDENTITY, [scene.add_material(programs.diffuse((0.7, 0.7, 0.7)))])
    red = scene.add_material(programs.diffuse((0.7, 0.2, 0.2)))
    scene.add_instances(scene.add_mesh(*box((-1.6, -1.5, -1), (-1.5, 1.5, 1.5))), IDENTITY, [red])
    scene.add_light(Light(type=LightType.RECTANGLE, power=20.0, size_u=0.8, size_v=0.8, transform=looking_down(2.5)))


def cloud_beside_a_mirror(scene):
    """Uneven density that scatters forwards, and a mirror that lights it once more."""
    cloud = scene.add_medium(2.0, 0.9, Phase(PhaseKind.HENYEY_GREENSTEIN, 0.5), density=Density.NOISE, noise_scale=0.5, noise_contrast=2.0)
    fill(scene, (-0.9, -0.9, -0.9), (0.9, 0.9, 0.9), cloud)
    mirror = scene.add_material(programs.mirror((0.9, 0.9, 0.9)), flags=MaterialFlag.CASTER)
    scene.add_instances(scene.add_mesh(*box((1.2, -1, -1), (1.3, 1, 1))), IDENTITY, [mirror])
    scene.add_light(Light(type=LightType.RECTANGLE, power=20.0, size_u=3.0, size_v=3.0, transform=looking_down(2.5)))


def coloured_fog_round_glass(scene):
    """A ball of dispersive glass in fog whose extinction doubles over the spectrum.

    No floor: the ball, a lens, would show one spot of it over its whole disc, so that the few photons round that spot set the mean."""
    extinction = np.linspace(0.8, 0.4, 471)
    fill(scene, (-1.4, -1.4, -0.95), (1.4, 1.4, 1.4), scene.add_medium(extinction, 0.9))
    corners, faces, normals = sphere(0.5)
    glass = scene.add_gem(1.5 + 4000.0 / np.arange(360.0, 831.0) ** 2)
    scene.add_instances(scene.add_mesh(corners, faces, corner_normals=normals), [placed(0.1, 0.0, -0.3)], [glass])
    scene.add_light(Light(type=LightType.POINT, power=60.0, radius=0.6, transform=placed(2.6, 0.3, 1.0)[:3]))


@pytest.mark.parametrize(
    "build, samples, tolerance",
    [(fog_between_walls, 64, 0.01), (cloud_beside_a_mirror, 256, 0.015), (coloured_fog_round_glass, 256, 0.015)],
)
def test_what_photons_carry_does_not_change_media(build, samples, tolerance):
    """CAUSTICS, INDIRECT and ALL beside paths alone: each channel within 1 %, which is five standard errors of the fog between walls, and
    within 1.5 % where mirrors and glass are, which is three: a third of that would take ten times as long."""
    with Scene(threads=2) as scene:
        build(scene)
        scene.set_camera(**orthographic(1.1, looking_down(2.2)))
        scene.commit()
        expected = means_of(scene, samples_per_pass=samples, photons_per_pass=0)
        for carry in (Carry.CAUSTICS, Carry.INDIRECT, Carry.ALL):
            settings = {"photons_carry": carry, "volume_radius": 0.04, "radius": 0.04}
            own = max(32, samples // 4) if carry == Carry.CAUSTICS else samples // 16  # paths bring the direct light of CAUSTICS
            found = means_of(scene, samples_per_pass=own, photons_per_pass=40_000, **settings)
            agrees(carry.name, found, expected, tolerance)


@pytest.mark.parametrize("estimate", [VolumeEstimate.POINTS, VolumeEstimate.BEAMS])
def test_photons_of_media_have_a_count_of_their_own(estimate):
    """Four times as many for the medium as for the floor under it: so many are left, and the picture is as bright as before."""
    with Scene(threads=2) as scene:
        fill(scene, (-1, -1, -1), (1, 1, 1), scene.add_medium(1.0, 0.8))
        scene.add_instances(scene.add_mesh(*square(1.5, -1.2)), IDENTITY, [scene.add_material(programs.diffuse((0.7, 0.7, 0.7)))])
        scene.add_light(Light(type=LightType.SUN, power=1.0, transform=TILTED))
        scene.set_camera(**orthographic(0.8, looking_down(10.0)))
        scene.commit()
        settings = {"photons_carry": Carry.ALL, "volume_estimate": estimate, "volume_radius": 0.1, "radius": 0.1, "gather": 256}
        found, counts = {}, {}
        for apart in (0, 80_000):
            means = []
            for seed in range(8):
                with Render(
                    scene, width=16, height=16, samples_per_pass=16, photons_per_pass=20_000, volume_photons=apart, seed=seed, **settings
                ) as render:
                    means.append(render.run(1).film()[..., :3].mean(axis=(0, 1), dtype=float))
                    counts[apart] = render.statistics
            found[apart] = np.mean(means, axis=0), np.std(means, axis=0, ddof=1) / 8**0.5
    together, apart = counts[0], counts[80_000]
    assert (together["volume_photons_emitted"], apart["volume_photons_emitted"]) == (20_000, 80_000)
    assert apart["photons_emitted"] == together["photons_emitted"] and apart["photons_stored"] == together["photons_stored"]
    assert apart["volume_photons_stored"] == pytest.approx(4 * together["volume_photons_stored"], rel=0.03)
    agrees("apart", found[80_000], found[0], 0.015)  # of which the eight seeds' standard error is 0.5 %


@pytest.mark.parametrize("tolerance", [0.1, 0.5])
def test_steps_are_halved_where_neighbours_differ(tolerance):
    """A narrow shaft across a ray of four steps of 0.5 m: halved steps find it where whole ones mostly miss. A tolerance that nothing
    exceeds is as good as none."""
    along_x = np.array([[0, 0, 1, 1.5], [0, 1, 0, 0], [-1, 0, 0, 0.3]])
    with Scene(threads=2) as scene:
        fill(scene, (-1, -1, -1), (1, 1, 1), scene.add_medium(0.3, 0.8))
        scene.add_light(Light(type=LightType.SPOT, power=60.0, spot_angle=0.12, transform=along_x))
        scene.set_camera(**orthographic(0.1, looking_down(10.0)))
        scene.commit()
        converged = picture(scene, 4, 8, samples_per_pass=64, photons_per_pass=0, max_depth=32)
        settings = {
            "photons_carry": Carry.ALL,
            "volume_estimate": VolumeEstimate.POINTS,
            "volume_radius": 0.05,
            "gather": 100,
            "march_steps": 4,
        }

        def march(tolerance):
            return picture(scene, 1, 8, samples_per_pass=1, photons_per_pass=100_000, max_depth=32, march_tolerance=tolerance, **settings)

        whole, halved, never = march(0.0), march(tolerance), march(100.0)
    error, least = (np.sqrt(np.mean((found - converged) ** 2)) / converged.mean() for found in (whole, halved))
    assert least < 0.3 * error, f"{error:.3f} of whole steps, {least:.3f} of halved ones"
    assert np.array_equal(never, whole)


SIZE, FLOOR = 24, 0.01


def report_box(scene):
    """The fog box of 2013: extinction 0.5 between white, red and green walls, and a light that goes straight down."""
    colours = {"floor": (0.75, 0.75, 0.75), "back": (0.75, 0.75, 0.75), "left": (0.63, 0.06, 0.05), "right": (0.12, 0.48, 0.10)}
    walls = {
        "floor": ((-1, -1, -1.1), (1, 1, -1)),
        "back": ((-1, 1, -1), (1, 1.1, 1)),
        "left": ((-1.1, -1, -1), (-1, 1, 1)),
        "right": ((1, -1, -1), (1.1, 1, 1)),
    }
    for name, (low, high) in walls.items():
        scene.add_instances(scene.add_mesh(*box(low, high)), IDENTITY, [scene.add_material(programs.diffuse(colours[name]))])
    fill(scene, (-0.999, -0.999, -0.999), (0.999, 0.999, 0.999), scene.add_medium(0.5, 0.9))
    scene.add_light(Light(type=LightType.SPOT, power=200.0, radius=0.15, spot_angle=1.2, transform=looking_down(1.4)))
    towards_back = np.array([[1, 0, 0, 0], [0, 0, -1, -5.0], [0, 1, 0, 0.0]])
    scene.set_camera(**perspective(0.42, towards_back))
    scene.commit()


def outliers(image, converged):
    """Pixels of `image` above and below their 3 x 3 neighbourhood in the converged picture by more than 5 standard deviations."""
    luminance = [i @ (0.2126, 0.7152, 0.0722) for i in (image, converged)]
    around = np.lib.stride_tricks.sliding_window_view(luminance[1], (3, 3))
    mean, spread = around.mean(axis=(2, 3)), around.std(axis=(2, 3))
    # Where the neighbourhood is even, what is left of the converged picture's own noise.
    away = (luminance[0][1:-1, 1:-1] - mean) / np.maximum(spread, FLOOR * mean)
    return int(np.sum(away > 5)), int(np.sum(away < -5))


@pytest.fixture(scope="module")
def converged_box():
    with Scene(threads=2) as scene:
        report_box(scene)
        return picture(scene, 4, SIZE, samples_per_pass=192, photons_per_pass=0, max_depth=32)


@pytest.mark.parametrize("estimate", VolumeEstimate)
def test_passes_take_away_the_spots_and_blotches_of_the_fog_box(estimate, converged_box):
    """10,000 photons, 100 gathered, 5 steps a ray, extinction 0.5. A pass has bright spots and dark blotches; passes leave none of
    either: a normal distribution has 6e-7 of its pixels beyond 5 deviations, so of 484 none is expected."""
    with Scene(threads=2) as scene:
        report_box(scene)
        settings = {"photons_carry": Carry.INDIRECT, "volume_estimate": estimate, "gather": 100, "march_steps": 5, "march_tolerance": 0.0}
        bright, dark = [], []
        with Render(scene, width=SIZE, height=SIZE, samples_per_pass=1, photons_per_pass=10_000, max_depth=32, **settings) as render:
            for number in range(64):
                render.run_pass(number)
                if number in (0, 7, 63):
                    above, below = outliers(render.film()[..., :3].astype(np.float64), converged_box)
                    bright.append(above)
                    dark.append(below)
    for counts in (bright, dark):
        assert counts[0] > 4, f"one pass shows what the report showed: {bright} bright, {dark} dark"
        assert counts[0] > counts[1] >= counts[2] == 0, f"{bright} bright, {dark} dark"
