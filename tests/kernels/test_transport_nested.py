# SPDX-License-Identifier: GPL-3.0-or-later
"""Gems within gems: in a white furnace every combination of lossless bodies is invisible, and indices count where interiors overlap."""

import math

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.descriptions import Light, LightType, MaterialFlag, World
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, orthographic, perspective, picture, square

WATER, GLASS, DIAMOND, AIR = 1.333, 1.5, 2.417, 1.0


def boxes(*bodies):
    """A scene of boxes (half size, low, high, index, priority), to be committed."""
    scene = Scene(threads=2)
    for half, low, high, index, priority in bodies:
        mesh = scene.add_mesh(*box((-half, -half, low), (half, half, high)))
        scene.add_instances(mesh, IDENTITY, [scene.add_gem(index, priority=priority)])
    return scene


COMBINATIONS = {
    # A gem in water in a glass, the water reaching into the glass's wall.
    "gem in water in a glass": [(0.5, 0.0, 1.0, GLASS, 0), (0.4, 0.1, 0.9, WATER, 1), (0.15, 0.3, 0.6, DIAMOND, 2)],
    "water that touches its glass": [(0.5, 0.0, 1.0, GLASS, 0), (0.4, 0.1, 1.0, WATER, 1)],
    "bubble in a gem": [(0.5, 0.0, 1.0, DIAMOND, 0), (0.2, 0.3, 0.7, AIR, 1)],
    "gem sunk into another": [(0.4, 0.0, 0.6, GLASS, 0), (0.3, 0.4, 1.0, DIAMOND, 1)],
    # Which of two equals fills the overlap is the size's say, the same for every path.
    "gem sunk into one of the same priority": [(0.4, 0.0, 0.6, GLASS, 0), (0.3, 0.4, 1.0, DIAMOND, 0)],
    "the weaker sunk into the stronger": [(0.4, 0.0, 0.6, DIAMOND, 1), (0.3, 0.4, 1.0, GLASS, 0)],
    "two gems face to face": [(0.4, 0.0, 0.5, GLASS, 0), (0.4, 0.5, 1.0, DIAMOND, 0)],
    "a gem twice in one place": [(0.4, 0.0, 0.5, GLASS, 0), (0.4, 0.0, 0.5, GLASS, 0)],
}


@pytest.mark.parametrize("name", COMBINATIONS)
def test_lossless_bodies_within_each_other_vanish_in_a_white_furnace(name):
    with boxes(*COMBINATIONS[name]) as scene:
        scene.set_world(World(programs.emission()))
        tilted = np.array([[1, 0, 0, 0.1], [0, math.cos(0.4), -math.sin(0.4), -1.1], [0, math.sin(0.4), math.cos(0.4), 3.0]])
        scene.set_camera(**orthographic(0.8, tilted))
        scene.commit()
        image = picture(scene, 16, size=12, samples_per_pass=16, photons_per_pass=0, max_depth=1024)
    assert image == pytest.approx(1.0, abs=0.005), f"pixels from {image.min():.4f} to {image.max():.4f}"


def tower(count):
    """Bodies within each other, by turns of water and of glass."""
    steps = np.linspace(0, 1, count + 1)[:count]
    return [(0.5 - 0.45 * s, 0.45 * s, 1 - 0.45 * s, (GLASS, WATER)[i % 2], 0) for i, s in enumerate(steps)]


def furnace_of(bodies):
    """(picture, statistics) of bodies in a white furnace, seen aslant."""
    with boxes(*bodies) as scene:
        scene.set_world(World(programs.emission()))
        tilted = np.array([[1, 0, 0, 0.1], [0, math.cos(0.4), -math.sin(0.4), -1.1], [0, math.sin(0.4), math.cos(0.4), 3.0]])
        scene.set_camera(**orthographic(0.8, tilted))
        scene.commit()
        with Render(scene, width=12, height=12, samples_per_pass=16, photons_per_pass=0, max_depth=1024) as render:
            return render.run(8).film("COMBINED")[..., :3].astype(np.float64), render.statistics


