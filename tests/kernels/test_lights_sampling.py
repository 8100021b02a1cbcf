# SPDX-License-Identifier: GPL-3.0-or-later
"""Sampling of lights: densities are those of what is sampled, and nothing that lights a point is left out."""

import numpy as np
import pytest
from light_probe import (
    direction_program,
    emission_program,
    irradiance,
    lamp,
    light_pdf,
    lights_along,
    looking,
    numbers,
    receiver,
    sample_light,
    scene_with,
)
from opal_kernels.descriptions import LightType, MaterialFlag, World
from opal_kernels.scene import Scene

UP = (0, 0, 1)
SIZED = {
    "sphere": lamp(LightType.POINT, (0.5, 0.2, 1.5), radius=0.4, soft_falloff=0),
    "sphere we stand in": lamp(LightType.POINT, (0.1, 0.0, 0.1), radius=0.8, soft_falloff=0),
    "facing disc": lamp(LightType.POINT, (0.5, 0.2, 1.5), radius=0.4, soft_falloff=1),
    "spot": lamp(
        LightType.SPOT,
        (0.2, 0.1, 2),
        (-0.1, 0, -1),
        radius=0.4,
        spot_angle=1.4,
        spot_blend=0.3,
    ),
    "sun": lamp(LightType.SUN, direction=(0.4, 0.1, -1), radius=0.3),
    "rectangle": lamp(LightType.RECTANGLE, (0.3, 0.1, 0.7), (0.1, -0.3, -1), size_u=1.5, size_v=0.6),
    "ellipse": lamp(LightType.ELLIPSE, (0.3, 0.1, 0.7), (0.1, -0.3, -1), size_u=1.5, size_v=0.6),
    "rectangle with spread": lamp(LightType.RECTANGLE, (0.3, 0.1, 1.2), size_u=1.5, size_v=0.6, spread=0.9),
    "ellipse with spread": lamp(LightType.ELLIPSE, (0.3, 0.1, 1.2), size_u=1.5, size_v=0.9, spread=0.9),
    "tiny rectangle": lamp(LightType.RECTANGLE, (0.3, 0.1, 2), size_u=1e-4, size_v=1e-4),
}


def uniform_directions(n, seed=5):
    u = numbers(n, 2, seed)
    z, phi = 1 - 2 * u[:, 0], 2 * np.pi * u[:, 1]
    r = np.sqrt(1 - z * z)
    return np.column_stack([r * np.cos(phi), r * np.sin(phi), z]).astype(np.float32)


@pytest.mark.parametrize("name", SIZED)
def test_pdf_of_a_sampled_direction_is_the_one_that_sampling_returned(name):
    where = receiver((0, 0, 0), UP)
    with scene_with(SIZED[name]) as scene:
        s = sample_light(scene, where, numbers(500, 3))
        lit = s["pdf"] > 0
        pdf = light_pdf(scene, where, s["source"][lit], s["direction"][lit], s["distance"][lit])
    assert lit.any()
    assert pdf == pytest.approx(s["pdf"][lit], rel=2e-3)


@pytest.mark.parametrize("name", [n for n in SIZED if n != "tiny rectangle"])
def test_irradiance_is_the_same_by_sampling_lights_and_by_sampling_directions(name):
    """The two estimators of next-event estimation; they differ if a density, a shape or a radiance is wrong."""
    with scene_with(SIZED[name]) as scene:
        by_light, light_error = irradiance(scene, (0, 0, 0), UP, n=60_000)
        directions = uniform_directions(400_000)
        _, radiance, _ = lights_along(scene, (0, 0, 0), directions)
    value = radiance[:, 1] * np.clip(directions[:, 2], 0, None) * 4 * np.pi
    by_direction, direction_error = value.mean(), value.std() / np.sqrt(len(value))
    assert by_light[1] > 0
    assert by_light[1] == pytest.approx(
        by_direction,
        abs=4 * np.hypot(light_error[1], direction_error) + 1e-3 * by_direction,
    )


@pytest.mark.parametrize("height", [0.2, 1.0, 6.0])
def test_rectangle_is_sampled_uniformly_in_solid_angle(height):
    """Ureña et al. 2013: one density for every direction, the inverse of the solid angle that the rectangle fills."""
    a, b = 1.2, 0.7
    solid_angle = 4 * np.arctan(a * b / 4 / (height * np.sqrt(height**2 + (a * a + b * b) / 4)))
    with scene_with(lamp(LightType.RECTANGLE, (0, 0, height), size_u=a, size_v=b)) as scene:
        s = sample_light(scene, receiver((0, 0, 0), UP), numbers(2000, 3))
    assert s["pdf"] == pytest.approx(np.full(2000, 1 / solid_angle), rel=1e-4)


