# SPDX-License-Identifier: GPL-3.0-or-later
"""Media that thin with height, in closed form: beside quadrature, and beside the tracking of the same medium said otherwise.

Rays are single (an orthographic camera a millimetre wide), light is a sun without a disc, so that what is compared has no other noise than
that of the distances along the ray.
"""

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.descriptions import Carry, Density, LightType, MaterialFlag, Phase, PhaseKind, World
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, orthographic, picture, square

SIGMA, HEIGHT, BASE = 2e-3, 300.0, 50.0
SUN = np.array([0.0, -np.cos(0.4), np.sin(0.4)])
WAYS = {"up": (0.3, 120.0), "down": (-0.25, 700.0), "level": (0.0, 90.0), "under the base": (0.05, -40.0), "through the base": (-0.1, 60.0)}


def looking(elevation, height):
    """A camera at a height that looks along +Y, up by an elevation (rad)."""
    forward = np.array([0.0, np.cos(elevation), np.sin(elevation)])
    right = np.array([1.0, 0.0, 0.0])
    return orthographic(1e-3, np.column_stack([right, np.cross(right, forward), -forward, [0.0, 0.0, height]]))


def sun_transform():
    right = np.array([1.0, 0.0, 0.0])
    return np.column_stack([right, np.cross(SUN, right), SUN, np.zeros(3)])


def density(z):
    return np.exp(-np.maximum(z - BASE, 0) / HEIGHT)


def depths(elevation, height, lengths):
    """Optical depth from the camera to each of these distances, ascending from 0, by trapezoids."""
    rows = SIGMA * density(height + np.sin(elevation) * lengths)
    return np.concatenate([[0], np.cumsum((rows[1:] + rows[:-1]) / 2 * np.diff(lengths))])


def to_the_sun(z):
    rise = SUN[2]
    below = np.maximum(BASE - z, 0)
    return SIGMA * (below + HEIGHT * density(z)) / rise


def seen(scene, elevation, height, seeds=2, passes=1, **settings):
    scene.set_camera(**looking(elevation, height))
    scene.commit()
    settings = {"samples_per_pass": 64, "photons_per_pass": 0, "max_depth": 0, **settings}
    return np.mean([picture(scene, passes, 8, seed=seed, **settings).mean() for seed in range(seeds)])


def wall(scene, distance):
    """A black wall across the view."""
    corners, faces = square(1e5, 0.0)
    turn = np.array([[1.0, 0, 0, 0], [0, 0, -1, distance], [0, 1, 0, 0], [0, 0, 0, 1]])
    scene.add_instances(scene.add_mesh(corners, faces), [turn], [scene.add_material(programs.diffuse((0, 0, 0)))])


def fill_world(scene, albedo, **more):
    """Rain everywhere. The sheet of one millimetre, far away, puts the ground deep."""
    scene.set_world_medium(scene.add_medium(SIGMA, albedo, density=Density.HEIGHT, scale_height=HEIGHT, base_height=BASE, **more))
    corners, faces = square(1e-3, -1e5)
    scene.add_instances(scene.add_mesh(corners, faces), IDENTITY, [scene.add_material(programs.diffuse((0, 0, 0)))])


@pytest.mark.parametrize("way", ["up", "under the base"])
def test_the_sky_shines_through_as_beer_and_lambert_say(way):
    elevation, height = WAYS[way]
    with Scene(threads=2) as scene:
        fill_world(scene, 0.0)
        scene.set_world(World(programs.emission()))
        lengths = np.linspace(0, 60 * HEIGHT / np.sin(elevation), 400_001)
        expected = np.exp(-depths(elevation, height, lengths)[-1])
        # A path comes through or it does not: the error of 8192 stratified ones.
        assert seen(scene, elevation, height) == pytest.approx(expected, abs=4 * np.sqrt(expected * (1 - expected) / 8192))


@pytest.mark.parametrize("way", WAYS)
def test_single_scattering_of_the_sun_along_a_ray_is_its_integral(way):
    """L = E / 4 pi, integrated over sigma T(camera) T(sun), to a wall 2 km away: 0.3 % at 8192 samples, of a clean integrand."""
    elevation, height = WAYS[way]
    with Scene(threads=2) as scene:
        fill_world(scene, 1.0)
        wall(scene, 2000.0 * np.cos(elevation))
        scene.add_light(type=LightType.SUN, power=1.0, transform=sun_transform())
        lengths = np.linspace(0, 2000.0, 200_001)
        z = height + np.sin(elevation) * lengths
        integrand = SIGMA * density(z) * np.exp(-depths(elevation, height, lengths) - to_the_sun(z))
        expected = np.trapezoid(integrand, lengths) / (4 * np.pi)
        assert seen(scene, elevation, height) == pytest.approx(expected, rel=3e-3)


@pytest.mark.parametrize("way", ["up", "down"])
def test_a_cloud_in_the_haze_adds_to_it(way):
    """A homogeneous box from 300 to 500 m along the ray, in the same world: the distances of both together."""
    elevation, height = WAYS[way]
    more, cos = 1.5e-3, np.cos(elevation)
    with Scene(threads=2) as scene:
        fill_world(scene, 1.0)
        wall(scene, 2000.0 * cos)
        cloud = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=scene.add_medium(more, 1.0))
        scene.add_instances(scene.add_mesh(*box((-1e4, 300 * cos, -1e4), (1e4, 500 * cos, 1e4))), IDENTITY, [cloud])
        scene.add_light(type=LightType.SUN, power=1.0, transform=sun_transform())
        lengths = np.linspace(0, 2000.0, 200_001)
        z = height + np.sin(elevation) * lengths
        inside = (lengths >= 300) & (lengths <= 500)
        sigma = SIGMA * density(z) + more * inside
        depth = np.concatenate([[0], np.cumsum((sigma[1:] + sigma[:-1]) / 2 * np.diff(lengths))])
        # From inside the cloud the sun's way leads back through its near side.
        through = more * np.where(inside, (lengths - 300) * cos, np.where(lengths > 500, 200 * cos, 0)) / -SUN[1]
        expected = np.trapezoid(sigma * np.exp(-depth - to_the_sun(z) - through), lengths) / (4 * np.pi)
        assert seen(scene, elevation, height, seeds=4) == pytest.approx(expected, rel=6e-3)


