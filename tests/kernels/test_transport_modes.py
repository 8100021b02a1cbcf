# SPDX-License-Identifier: GPL-3.0-or-later
"""What photons carry is a choice of method, not of picture: every mode converges to the same light, and to the closed form where one is known."""

import math

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.descriptions import Carry, Light, LightType, MaterialFlag, World
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, area, box, looking_down, orthographic, perspective, picture, placed, sphere, square


def hollow_sphere(scene, reflectance):
    corners, faces, _ = sphere(1.0)
    wall = scene.add_material(programs.diffuse((reflectance,) * 3))
    scene.add_instances(scene.add_mesh(corners, faces), IDENTITY, [wall])
    return area(corners, faces)


@pytest.mark.parametrize("reflectance", [0.2, 0.5, 0.8, 0.9])
def test_integrating_sphere_multiplies_light(reflectance):
    """Wall radiance Φρ / (π A (1 - ρ)), Φ the lamp's power (PHYSICS §5.10); the polyhedron's own area A."""
    with Scene(threads=2) as scene:
        surface = hollow_sphere(scene, reflectance)
        scene.add_light(Light(type=LightType.POINT, power=surface * math.pi, transform=placed(z=0.0)[:3]))
        scene.set_camera(**perspective(1.6, looking_down(0.05)))
        scene.commit()
        image = picture(scene, 8, size=24, samples_per_pass=32, photons_per_pass=0, max_depth=256)
    expected = reflectance / (1 - reflectance)
    error = image.std() / 24
    assert error < 0.002 * expected, "too noisy to tell"
    assert image.mean(axis=(0, 1)) == pytest.approx(expected, rel=0.005)


@pytest.mark.parametrize("carry", [Carry.INDIRECT, Carry.ALL])
def test_photons_fill_an_integrating_sphere(carry):
    """The same light brought by photons. A disc of photons on a bent wall is slightly too wide: the radius is small."""
    with Scene(threads=2) as scene:
        surface = hollow_sphere(scene, 0.5)
        scene.add_light(Light(type=LightType.POINT, power=surface * math.pi, transform=placed(z=0.0)[:3]))
        scene.set_camera(**perspective(1.6, looking_down(0.05)))
        scene.commit()
        image = picture(scene, 8, samples_per_pass=2, photons_per_pass=50_000, photons_carry=carry, radius=0.05, max_depth=256)
    assert image.mean(axis=(0, 1)) == pytest.approx(1.0, rel=0.005)


def glass_ball_room(scene):
    """A grey floor and a red wall, a ball of glass, a small mirror and a wide lamp that paths can find through the ball."""
    grey = scene.add_material(programs.diffuse((0.6, 0.6, 0.6)))
    red = scene.add_material(programs.diffuse((0.6, 0.2, 0.1)))
    glass = scene.add_gem(1.5)
    mirror = scene.add_material(programs.mirror((0.9, 0.9, 0.9)), flags=MaterialFlag.CASTER)
    corners, faces, normals = sphere(0.3, 24, 48)
    scene.add_instances(scene.add_mesh(corners, faces, corner_normals=normals), [placed(0.2, 0.1, 0.45)], [glass])
    scene.add_instances(scene.add_mesh(*square(2)), IDENTITY, [grey])
    scene.add_instances(scene.add_mesh(*box((-1.2, -2, 0), (-1.1, 2, 1.5))), IDENTITY, [red])
    scene.add_instances(scene.add_mesh(*box((0.9, -0.4, 0.1), (1.0, 0.4, 0.8))), IDENTITY, [mirror])
    scene.add_light(Light(type=LightType.RECTANGLE, power=20.0, size_u=1.2, size_v=1.2, transform=looking_down(2.5)))
    scene.set_world(World(programs.emission((0.05, 0.06, 0.08))))
    scene.set_camera(**orthographic(1.0, looking_down(2.0)))
    scene.commit()


def test_what_photons_carry_does_not_change_the_picture():
    """CAUSTICS, INDIRECT, ALL and NONE beside each other: means within 1 % and patches of the picture within 3 %, noise allowed for.

    A patch with the ball's caustic is many times as noisy as others where photons are sent everywhere alike: its own noise counts."""
    images = {}
    with Scene(threads=2) as scene:
        glass_ball_room(scene)
        for carry in Carry:
            settings = {"samples_per_pass": 32 if carry == Carry.NONE else 4, "photons_per_pass": 60_000, "radius": 0.02}
            images[carry] = [picture(scene, 16, size=32, photons_carry=carry, max_depth=64, seed=seed, **settings) for seed in (1, 2, 3)]
    patches = {c: np.stack(i).reshape(3, 4, 8, 4, 8, 3).mean(axis=(2, 4)) for c, i in images.items()}
    reference = patches[Carry.CAUSTICS].mean(axis=0)
    for carry, found in patches.items():
        ratio = found.mean(axis=(0, 1, 2)) / reference.mean(axis=(0, 1))
        squares = sum(found_of.var(axis=0, ddof=1) / len(found_of) for found_of in (found, patches[Carry.CAUSTICS]))
        noise = np.sqrt(np.maximum(squares, squares.mean()))
        excess = np.abs(found.mean(axis=0) - reference) - 4 * noise
        print(f"{carry.name}: mean ratio {ratio}, worst patch beyond its noise {excess.max() / reference.mean():.4f}")
        assert ratio == pytest.approx(1.0, abs=0.01), f"{carry.name} / CAUSTICS = {ratio}"
        assert excess.max() < 0.03 * reference.mean(), f"{carry.name}: a patch differs by {excess.max() / reference.mean():.3f} of the mean"


def test_passes_of_light_add_up_to_the_picture():
    names = ("EMISSION", "DIRECT", "INDIRECT", "CAUSTICS")
    from opal_kernels.descriptions import Pass

    with Scene(threads=2) as scene:
        glass_ball_room(scene)
        settings = {"width": 24, "height": 24, "samples_per_pass": 4, "photons_per_pass": 20_000, "passes": [Pass[n] for n in names]}
        with Render(scene, **settings) as render:
            render.run(3)
            combined = render.film("COMBINED")[..., :3]
            parts = sum(render.film(n) for n in names)
    assert parts == pytest.approx(combined, rel=1e-4, abs=1e-4)