@pytest.mark.parametrize(
    ("normal", "transmissive"),
    [((0, 0, 0), False), ((0.6, 0, 0.8), False), ((0.6, 0, 0.8), True)],
)
def test_uniform_world_is_sampled_by_what_the_receiver_can_take(normal, transmissive):
    where = receiver((0, 0, 0), normal, transmissive)
    with scene_with(world=emission_program((1, 1, 1))) as scene:
        directions = uniform_directions(100_000)
        pdf = light_pdf(scene, where, (2, 0), directions, np.inf)
        s = sample_light(scene, where, numbers(2000, 3))
        again = light_pdf(scene, where, s["source"], s["direction"], s["distance"])
    assert pdf.mean() * 4 * np.pi == pytest.approx(1.0, abs=2e-3)
    assert again == pytest.approx(s["pdf"], rel=1e-3)


def test_importance_map_of_the_world_integrates_to_one_and_follows_what_stands_out():
    where = receiver((0, 0, 0), UP)
    with scene_with(world=World(program=direction_program(3.0), map_width=64)) as scene:
        directions = uniform_directions(400_000)
        pdf = light_pdf(scene, where, (2, 0), directions, np.inf)
        s = sample_light(scene, where, numbers(4000, 3))
        lit = s["pdf"] > 0
        again = light_pdf(scene, where, s["source"][lit], s["direction"][lit], s["distance"][lit])
        bright = lights_along(scene, (0, 0, 0), directions)[1] @ (np.array([0.2126729, 0.7151522, 0.0721750]) + 1 / 3)
    assert pdf.mean() * 4 * np.pi == pytest.approx(1.0, abs=5e-3)
    assert np.median(np.abs(again / s["pdf"][lit] - 1)) < 1e-4
    assert np.corrcoef(pdf, np.clip(bright - bright.mean(), 0, None))[0, 1] > 0.98


def emissive_quad(scene, transform, color=(1, 1, 1), copies=1):
    material = scene.add_material(emission_program(color, 5.0), flags=MaterialFlag.EMISSIVE)
    mesh = scene.add_mesh(
        [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]],
        [[0, 1, 2], [0, 2, 3]],
    )
    scene.add_instances(
        mesh,
        np.broadcast_to(transform, (copies, *np.shape(transform)))[:, :3],
        [material],
    )


@pytest.mark.parametrize("height", [0.05, 0.5, 4.0])
def test_emissive_mesh_gives_what_a_lamp_of_its_shape_gives(height):
    """Solid-angle sampling near by, area sampling far away: radiance 5 from a unit square."""
    power = 5 * np.pi
    with scene_with(lamp(LightType.RECTANGLE, (0.1, 0.2, height), power=power)) as scene:
        expected, _ = irradiance(scene, (0, 0, 0), UP, n=40_000)
        frame = looking((0, 0, -1), (0.1, 0.2, height))
    with Scene(threads=1) as scene:
        emissive_quad(scene, frame)
        scene.commit()
        e, error = irradiance(scene, (0, 0, 0), UP, n=40_000)
        where = receiver((0, 0, 0), UP)
        s = sample_light(scene, where, numbers(300, 3))
        pdf = light_pdf(scene, where, s["source"], s["direction"], s["distance"])
    assert e == pytest.approx(expected, rel=3e-3, abs=3 * error.max())
    assert pdf == pytest.approx(s["pdf"], rel=5e-3)


def scattered_lamps(count, seed=3):
    rng = np.random.default_rng(seed)
    kinds = [LightType.POINT, LightType.SPOT, LightType.RECTANGLE, LightType.ELLIPSE]
    return [
        lamp(
            kinds[i % 4],
            rng.uniform((-4, -4, 0.5), (4, 4, 3)),
            rng.normal(size=3),
            power=10 ** rng.uniform(-1, 2),
            radius=0.1,
            size_u=0.4,
            size_v=0.3,
            spot_angle=1.2,
        )
        for i in range(count)
    ]


