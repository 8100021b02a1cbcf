# SPDX-License-Identifier: GPL-3.0-or-later
"""What fills a gem: its own medium and what smaller bodies bring into it, but not the fog that it stands in.

The gems here have the index of air, so that rays run straight on and Beer and Lambert say what arrives of a sky of radiance 1.
"""

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.descriptions import Carry, Density, Light, LightType, MaterialFlag, World
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, looking_up, orthographic, picture, placed, sphere

FOG, CLOUD = 0.8, 0.5  # extinctions, 1/m


def body(scene, low, high, medium):
    material = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)
    scene.add_instances(scene.add_mesh(*box(low, high)), IDENTITY, [material])


def fog_box(scene, varies=False):
    """4 m of fog under the camera, which stands above it."""
    how = {"density": Density.HEIGHT, "base_height": 100.0} if varies else {}
    body(scene, (-2, -2, -2), (2, 2, 2), scene.add_medium(FOG, 0.0, **how))


def gem_box(scene, low=(-0.5, -0.5, -0.5), high=(0.5, 0.5, 0.5), **gem):
    scene.add_instances(scene.add_mesh(*box(low, high)), IDENTITY, [scene.add_gem(1.0, **gem)])


def seen(scene, camera=None):
    """Of the sky, through everything."""
    scene.set_world(World(programs.emission()))
    scene.set_camera(**orthographic(0.3, looking_down(10.0) if camera is None else camera))
    scene.commit()
    return picture(scene, 2, samples_per_pass=64, photons_per_pass=0, max_depth=16).mean()


def holds(found, depth):
    expected = np.exp(-depth)
    assert found == pytest.approx(expected, abs=4 * np.sqrt(expected * (1 - expected) / (2 * 64 * 256)))


@pytest.mark.parametrize("varies", [False, True])
def test_a_clear_gem_leaves_no_room_for_the_fog_round_it(varies):
    with Scene(threads=2) as scene:
        fog_box(scene, varies)
        gem_box(scene)
        holds(seen(scene), 3 * FOG)


def test_nor_for_the_fog_of_the_world():
    """From within a gem upwards: what fills the world ends 1 m above the camera, and the gem half way there."""
    with Scene(threads=2) as scene:
        scene.set_world_medium(scene.add_medium(FOG, 0.0, density=Density.HEIGHT, base_height=1.0, scale_height=1e-3))
        gem_box(scene)
        holds(seen(scene, looking_up(0.0)), 0.5 * FOG)


def test_a_clouded_gem_is_filled_with_its_cloud_alone():
    with Scene(threads=2) as scene:
        fog_box(scene)
        gem_box(scene, medium=scene.add_medium(CLOUD, 0.0))
        holds(seen(scene), 3 * FOG + CLOUD)


def test_a_smaller_body_brings_its_medium_into_the_gem():
    with Scene(threads=2) as scene:
        fog_box(scene)
        gem_box(scene)
        body(scene, (-0.4, -0.4, -0.2), (0.4, 0.4, 0.2), scene.add_medium(CLOUD, 0.0))
        holds(seen(scene), 3 * FOG + 0.4 * CLOUD)


def test_of_two_overlapping_gems_the_one_that_counts_brings_its_cloud():
    """Gems from -0.5 to 0.2 and from -0.2 to 0.5: between -0.2 and 0.2 the one of higher priority is there."""
    with Scene(threads=2) as scene:
        first, second = scene.add_medium(CLOUD, 0.0), scene.add_medium(3 * CLOUD, 0.0)
        gem_box(scene, (-0.5, -0.5, -0.5), (0.5, 0.5, 0.2), priority=1, medium=first)
        gem_box(scene, (-0.5, -0.5, -0.2), (0.5, 0.5, 0.5), medium=second)
        holds(seen(scene), 0.7 * CLOUD + 0.3 * 3 * CLOUD)


def test_a_camera_in_a_gem_sees_no_fog_before_it_leaves():
    with Scene(threads=2) as scene:
        fog_box(scene)
        gem_box(scene, (-1, -1, -1), (1, 1, 1))
        holds(seen(scene, looking_down(0.0)), FOG)


def test_photons_and_paths_agree_on_fog_round_a_ball_of_glass():
    """Light of a wide lamp through a ball in fog that scatters: what the ball displaces is missing for photons, paths and shadows alike."""
    images = {}
    with Scene(threads=2) as scene:
        body(scene, (-1.5, -1.5, -1.5), (1.5, 1.5, 1.5), scene.add_medium(0.6, 0.9))
        corners, faces, normals = sphere(0.6)
        scene.add_instances(scene.add_mesh(corners, faces, corner_normals=normals), [placed(0.1, 0.0, 0.0)], [scene.add_gem(1.3)])
        scene.add_light(Light(type=LightType.POINT, power=60.0, radius=0.5, transform=placed(2.4, 0.3, 0.8)[:3]))
        scene.set_camera(**orthographic(1.2, looking_down(10.0)))
        scene.commit()
        for carry in (Carry.NONE, Carry.CAUSTICS, Carry.ALL):
            settings = {"samples_per_pass": 32 if carry == Carry.NONE else 3, "photons_per_pass": 50_000, "volume_radius": 0.03}
            images[carry] = [picture(scene, 4, photons_carry=carry, max_depth=64, seed=seed, **settings) for seed in (1, 2, 3)]
    reference = np.stack(images[Carry.NONE])
    for carry, found in images.items():
        found = np.stack(found)
        means, truth = found.mean(axis=(1, 2, 3)), reference.mean(axis=(1, 2, 3))
        error = np.hypot(means.std(ddof=1), truth.std(ddof=1)) / np.sqrt(3) / truth.mean()
        assert error < 0.01, f"{carry.name}: too noisy to tell"
        assert means.mean() / truth.mean() == pytest.approx(1, abs=0.005 + 4 * error), carry.name
