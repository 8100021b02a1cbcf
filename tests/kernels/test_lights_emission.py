# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons: the flux that they carry through a sphere is what the lights send through it, overlapping targets included.

The truth is quadrature of next-event estimation: flux into a ball = integral over its surface of the irradiance that would
arrive there without the ball, each point facing outwards.
"""

import numpy as np
import pytest
from light_probe import (
    direction_program,
    emission_program,
    lamp,
    lights_along,
    looking,
    numbers,
    receiver,
    sample_emission,
    sample_light,
    scene_with,
)
from opal_kernels.descriptions import LightType, MaterialFlag, World
from opal_kernels.scene import Scene

# Two targets that overlap and one apart.
TARGETS = [(0.0, 0.0, 0.0, 0.5), (0.4, 0.1, 0.2, 0.4), (-1.5, 0.5, 0.0, 0.3)]

LAMPS = {
    "point": lamp(LightType.POINT, (1.0, 0.5, 3.0), power=100.0),
    "sphere": lamp(LightType.POINT, (1.0, 0.5, 3.0), power=100.0, radius=0.3, soft_falloff=0),
    "point among the targets": lamp(LightType.POINT, (-0.2, 0.0, 0.1), power=10.0),
    "spot that covers them": lamp(LightType.SPOT, (1.0, 0.5, 3.0), (-0.4, -0.1, -1), power=100.0, spot_angle=1.5, spot_blend=0.5),
    "narrow spot": lamp(LightType.SPOT, (0.3, 0.2, 3.0), (-0.1, -0.05, -1), power=100.0, spot_angle=0.15, spot_blend=0.5),
    "sized spot": lamp(LightType.SPOT, (1.0, 0.5, 3.0), (-0.4, -0.1, -1), power=100.0, spot_angle=0.6, radius=0.2, soft_falloff=0),
    "sun": lamp(LightType.SUN, direction=(0.3, 0.1, -1), power=3.0),
    "wide sun": lamp(LightType.SUN, direction=(0.3, 0.1, -1), power=3.0, radius=0.4),
    "rectangle": lamp(LightType.RECTANGLE, (1.0, 0.5, 1.5), (-0.5, 0, -1), power=100.0, size_u=1.5, size_v=0.5),
    "ellipse": lamp(LightType.ELLIPSE, (1.0, 0.5, 1.5), (-0.5, 0, -1), power=100.0, size_u=1.5, size_v=0.5),
    "rectangle with spread": lamp(LightType.RECTANGLE, (0.3, 0.1, 2.5), (0, 0, -1), power=100.0, size_u=1.0, size_v=0.5, spread=0.7),
    "rectangle that looks past": lamp(LightType.RECTANGLE, (2.0, 0, 0.2), (0.1, 0, -1), power=100.0, size_u=0.5, size_v=0.5),
}  # fmt: skip


def through(origin, direction, flux, target):
    """Total flux of the photons whose line enters a target ahead of where they start outside of it."""
    centre, radius = np.asarray(target[:3]), target[3]
    origin, direction = origin.astype(np.float64), direction.astype(np.float64)
    direction /= np.maximum(np.linalg.norm(direction, axis=1), 1e-30)[:, None]
    to_centre = centre - origin
    along = np.einsum("ij,ij->i", to_centre, direction)
    miss = np.einsum("ij,ij->i", to_centre, to_centre) - along**2
    hits = (miss < radius**2) & (along > 0)
    return flux[hits].sum(axis=0) / len(flux), np.where(hits[:, None], flux, 0).std(axis=0) / np.sqrt(len(flux))


def flux_into(scene, target, n=2000, per_point=16):
    """Quadrature over the target's surface of the irradiance on its outer side."""
    u = numbers(n, 2, 11)
    z, phi = 1 - 2 * u[:, 0], 2 * np.pi * u[:, 1]
    r = np.sqrt(1 - z * z)
    normals = np.column_stack([r * np.cos(phi), r * np.sin(phi), z])
    total = np.zeros((n, 3))
    for i, normal in enumerate(normals):
        where = receiver(np.asarray(target[:3]) + target[3] * normal, normal)
        s = sample_light(scene, where, numbers(per_point, 3, i))
        lit = s["pdf"] > 0
        cosine = np.clip(s["direction"] @ normal, 0, None)
        value = np.zeros((per_point, 3))
        value[lit] = s["radiance"][lit] * (cosine[lit] / s["pdf"][lit])[:, None]
        total[i] = value.mean(axis=0)
    area = 4 * np.pi * target[3] ** 2
    return area * total.mean(axis=0), area * total.std(axis=0) / np.sqrt(n)


def check(scene, target, photons, points=2000, tolerance=0.01):
    """Both sides are quasi-random sums whose error falls nearly as 1 / n: what is allowed is far outside of it."""
    assert through(*photons, target)[0] == pytest.approx(flux_into(scene, target, points)[0], rel=tolerance)


@pytest.mark.parametrize("name", LAMPS)
@pytest.mark.parametrize("target", TARGETS)
def test_flux_through_each_target_is_that_of_the_lamp(name, target):
    if name == "point among the targets" and target == TARGETS[0]:
        pytest.skip("the lamp is inside: nothing enters")
    with scene_with(LAMPS[name], floor=True) as scene:
        rare = name in (
            "narrow spot",
            "sized spot",
            "rectangle that looks past",
        )  # most photons or directions find nothing
        photons = sample_emission(scene, TARGETS, numbers(100_000 if rare else 50_000, 6))[:3]
        if name == "narrow spot" and target == TARGETS[2]:
            assert through(*photons, target)[0].max() == 0
            return
        check(scene, target, photons, 6000 if rare else 1000, 0.03 if rare else 0.01)


