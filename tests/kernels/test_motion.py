# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur of what turns: it keeps its size and its shading, goes round by the keys that it is given, and casters stay aimed at."""

import math

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.binding import OpalError
from opal_kernels.descriptions import Carry, Light, LightType, World
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, orthographic, picture, placed, sphere, square

SIZE, HALF = 48, 1.5
ARM = box((0.0, -0.1, -0.1), (1.2, 0.1, 0.1))  # from the axis outwards


def turned(degrees, tilt=(1.0, 0.3)):
    """About the vertical, of what is first scaled and sheared along X by `tilt`."""
    a = math.radians(degrees)
    turn, shear = np.eye(4), np.eye(4)
    turn[:2, :2] = (math.cos(a), -math.sin(a)), (math.sin(a), math.cos(a))
    shear[0, :2] = tilt
    return turn @ shear


def arm_that_turns(start, middle, end):
    """(SIZE, SIZE, 4), rows from the bottom up: an arm of albedo a half in a white world, seen from above through an open shutter."""
    with Scene() as scene:
        material = scene.add_material(programs.diffuse((0.5, 0.5, 0.5)))
        scene.add_instances(scene.add_mesh(*ARM), [middle], [material], transforms_start=[start], transforms_end=[end])
        scene.set_world(World(programs.emission((1.0, 1.0, 1.0))))
        scene.set_camera(**orthographic(HALF, looking_down(4.0)))
        scene.commit()
        settings = {"samples_per_pass": 32, "photons_per_pass": 0, "transparent_film": True, "motion_blur": True}
        with Render(scene, width=SIZE, height=SIZE, **settings) as render:
            return render.run(8).film("COMBINED").astype(np.float64)


@pytest.mark.parametrize("tilt", [(1.0, 0.0), (1.0, 0.3), (-1.0, 0.3)], ids=["upright", "sheared", "mirrored"])
def test_what_turns_keeps_its_size_and_its_light(tilt):
    """170° in the shutter. The arm covers 1.2 x 0.2, and each of its sides shows 1/2: it is convex and shades nothing of itself."""
    film = arm_that_turns(*(turned(degrees, tilt) for degrees in (20, 105, 190)))
    covered = film[..., 3].sum() * (2 * HALF / SIZE) ** 2
    assert covered == pytest.approx(1.2 * 0.2, rel=3e-3)
    shown = film[..., :3].sum(axis=(0, 1)) / film[..., 3].sum()
    assert shown == pytest.approx(0.5, rel=2e-3), f"a diffuse body of albedo 1/2 in a world of 1 shows {shown}"


@pytest.mark.parametrize("tilt", [(1.0, 0.3), (-1.0, 0.3)], ids=["sheared", "mirrored"])
def test_what_hardly_turns_is_shown_as_what_stands_still(tilt):
    """Rotation, scale and skew make up the very transform that was taken apart."""
    still = arm_that_turns(*[turned(30, tilt)] * 3)
    moving = arm_that_turns(*(turned(degrees, tilt) for degrees in (29.999, 30, 30.001)))
    assert np.abs(moving - still).max() < 0.02, "of 256 rays a pixel, five at most may change what they hit"


def test_what_turns_goes_the_way_of_its_middle():
    """From -100° by 0° to 100°, which is not the shorter way between the ends."""
    alpha = arm_that_turns(turned(-100), turned(0), turned(100))[..., 3]
    middle, there, opposite = SIZE // 2, int(SIZE * (0.5 + 0.9 / 3)), int(SIZE * (0.5 - 0.9 / 3))
    assert alpha[middle, there] > 0.03 and alpha[middle, opposite] == 0


def test_vertices_go_straight_from_key_to_key():
    """A card that leaps within the first half of the shutter and then waits."""
    corners, faces = square(0.2)
    there = np.asarray(corners) + (1.0, 0.0, 0.0)
    with Scene() as scene:
        mesh = scene.add_mesh(there, faces, positions_start=corners, positions_end=there)
        scene.add_instances(mesh, IDENTITY, [scene.add_material(programs.emission((1.0, 1.0, 1.0)))])
        scene.set_camera(**orthographic(HALF, looking_down(4.0)))
        scene.commit()
        row = picture(scene, 8, SIZE, samples_per_pass=64, photons_per_pass=0, motion_blur=True)[SIZE // 2, :, 0]
    at = {x: row[int(SIZE * (0.5 + x / 3))] for x in (-0.5, 0.5, 1.0)}
    # 0.4 wide and 2 a shutter fast, it is over a point for 0.2; at its end it stays for half of the shutter more.
    assert at == {-0.5: 0.0, 0.5: pytest.approx(0.2, rel=0.05), 1.0: pytest.approx(0.5 + 0.1, rel=0.05)}


def test_photons_find_a_ball_of_glass_all_along_its_arc():
    """Paths and photons bring the same light through a ball that goes round by 160° of a circle, whose chords it leaves far behind.

    The camera is under the ball: the picture is its light on the floor."""
    corners, faces, normals = sphere(0.3, 16, 32)
    images = {}
    for carry in (Carry.NONE, Carry.CAUSTICS):
        with Scene() as scene:
            ball = scene.add_mesh(corners, faces, corner_normals=normals)
            start, middle, end = (turned(degrees, (1, 0)) @ placed(0.9, z=1.0) for degrees in (-80, 0, 80))
            scene.add_instances(ball, [middle], [scene.add_gem(1.5)], transforms_start=[start], transforms_end=[end])
            scene.add_instances(scene.add_mesh(*square(2)), IDENTITY, [scene.add_material(programs.diffuse((0.8, 0.8, 0.8)))])
            scene.add_light(Light(type=LightType.RECTANGLE, power=20.0, size_u=1.5, size_v=1.5, transform=looking_down(2.0)))
            scene.set_camera(**orthographic(HALF, looking_down(0.6)))
            scene.commit()
            samples = 160 if carry == Carry.NONE else 32
            settings = {"samples_per_pass": samples, "photons_per_pass": 40_000, "photons_carry": carry, "motion_blur": True}
            images[carry] = [picture(scene, 8, 16, seed=seed, **settings) for seed in (1, 2)]
    means = {carry: np.mean(both) for carry, both in images.items()}
    error = math.hypot(*(np.std(a - b) / math.sqrt(2 * a[..., 0].size) for a, b in images.values()))
    assert error < 0.002 * means[Carry.NONE], f"too noisy to tell: {error / means[Carry.NONE]:.4f}"
    assert means[Carry.CAUSTICS] == pytest.approx(means[Carry.NONE], rel=0.006)


def test_motion_has_two_ends_or_none():
    with Scene() as scene:
        mesh = scene.add_mesh(*ARM)
        with pytest.raises(OpalError, match="both ends of the shutter"):
            scene.add_instances(mesh, IDENTITY, transforms_end=IDENTITY)
        with pytest.raises(OpalError, match="both ends of the shutter"):
            scene.add_mesh(*ARM, positions_start=ARM[0])


def test_what_is_flat_at_a_key_stands_still():
    """A body that grows out of nothing has no turn there: it is shown as in the middle, and whole."""
    film = arm_that_turns(np.diag([0.0, 0.0, 0.0, 1.0]), np.eye(4), turned(90))
    assert film[..., 3].sum() * (2 * HALF / SIZE) ** 2 == pytest.approx(1.2 * 0.2, rel=3e-3)
    assert film[SIZE // 2, int(SIZE * 0.6), 3] == pytest.approx(1.0, abs=5e-3)
