# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of media whose faces coincide: every boundary counts, whichever of them a ray happens to meet first.

Absorbing boxes under a uniform sky of radiance 1, seen straight through: by Beer and Lambert each lets exp(-1) pass.
"""

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.descriptions import Carry, Light, LightType, MaterialFlag, World
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, orthographic, picture, placed, square

CUBE = ((-1, -1, -1), (1, 1, 1))
SETTINGS = {"samples_per_pass": 64, "photons_per_pass": 0, "max_depth": 16}


def absorber(scene, extinction=0.5):
    return scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=scene.add_medium(extinction, 0.0))


def boxes(scene, *bodies):
    for body in bodies:
        scene.add_instances(scene.add_mesh(*box(*body)), IDENTITY, [absorber(scene)])


def turned(angle):
    """A camera that looks down on the origin at an angle, along x and y."""
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1.0]])
    matrix = np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]]) @ matrix
    matrix[:3, 3] = 10 * matrix[:3, 2]
    return matrix[:3]


def seen_through(scene, camera=None, size=16):
    scene.set_world(World(programs.emission()))
    scene.set_camera(**orthographic(0.3, looking_down(10.0) if camera is None else camera))
    scene.commit()
    return picture(scene, 4, size, **SETTINGS).mean()


def lets_through(found, expected, size=16):
    """Within 4 standard errors of as many draws of 0 or 1."""
    error = np.sqrt(expected * (1 - expected) / (4 * size**2 * SETTINGS["samples_per_pass"]))
    assert abs(found - expected) < 4 * error, f"{found:.4f} ± {error:.4f}, expected {expected:.4f}"


def side_by_side(scene):
    boxes(scene, CUBE, ((-1, -1, 1), (1, 1, 3)))


def in_one_place(scene):
    boxes(scene, CUBE, CUBE)


def a_smaller_one_on_top(scene):
    boxes(scene, CUBE, ((-0.6, -0.7, 1), (0.7, 0.8, 3)))


def copies_of_one_mesh(scene):
    mesh = scene.add_mesh(*box(*CUBE))
    scene.add_instances(mesh, [placed(), placed(z=2.0)], [absorber(scene)])


def an_array_in_one_mesh(scene):
    corners, faces = box(*CUBE)
    scene.add_instances(scene.add_mesh([*corners, *(corners + (0, 0, 2))], [*faces, *(np.array(faces) + 8)]), IDENTITY, [absorber(scene)])


def a_welded_array(scene):
    corners, faces = box(*CUBE)
    merged, index = np.unique([*corners, *(corners + (0, 0, 2))], axis=0, return_inverse=True)
    scene.add_instances(scene.add_mesh(merged, index.ravel()[[*faces, *(np.array(faces) + 8)]]), IDENTITY, [absorber(scene)])


@pytest.mark.parametrize("angle", [0.0, 0.08])
@pytest.mark.parametrize(
    "build", [side_by_side, in_one_place, a_smaller_one_on_top, copies_of_one_mesh, an_array_in_one_mesh, a_welded_array]
)
def test_boxes_that_touch_add_up(build, angle):
    with Scene(threads=2) as scene:
        build(scene)
        through_a_box = np.exp(-1 / np.cos(angle) ** 2)
        lets_through(seen_through(scene, turned(angle)), through_a_box**2)


def test_a_camera_inside_boxes_that_touch():
    with Scene(threads=2) as scene:
        boxes(scene, CUBE, ((-1, -1, 1), (1, 1, 3)), ((-1, -1, -3), (1, 1, -1)))
        lets_through(seen_through(scene, looking_down(0.0)), np.exp(-1.5))


@pytest.mark.parametrize("towards", [1, -1])
def test_fog_that_ends_in_a_glowing_face(towards):
    """A box of fog that stands on a plane: seen from within the fog the plane glows through it, from behind at full strength."""
    with Scene(threads=2) as scene:
        boxes(scene, CUBE)
        glow = scene.add_material(programs.emission((1, 1, 1), 1.0))
        scene.add_instances(scene.add_mesh(*square(4.0, -1.0)), IDENTITY, [glow])
        camera = placed(z=10.0) @ np.eye(4) if towards > 0 else placed(z=-10.0) @ np.diag([1.0, -1.0, -1.0, 1.0])
        scene.set_camera(**orthographic(0.3, camera[:3]))
        scene.commit()
        found = picture(scene, 4, **SETTINGS).mean()
    if towards > 0:
        lets_through(found, np.exp(-1))
    else:
        assert abs(found - 1) < 1e-4, found


@pytest.mark.parametrize("photons", [0, 40_000])
def test_a_floor_under_fog_is_lit_alike_whether_it_touches(photons):
    """Shadow rays, scattered rays and photons that leave the floor are in the fog, as those that arrive are."""
    found = []
    for gap in (0.0, 1e-4):
        with Scene(threads=2) as scene:
            medium = scene.add_medium(0.5, 0.8)
            material = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)
            scene.add_instances(scene.add_mesh(*box((-2, -2, 0), (2, 2, 1))), IDENTITY, [material])
            scene.add_instances(scene.add_mesh(*square(2.0, -gap)), IDENTITY, [scene.add_material(programs.diffuse((0.8, 0.8, 0.8)))])
            scene.add_light(Light(type=LightType.SUN, power=1.0, transform=looking_down(5.0)))
            scene.set_camera(**orthographic(1.9, looking_down(10.0)))
            scene.commit()
            settings = {**SETTINGS, "photons_per_pass": photons}
            if photons:
                settings |= {"photons_carry": Carry.ALL, "samples_per_pass": 4, "volume_radius": 0.1, "radius": 0.1}
            found.append([picture(scene, 1, seed=seed, **settings).mean() for seed in range(4)])
    ratios = np.divide(*found)  # of the same random numbers
    ratio, error = ratios.mean(), ratios.std(ddof=1) / len(ratios) ** 0.5
    assert error < 0.002, f"too noisy to tell: {error:.4f}"
    assert abs(ratio - 1) < 0.006, f"{ratio:.4f} ± {error:.4f}"


def nested(scene, number):
    """Boxes within each other, of which all but the innermost, entered last, are all but empty."""
    for i in range(number):
        corners, faces = box((-1.5 + 0.01 * i,) * 3, (1.5 - 0.01 * i,) * 3)
        scene.add_instances(scene.add_mesh(corners, faces), IDENTITY, [absorber(scene, 1e-6 if i < number - 1 else 0.5)])
    return np.exp(-1.5 + 0.01 * (number - 1))


def test_as_many_as_32_media_overlap():
    with Scene(threads=2) as scene:
        expected = nested(scene, 32)
        lets_through(seen_through(scene, size=4), expected, size=4)


def test_more_are_counted_and_passed_over():
    with Scene(threads=2) as scene:
        nested(scene, 35)
        scene.set_camera(**orthographic(0.3, looking_down(0.0)))
        scene.commit()
        with Render(scene, width=4, height=4, **SETTINGS) as render:
            assert render.run(1).statistics["media_passed_over"] == 3 * 4**2 * SETTINGS["samples_per_pass"]