def test_the_guide_to_the_sun_changes_the_noise_alone():
    """A slab of forward haze over diffuse ground under a sun, and under a lamp as far away as makes no difference, which guides nothing."""
    phase = Phase(kind=PhaseKind.HENYEY_GREENSTEIN, anisotropy=0.7)
    far, means, errors = 1e5, [], []
    for sun in (True, False):
        with Scene(threads=2) as scene:
            material = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=scene.add_medium(1.0, 1.0, phase))
            scene.add_instances(scene.add_mesh(*box((-200, -200, 0), (200, 200, 1))), IDENTITY, [material])
            corners, faces = square(200, 0.2)
            scene.add_instances(scene.add_mesh(corners, faces), IDENTITY, [scene.add_material(programs.diffuse((0.5, 0.5, 0.5)))])
            if sun:
                scene.add_light(type=LightType.SUN, power=1.0, transform=sun_transform())
            else:
                place = np.column_stack([np.eye(3), far * SUN])
                scene.add_light(type=LightType.POINT, power=4 * np.pi * far**2, transform=place)
            scene.set_camera(**orthographic(0.4, looking_down(5.0)))
            scene.commit()
            pictures = [picture(scene, 1, 12, seed=s, samples_per_pass=160, photons_per_pass=0, max_depth=64).mean() for s in range(6)]
            means.append(np.mean(pictures))
            errors.append(np.std(pictures, ddof=1) / 6**0.5)
    assert max(errors) < 0.006 * means[0], f"too noisy to tell: {errors} of {means}"
    assert means[0] == pytest.approx(means[1], abs=4 * np.hypot(*errors)), (means, errors)


def test_under_the_ground_nothing_is_scattered():
    """Beyond the edge of what is modelled, a ray that goes down into the ground gets the light of the rain above it alone."""
    with Scene(threads=2) as scene:
        scene.set_world_medium(scene.add_medium(SIGMA, 1.0, density=Density.HEIGHT, scale_height=HEIGHT, base_height=0.0))
        scene.add_light(type=LightType.SUN, power=1.0, transform=sun_transform())
        elevation, height = -0.3, 60.0
        lengths = np.linspace(0, height / np.sin(0.3), 100_001)
        z = height + np.sin(elevation) * lengths
        air = np.exp(-z / HEIGHT)
        depth = np.concatenate([[0], np.cumsum(SIGMA * (air[1:] + air[:-1]) / 2 * np.diff(lengths))])
        expected = np.trapezoid(SIGMA * air * np.exp(-depth - SIGMA * HEIGHT * air / SUN[2]), lengths) / (4 * np.pi)
        assert seen(scene, elevation, height, seeds=8) == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize("source", ["sun", "sky"])
@pytest.mark.parametrize("height", [100.0, None])
def test_photons_from_afar_come_through_the_haze_above_the_scene(source, height):
    """Ground under haze of depth 1, all of whose light photons bring: half of E exp(-1) / pi of a sun; nothing through haze without an end."""
    with Scene(threads=2) as scene:
        shape = {} if height is None else {"density": Density.HEIGHT, "scale_height": height}
        scene.set_world_medium(scene.add_medium(1e-2, 0.0, **shape))
        scene.add_instances(scene.add_mesh(*square(1.0)), IDENTITY, [scene.add_material(programs.diffuse((0.5, 0.5, 0.5)))])
        if source == "sun":
            scene.add_light(type=LightType.SUN, power=1.0, transform=looking_down(0.0))
        else:
            scene.set_world(World(programs.emission()))
        scene.set_camera(**orthographic(0.5, looking_down(1e-3)))
        scene.commit()
        settings = {"size": 4, "seed": 1, "samples_per_pass": 256}
        found = picture(scene, 2, photons_per_pass=100_000, photons_carry=Carry.ALL, **settings).mean()
        expected = picture(scene, 2, photons_per_pass=0, **settings).mean()
    if height is None:
        assert found == expected == 0
    else:
        if source == "sun":
            assert expected == pytest.approx(0.5 * np.exp(-1) / np.pi, rel=3e-3)
        assert found == pytest.approx(expected, rel=0.03)


def test_sixteen_samples_make_a_clean_bow():
    """What is scattered once is an integral along the ray: with the light of a bow and of the sky about it, under 4 % of noise a pixel, all of it from the choice of wavelengths."""
    from opal_kernels import droplets
    from opal_kernels.optics.rainbow import sun as sun_disc

    phase = droplets.phase(droplets.Drops("AIRY", 250.0))
    with Scene(threads=2) as scene:
        fill_world(scene, 1.0, phase=phase)
        scene.add_light(type=LightType.SUN, power=1.0, radius=sun_disc.MEAN_RADIUS_RAD, transform=sun_transform())
        for radius in (30.0, 41.0, 46.0):  # inside the bow, on it, in the dark band
            scene.set_camera(**looking(np.radians(radius) - 0.4, 100.0))
            scene.commit()
            pixels = picture(scene, 1, 12, samples_per_pass=16, photons_per_pass=0, max_depth=0) @ [0.2126, 0.7152, 0.0722]
            assert pixels.std() < 0.04 * pixels.mean(), radius
