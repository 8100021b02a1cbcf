# SPDX-License-Identifier: GPL-3.0-or-later
"""A narrow beam through a 60° prism of SF11 onto a wall: where each wavelength lands, to a pixel, is Snell's business."""

import math

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.descriptions import CameraType, Light, LightType, Pass, wavelengths
from opal_kernels.optics import colour, illuminants, species
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY

APEX = math.radians(60)
SLIT = 0.001
DISTANCE, HALF = 1.0, 0.1  # of the wall from the prism, of the picture; metres
WIDTH, HEIGHT = 200, 10
INDEX = species.index("SF11", wavelengths())


def direction(elevation):
    return np.array([math.cos(elevation), 0.0, math.sin(elevation)])


def refract(d, normal, eta):
    """Snell's law in vectors; eta = n(old side) / n(new side), normal against d."""
    c = -d @ normal
    return eta * d + (eta * c - math.sqrt(1 - eta**2 * (1 - c**2))) * normal


# The prism's cross-section: apex on top, beam through the middle of the left face at the D line's least deviation.
FACES = [np.array([-math.cos(APEX / 2), 0, math.sin(APEX / 2)]), np.array([math.cos(APEX / 2), 0, math.sin(APEX / 2)])]
SIDE = 0.2
APEX_POINT = np.array([0, 0, SIDE * math.cos(APEX / 2)])
ENTRY = APEX_POINT / 2 - np.array([SIDE * math.sin(APEX / 2) / 2, 0, 0])
N_D = float(species.index("SF11", np.array([589.3]))[0])
INCIDENCE = math.asin(N_D * math.sin(APEX / 2))
BEAM = direction(INCIDENCE - APEX / 2)
AXIS = BEAM * [1, 1, -1]  # of the D line behind the prism
ACROSS = np.array([-AXIS[2], 0, AXIS[0]])
WALL = APEX_POINT / 2 + np.array([SIDE * math.sin(APEX / 2) / 2, 0, 0]) + DISTANCE * AXIS


def landing(nm):
    """Where a wavelength meets the wall, metres along ACROSS."""
    n = np.interp(nm, wavelengths(), INDEX)
    d = refract(BEAM, FACES[0], 1 / n)
    exit_point = ENTRY + d * ((APEX_POINT - ENTRY) @ FACES[1]) / (d @ FACES[1])
    d = refract(d, -FACES[1], n)
    return ((exit_point + d * ((WALL - exit_point) @ AXIS) / (d @ AXIS)) - WALL) @ ACROSS


def pose(origin, forward):
    """-Z along `forward`, Y along the world's y, X across."""
    matrix = np.empty((3, 4))
    matrix[:, 2], matrix[:, 1], matrix[:, 3] = -forward, (0, 1, 0), origin
    matrix[:, 0] = np.cross(matrix[:, 1], matrix[:, 2])
    return matrix


def stage(scene, spectrum):
    foot = SIDE * math.sin(APEX / 2)
    triangle = [(-foot, 0), (foot, 0), (0, APEX_POINT[2])]
    corners = [(x, y, z) for y in (-0.3, 0.3) for x, z in triangle]
    faces = [(0, 1, 2), (3, 5, 4), (0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (2, 5, 3), (2, 3, 0)]
    scene.add_instances(scene.add_mesh(corners, faces), IDENTITY, [scene.add_gem(INDEX)])
    wall = scene.add_material(programs.diffuse((0.5, 0.5, 0.5)))
    square = [WALL + u * ACROSS * 0.5 + v * np.array([0, 0.5, 0]) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    scene.add_instances(scene.add_mesh(square, [(0, 1, 2), (0, 2, 3)]), IDENTITY, [wall])
    number = -1 if spectrum is None else scene.add_spectrum(spectrum)
    scene.add_light(
        Light(type=LightType.RECTANGLE, transform=pose(ENTRY - 0.5 * BEAM, BEAM), size_u=SLIT, size_v=0.3, spread=0.0, spectrum=number)
    )
    window = (-HALF, HALF, -HALF * HEIGHT / WIDTH, HALF * HEIGHT / WIDTH)
    scene.set_camera(type=CameraType.ORTHOGRAPHIC, transform=pose(WALL - 0.5 * AXIS, AXIS), window=window)
    scene.commit()


def position(profile):
    """Mean and deviation in pixels of the light within 6 pixels of its peak, a column a wavelength; the D line lands at 0.

    Farther off lies only what went to and fro inside of the prism, or came back from the wall.
    """
    x = (np.arange(len(profile)) + 0.5 - len(profile) / 2)[:, None]
    near = np.where(np.abs(x - x[profile.argmax(axis=0), 0]) < 6, profile, 0)
    mean = (near * x).sum(axis=0) / near.sum(axis=0)
    return mean, np.sqrt((near * (x - mean) ** 2).sum(axis=0) / near.sum(axis=0))


PIXEL = 2 * HALF / WIDTH
RIGHT = np.sign(np.cross([0, 1, 0], -AXIS) @ ACROSS)  # the picture's x along ACROSS


@pytest.mark.parametrize("nm", [450.0, 532.0, 589.3, 632.8])
def test_laser_through_a_prism_is_one_dot_of_its_own_colour_where_snell_puts_it(nm):
    with Scene(threads=2) as scene:
        stage(scene, illuminants.line(nm))
        with Render(scene, width=WIDTH, height=HEIGHT, samples_per_pass=1, photons_per_pass=20_000, filter=0, filter_width=1) as render:
            image = render.run(2).film("COMBINED")[..., :3].astype(float)
    rgb = image.sum(axis=(0, 1))
    mean, deviation = position(image[..., int(rgb.argmax())].sum(axis=0)[:, None])
    assert mean[0] == pytest.approx(RIGHT * landing(nm) / PIXEL, abs=1.0), f"{mean} px"
    assert deviation[0] < 1.5, f"the dot is {deviation} px wide"
    own = colour.rec709(illuminants.line(nm))
    assert rgb / np.abs(rgb).max() == pytest.approx(own / np.abs(own).max(), abs=0.03)


def test_white_light_through_a_prism_lands_by_wavelength_where_snell_says():
    bins = 94
    with Scene(threads=2) as scene:
        stage(scene, None)
        with Render(
            scene,
            width=WIDTH,
            height=HEIGHT,
            samples_per_pass=1,
            photons_per_pass=100_000,
            filter=0,
            filter_width=1,
            spectral_bins=bins,
            passes=(Pass.SPECTRAL,),
        ) as render:
            spectral = render.run(6).film("SPECTRAL").astype(float).sum(axis=0)
    centres = 360 + (np.arange(bins) + 0.5) * 470 / bins
    seen = (centres > 445) & (centres < 700)
    mean, _ = position(spectral[:, seen])
    expected = RIGHT * landing_of(centres[seen]) / PIXEL
    off = np.abs(mean - expected)
    assert off.max() < 1.0, f"{off.max():.2f} px off at {centres[seen][off.argmax()]:.0f} nm"
    assert np.abs((mean - expected).mean()) < 0.1


def landing_of(nms):
    return np.array([landing(nm) for nm in nms])
