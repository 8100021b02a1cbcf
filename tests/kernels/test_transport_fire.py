# SPDX-License-Identifier: GPL-3.0-or-later
"""A stone's fire on the table under it: it comes of the stone's dispersion and of the lamp's spectrum, and goes with either."""

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.cuts import round_brilliant
from opal_kernels.descriptions import Light, LightType, wavelengths
from opal_kernels.optics import illuminants, species
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, orthographic, picture, placed, square

DIAMOND = species.index("DIAMOND", wavelengths())


def fire(index, lamp):
    """Spread of the colours in the shadow of a stone of 6.5 mm, table down under a small lamp, where only the caustic is: of red's, green's
    and blue's shares of a pixel the root mean square distance from their means, weighed by the pixel's light."""
    solid = round_brilliant().scaled(0.0065).solid
    faces = [(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)]
    with Scene(threads=2) as scene:
        black_below = scene.add_material(programs.diffuse((0.05, 0.05, 0.05)))
        scene.add_instances(scene.add_mesh(*square(0.2)), IDENTITY, [black_below])
        scene.add_instances(scene.add_mesh(solid.vertices, faces), [placed(z=0.010) @ np.diag([1.0, -1, -1, 1])], [scene.add_gem(index)])
        lit_by = Light(type=LightType.POINT, power=1.0, radius=0.0005, transform=placed(z=0.3)[:3], spectrum=scene.add_spectrum(lamp))
        scene.add_light(lit_by)
        scene.set_camera(**orthographic(0.002, placed(z=0.005)[:3]))  # below the stone, down on its shadow
        scene.commit()
        image = picture(scene, 2, size=8, samples_per_pass=1, photons_per_pass=40_000)
    light = image.sum(axis=2)
    shares = image / np.maximum(light, 1e-12)[..., None]
    mean = (shares * light[..., None]).sum(axis=(0, 1)) / light.sum()
    return np.sqrt((((shares - mean) ** 2).sum(axis=2) * light).sum() / light.sum())


def test_daylight_makes_a_diamonds_fire_and_sodium_kills_it():
    by_day, by_sodium = fire(DIAMOND, illuminants.lamp("D65")), fire(DIAMOND, illuminants.lamp("SODIUM"))
    without_dispersion = fire(np.full_like(DIAMOND, 2.417), illuminants.lamp("D65"))
    assert by_day > 10 * without_dispersion, f"{by_day:.5f}, {without_dispersion:.5f} without dispersion"
    assert by_sodium < by_day / 60, f"{by_sodium:.5f} by sodium, {by_day:.5f} by day"


@pytest.mark.parametrize("nm", [480.0, 620.0])
def test_a_laser_has_no_fire(nm):
    assert fire(DIAMOND, illuminants.line(nm)) < 0.01
