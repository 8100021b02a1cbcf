# SPDX-License-Identifier: GPL-3.0-or-later
"""The alexandrite effect, rendered: green by daylight, red under a lamp of 2800 K."""

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.cuts import round_brilliant
from opal_kernels.descriptions import Light, LightType, wavelengths
from opal_kernels.optics import illuminants, species
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, looking_down, orthographic, picture, square


def seen(spectrum):
    """Mean colour of a 5 mm stone on white paper under a wide lamp, and of the paper."""
    with Scene(threads=2) as scene:
        paper = scene.add_material(programs.diffuse((0.8, 0.8, 0.8)))
        scene.add_instances(scene.add_mesh(*square(0.05)), IDENTITY, [paper])
        solid = round_brilliant().scaled(0.005).solid
        faces = [(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)]
        stone = np.eye(4)
        stone[2, 3] = 0.0025
        gem = scene.add_gem(species.index("ALEXANDRITE", wavelengths()), species.absorption("ALEXANDRITE", wavelengths()))
        scene.add_instances(scene.add_mesh(solid.vertices, faces), [stone], [gem])
        number = scene.add_spectrum(spectrum)
        scene.add_light(Light(type=LightType.RECTANGLE, power=0.2, size_u=0.1, size_v=0.1, transform=looking_down(0.05), spectrum=number))
        scene.set_camera(**orthographic(0.004, looking_down(0.04)))
        scene.commit()
        image = picture(scene, 4, size=24, samples_per_pass=16, photons_per_pass=20_000)
    y, x = np.mgrid[:24, :24] - 11.5
    inside = np.hypot(x, y) < 0.55 * 12
    return image[inside].mean(axis=0), image[0, 0] + image[-1, -1]


@pytest.mark.parametrize(("spectrum", "hue"), [(illuminants.lamp("D65"), "green"), (illuminants.blackbody(2800.0), "red")])
def test_alexandrite_is_green_by_day_and_red_by_lamplight(spectrum, hue):
    stone, _ = seen(spectrum)
    red, green, blue = stone
    if hue == "green":
        assert green > 1.3 * red and green > 1.9 * blue, stone  # reached: 1.37, 2.04
    else:
        assert red > 4.5 * green and red > 16 * blue, stone  # reached: 4.73, 17.6


def test_the_change_is_more_than_that_of_the_lamps():
    """Beside the paper under the same lamp, to which the eye adapts, red against green grows by 2.8."""
    day, day_paper = seen(illuminants.lamp("D65"))
    night, night_paper = seen(illuminants.blackbody(2800.0))
    change = (night[0] / night[1]) / (day[0] / day[1])
    of_paper = (night_paper[0] / night_paper[1]) / (day_paper[0] / day_paper[1])
    assert change > 2.7 * of_paper, f"{change:.2f} against {of_paper:.2f}"