@pytest.mark.parametrize("name", ["point", "wide sun", "rectangle", "narrow spot", "rectangle with spread"])
def test_photons_are_not_wasted_on_what_is_not_a_target(name):
    with scene_with(LAMPS[name], floor=True) as scene:
        origin, direction, flux, _ = sample_emission(scene, TARGETS, numbers(20_000, 6))
    carried = flux.max(axis=1) > 0
    hits = np.zeros(len(flux), bool)
    for *centre, radius in TARGETS:
        to_centre = np.asarray(centre) - origin
        along = np.einsum("ij,ij->i", to_centre, direction)
        hits |= (np.einsum("ij,ij->i", to_centre, to_centre) - along**2 < (radius * 1.001) ** 2) & (along > 0)
    assert carried.mean() > 0.9
    assert hits[carried].mean() > 0.95 if "narrow" not in name and "spread" not in name else hits[carried].mean() > 0.3


def test_a_small_target_far_away_gets_as_many_photons_as_a_large_one_near():
    """A gem of a centimetre a kilometre from the lamp: every photon goes there and carries its share."""
    target = (800.0, 600.0, -4.0, 0.01)
    with scene_with(lamp(LightType.POINT, (0, 0, 0), power=4 * np.pi), floor=True) as scene:
        origin, direction, flux, _ = sample_emission(scene, [target], numbers(5000, 6))
    found = through(origin, direction, flux, (*target[:3], target[3] * 1.05))[0]
    distance2 = np.sum(np.square(target[:3]))
    assert found == pytest.approx(np.full(3, np.pi * target[3] ** 2 / distance2), rel=5e-3)


def test_soft_lamps_send_what_their_discs_would():
    """A facing disc gives 1 / (1 + r²/d²) of its intensity; photons that it could not have sent do not count."""
    radius, centre = 0.8, np.array([0.0, 0.0, 2.0])
    light = lamp(LightType.POINT, centre, power=4 * np.pi, radius=radius, soft_falloff=1)
    probe = np.zeros(3)
    target = (0.0, 0.0, 0.0, 0.02)
    with scene_with(light, floor=True) as scene:
        photons = sample_emission(scene, [target], numbers(200_000, 6), probe=probe)[:3]
    found, error = through(*photons, target)
    expected = np.pi * target[3] ** 2 / (4 + radius**2)
    assert found == pytest.approx(np.full(3, expected), rel=5e-3, abs=4 * error.max())


@pytest.mark.parametrize("map_width", [0, 64])
def test_flux_of_the_world_through_each_target(map_width):
    world = World(
        program=direction_program(2.0) if map_width else emission_program((1, 1, 1)),
        map_width=map_width,
    )
    with scene_with(world=world, floor=True) as scene:
        photons = sample_emission(scene, TARGETS, numbers(100_000, 6))[:3]
        z, phi = 1 - 2 * numbers(100_000, 2)[:, 0], 2 * np.pi * numbers(100_000, 2)[:, 1]
        sky = np.column_stack([np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z])
        radiance = lights_along(scene, (0, 0, 0), sky)[1].mean(axis=0)
    for target in TARGETS:  # a ball shows its disc to every direction
        expected = 4 * np.pi * radiance * np.pi * target[3] ** 2
        assert through(*photons, target)[0] == pytest.approx(expected, rel=0.01)


def test_flux_of_an_emissive_mesh_through_each_target():
    with Scene(threads=1) as scene:
        material = scene.add_material(emission_program((1.0, 0.5, 0.25), 5.0), flags=MaterialFlag.EMISSIVE)
        mesh = scene.add_mesh(
            [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]],
            [[0, 1, 2], [0, 2, 3]],
        )
        scene.add_instances(mesh, [looking((0.4, 0, 1), (0.5, 0.3, 1.4))], [material])
        scene.commit()
        photons = sample_emission(scene, TARGETS, numbers(50_000, 6))[:3]
        for target in TARGETS:
            check(scene, target, photons)


def test_sources_are_chosen_by_what_they_send_to_the_targets():
    near = lamp(LightType.POINT, (0, 0, 2), power=1.0)
    far = lamp(LightType.POINT, (0, 0, 200), power=1.0)
    with scene_with(near, far, floor=True) as scene:
        source = sample_emission(scene, TARGETS, numbers(2000, 6))[3]
    assert (source[:, 1] == 0).mean() > 0.99


def test_lamps_without_caustics_send_no_photons_to_casters():
    with scene_with(lamp(LightType.POINT, (0, 0, 2), caustics=0), floor=True) as scene:
        assert sample_emission(scene, TARGETS, numbers(100, 6))[2].max() == 0
        assert sample_emission(scene, [], numbers(100, 6))[2].max() > 0


@pytest.mark.parametrize("name", ["point", "sphere", "spot that covers them", "rectangle", "ellipse"])
def test_without_targets_the_whole_power_is_emitted(name):
    """Into a scene that surrounds the lamp; a spot's power is that of its cone."""
    light = LAMPS[name]
    with scene_with(light, floor=True) as scene:
        flux = sample_emission(scene, [], numbers(100_000, 6))[2]
    expected = light.power
    if light.type == LightType.SPOT:
        half = np.cos(light.spot_angle / 2)
        c = np.linspace(half, 1, 20_001)
        x = np.clip((c - half) / ((1 - half) * light.spot_blend), 0, 1)
        expected = light.power / (4 * np.pi) * 2 * np.pi * np.trapezoid(x * x * (3 - 2 * x), c)
    assert flux.mean(axis=0) == pytest.approx(np.full(3, expected), rel=5e-3)