@pytest.mark.parametrize("count", [3, 9, 60])
def test_choice_among_many_lamps_adds_up_to_one_and_forgets_none(count):
    """Irradiance from all lamps together is the sum of what each gives alone, by enumeration and by the light tree."""
    lamps = scattered_lamps(count)
    position, normal = (0.3, -0.2, 0.0), (0.1, 0.2, 0.97)
    alone = np.zeros(3)
    for one in lamps:
        with scene_with(one) as scene:
            alone += irradiance(scene, position, normal, n=1000)[0]
    with scene_with(*lamps) as scene:
        together, error = irradiance(scene, position, normal, n=200_000)
        where = receiver(position, normal)
        s = sample_light(scene, where, numbers(3000, 3))
        lit = (s["pdf"] > 0) & (s["dirac"] == 0)
        pdf = light_pdf(scene, where, s["source"][lit], s["direction"][lit], s["distance"][lit])
    assert together == pytest.approx(alone, rel=5e-3, abs=4 * error.max())
    assert pdf == pytest.approx(s["pdf"][lit], rel=5e-3)


def test_tree_gives_most_samples_to_the_lamp_next_to_the_point():
    lamps = [lamp(LightType.POINT, (10.0 * i, 0, 1), power=1.0) for i in range(50)]
    with scene_with(*lamps) as scene:
        s = sample_light(scene, receiver((200.2, 0, 0), UP), numbers(4000, 3))
    assert np.mean(s["source"][:, 1] == 20) > 0.8


def test_many_emissive_triangles_give_the_sum_of_their_light():
    """A ceiling of 2 x 16 x 16 triangles through the tree against one lamp of that size."""
    n, size, height = 16, 4.0, 2.0
    with scene_with(
        lamp(
            LightType.RECTANGLE,
            (0, 0, height),
            power=2 * np.pi * size**2,
            size_u=size,
            size_v=size,
        )
    ) as scene:
        expected, _ = irradiance(scene, (0.5, 0.3, 0), UP, n=20_000)
    step = size / n
    centres = (np.arange(n) + 0.5) * step - size / 2
    frames = [looking((0, 0, -1), (x, y, height), (step, step, 1)) for x in centres for y in centres]
    with Scene(threads=1) as scene:
        material = scene.add_material(emission_program((1, 1, 1), 2.0), flags=MaterialFlag.EMISSIVE)
        mesh = scene.add_mesh(
            [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]],
            [[0, 1, 2], [0, 2, 3]],
        )
        scene.add_instances(mesh, frames, [material])
        scene.commit()
        assert scene.statistics["emissive_triangles"] == 2 * n * n
        e, error = irradiance(scene, (0.5, 0.3, 0), UP, n=100_000)
    # The frames are turned about their axis, so the ceiling's outline is not quite the lamp's.
    assert e == pytest.approx(expected, rel=0.03, abs=4 * error.max())


def test_sky_sun_and_lamps_together_are_the_sum_of_each():
    parts = [
        ([lamp(LightType.SUN, direction=(0.5, 0.2, -1), power=2.0, radius=0.01)], None),
        ([lamp(LightType.POINT, (1, 1, 2), power=50.0)], None),
        ([], World(program=direction_program(0.5), map_width=64)),
    ]
    alone = np.zeros(3)
    for lamps, world in parts:
        with scene_with(*lamps, world=world) as scene:
            alone += irradiance(scene, (0, 0, 0), UP, n=100_000)[0]
    with scene_with(*(light for lamps, _ in parts for light in lamps), world=parts[2][1]) as scene:
        together, error = irradiance(scene, (0, 0, 0), UP, n=300_000)
    assert together == pytest.approx(alone, rel=5e-3, abs=4 * error.max())


def test_more_suns_than_are_weighed_one_by_one():
    rng = np.random.default_rng(2)
    suns = [
        lamp(LightType.SUN, direction=(*rng.uniform(-1, 1, 2), -1), power=rng.uniform(0.5, 2), radius=rng.choice([0, 0.2]))
        for _ in range(13)
    ]
    alone = np.zeros(3)
    for sun in suns:
        with scene_with(sun) as scene:
            alone += irradiance(scene, (0, 0, 0), UP, n=1000)[0]
    with scene_with(*suns) as scene:
        together, error = irradiance(scene, (0, 0, 0), UP, n=100_000)
        where = receiver((0, 0, 0), UP)
        s = sample_light(scene, where, numbers(2000, 3))
        lit = (s["pdf"] > 0) & (s["dirac"] == 0)
        pdf = light_pdf(scene, where, s["source"][lit], s["direction"][lit], s["distance"][lit])
    assert together == pytest.approx(alone, rel=3e-3, abs=4 * error.max())
    assert pdf == pytest.approx(s["pdf"][lit], rel=1e-3)
    assert len(np.unique(s["source"][:, 1])) == len(suns)