@pytest.mark.parametrize("count", [12, 32])
def test_many_bodies_within_each_other_vanish_in_a_white_furnace(count):
    image, statistics = furnace_of(tower(count))
    assert image == pytest.approx(1.0, abs=0.01), f"pixels from {image.min():.4f} to {image.max():.4f}"
    assert statistics["gems_passed_over"] == 0


def test_more_bodies_within_each_other_than_a_path_keeps_account_of_are_counted():
    _, statistics = furnace_of(tower(34))
    assert statistics["gems_passed_over"] > 0


def transmittance(*bodies):
    """Of a stack of plates at normal incidence, from the light behind to the camera above."""
    with boxes(*bodies) as scene:
        glow = scene.add_material(programs.emission(), flags=MaterialFlag.EMISSIVE)
        scene.add_instances(scene.add_mesh(*square(3, -0.5)), IDENTITY, [glow])
        scene.set_camera(**orthographic(0.05, looking_down(2.0)))
        scene.commit()
        image = picture(scene, 16, samples_per_pass=32, photons_per_pass=0, max_depth=1024)
    return image.mean(), image.std() / math.sqrt(image.size / 3)


def stacked(*indices):
    """Of plane boundaries between these indices with every interreflection, by intensities added: 1/T - 1 = sum R/(1-R)."""
    excess = sum((r := ((a - b) / (a + b)) ** 2) / (1 - r) for a, b in zip(indices[:-1], indices[1:], strict=True))
    return 1 / (1 + excess)


LAYERS = {
    "water between glasses": ([(3, 0.0, 1.0, GLASS, 0), (2.9, 0.3, 0.6, WATER, 1)], (1, GLASS, WATER, GLASS, 1)),
    "bubble": ([(3, 0.0, 1.0, DIAMOND, 0), (2.9, 0.3, 0.6, AIR, 1)], (1, DIAMOND, 1, DIAMOND, 1)),
    "the higher priority fills what overlaps": ([(3, 0.0, 0.6, GLASS, 1), (2.9, 0.4, 1.0, DIAMOND, 0)], (1, GLASS, DIAMOND, 1)),
    "inside of the same body nothing changes": ([(3, 0.0, 1.0, GLASS, 0), (2.9, 0.3, 0.6, GLASS, 0)], (1, GLASS, 1)),
    "faces that coincide are one boundary": ([(3, 0.0, 0.5, GLASS, 1), (3, 0.5, 1.0, DIAMOND, 0)], (1, GLASS, DIAMOND, 1)),
}


@pytest.mark.parametrize("name", LAYERS)
def test_nested_plates_transmit_as_their_stack_of_indices(name):
    bodies, indices = LAYERS[name]
    seen, error = transmittance(*bodies)
    assert error < 0.004
    # A gap of rounding between faces that coincide is air; it may cost what two more boundaries do.
    assert seen == pytest.approx(stacked(*indices), rel=0.003, abs=4 * error), f"{seen:.4f} ± {error:.4f}"


@pytest.mark.parametrize("index", [1.333, 2.417])
def test_a_camera_inside_a_gem_sees_a_white_furnace_white(index):
    """Straight down, where the box does not trap light: the film keeps radiance over n²."""
    with boxes((0.5, 0.0, 1.0, index, 0)) as scene:
        scene.set_world(World(programs.emission()))
        scene.set_camera(**perspective(0.2, looking_down(0.5)))
        scene.commit()
        image = picture(scene, 8, samples_per_pass=16, photons_per_pass=0, max_depth=1024)
    assert image.mean(axis=(0, 1)) == pytest.approx(1.0, abs=0.005)


def test_a_camera_inside_an_absorbing_gem_loses_light_from_the_start():
    """Index 1, so that only absorption is seen: straight down half a metre of σ = 1."""
    with Scene(threads=2) as scene:
        scene.add_instances(scene.add_mesh(*box((-2, -2, 0), (2, 2, 1))), IDENTITY, [scene.add_gem(1.0, absorption=1.0)])
        scene.set_world(World(programs.emission()))
        scene.set_camera(**perspective(0.02, looking_down(0.5)))
        scene.commit()
        image = picture(scene, 4, size=16, samples_per_pass=16, photons_per_pass=0)
    assert image.mean(axis=(0, 1)) == pytest.approx(math.exp(-0.5), rel=2e-3)


def test_a_camera_in_water_in_a_glass_starts_in_the_water():
    """Looking down through the bottom: water to glass to air."""
    bodies = [(3, 0.0, 1.0, GLASS, 0), (2.9, 0.2, 0.9, WATER, 1)]
    with boxes(*bodies) as scene:
        glow = scene.add_material(programs.emission(), flags=MaterialFlag.EMISSIVE)
        scene.add_instances(scene.add_mesh(*square(3, -0.5)), IDENTITY, [glow])
        scene.set_camera(**perspective(0.02, looking_down(0.5)))
        scene.commit()
        image = picture(scene, 16, samples_per_pass=32, photons_per_pass=0, max_depth=1024)
    # What the bottom sends back is reflected at the top again: the walls of all boundaries but those above the camera count once.
    below, above = stacked(WATER, GLASS, 1), stacked(WATER, GLASS, 1)
    expected = below / (1 - (1 - below) * (1 - above))
    assert image.mean() == pytest.approx(expected, rel=0.01)


def test_a_lamp_inside_a_gem_lights_what_is_outside():
    """By photons that start within: a plate of index 1 changes nothing, so both pictures agree."""

    def lit(with_gem):
        with Scene(threads=2) as scene:
            wall = scene.add_material(programs.diffuse((0.5, 0.5, 0.5)))
            scene.add_instances(scene.add_mesh(*square(1)), IDENTITY, [wall])
            if with_gem:
                body = scene.add_mesh(*box((-0.2, -0.2, 0.3), (0.2, 0.2, 0.7)))
                scene.add_instances(body, IDENTITY, [scene.add_gem(1.0, absorption=2.0)])
            scene.add_light(Light(type=LightType.POINT, power=10.0, transform=looking_down(0.5)))
            scene.set_camera(**orthographic(0.05, looking_down(0.25)))
            scene.commit()
            return picture(scene, 8, size=8, samples_per_pass=4, photons_per_pass=100_000, radius=0.005).mean()

    assert lit(True) == pytest.approx(math.exp(-2.0 * 0.2) * lit(False), rel=0.01)


def test_a_gem_whose_face_lies_in_the_floor_neither_shines_through_it_nor_darkens_it():
    """Of index 1, in the floor's very plane, with a bright wall under the floor: the picture is that of the bare floor."""

    def mean(with_gem):
        with Scene(threads=2) as scene:
            floor = scene.add_material(programs.diffuse((0.5, 0.5, 0.5)))
            glow = scene.add_material(programs.emission((50, 50, 50)), flags=MaterialFlag.EMISSIVE)
            scene.add_instances(scene.add_mesh(*square(2)), IDENTITY, [floor])
            scene.add_instances(scene.add_mesh(*square(2, -0.5)), IDENTITY, [glow])
            if with_gem:
                scene.add_instances(scene.add_mesh(*box((-0.3, -0.3, 0.0), (0.3, 0.3, 0.4))), IDENTITY, [scene.add_gem(1.0)])
            scene.add_light(Light(type=LightType.SUN, power=2 * math.pi, radius=0.02, transform=looking_down(5.0)))
            scene.set_camera(**orthographic(0.2, looking_down(2.0)))
            scene.commit()
            return picture(scene, 8, size=12, samples_per_pass=8, photons_per_pass=50_000, radius=0.02).mean()

    assert mean(True) == pytest.approx(mean(False), rel=0.01)
