# SPDX-License-Identifier: GPL-3.0-or-later
"""No length is special: a scene a thousand times smaller or larger, its lamps' power with the square, gives the same picture."""

import math

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.cuts import round_brilliant
from opal_kernels.descriptions import Light, LightType, World, wavelengths
from opal_kernels.optics import illuminants, species
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, perspective, picture, square


def ruby_on_a_table(size, lamp_too=True):
    """Means over the picture of a ruby and a touching block of glass under a sky, an area lamp and its photons; lengths times `size`."""
    with Scene(threads=2) as scene:
        table = scene.add_material(programs.diffuse((0.6, 0.6, 0.6)))
        scene.add_instances(scene.add_mesh(np.array(square(3)[0]) * size, square(3)[1]), IDENTITY, [table])
        solid = round_brilliant().solid
        faces = [(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)]
        ruby = scene.add_gem(species.index("RUBY", wavelengths()), 0.0065 / size * species.absorption("RUBY", wavelengths()))
        stone = np.eye(4)
        stone[:3, 3] = 0, 0, 0.6 * size
        scene.add_instances(scene.add_mesh(solid.vertices * size, faces), [stone], [ruby])
        corners, sides = box((0.8, -0.3, 0.0), (1.2, 0.3, 0.5))
        scene.add_instances(scene.add_mesh(np.array(corners) * size, sides), IDENTITY, [scene.add_gem(1.5)])
        if lamp_too:
            lamp = looking_down(4.0 * size)
            number = scene.add_spectrum(illuminants.blackbody(4000))
            scene.add_light(
                Light(type=LightType.ELLIPSE, power=60 * size**2, size_u=0.3 * size, size_v=0.3 * size, transform=lamp, spectrum=number)
            )
        scene.set_world(World(programs.emission((0.2, 0.3, 0.4))))
        scene.set_camera(**perspective(0.6, looking_down(3.5 * size)))
        scene.commit()
        photons = 20_000 if lamp_too else 0
        return picture(scene, 3, size=32, samples_per_pass=16, photons_per_pass=photons, radius=0.02 * size).mean(axis=(0, 1))


@pytest.mark.parametrize("size", [2.0**-10, 2.0**10])
def test_a_scene_a_thousand_times_as_small_or_large_gives_the_same_picture_to_the_bit(size):
    """By powers of two, where scaling rounds nothing: a single absolute length anywhere would change some path."""
    assert ruby_on_a_table(size).tolist() == ruby_on_a_table(1.0).tolist()


@pytest.mark.parametrize("size", [1e-3, 1e3])
def test_a_thousand_rounds_and_the_means_stay(size):
    """Under the sky, whose noise is small: the few paths that rounding parts move means by less than 0.2 %."""
    assert ruby_on_a_table(size, lamp_too=False) == pytest.approx(ruby_on_a_table(1.0, lamp_too=False), rel=0.002)


def test_photons_are_never_left_on_a_gem():
    """Light reflected inside a stone passes its facets without a trace: with nothing else to land on none is stored."""
    from opal_kernels.render import Render

    with Scene(threads=2) as scene:
        solid = round_brilliant().solid
        faces = [(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)]
        scene.add_instances(scene.add_mesh(solid.vertices, faces), IDENTITY, [scene.add_gem(2.417)])
        scene.add_light(Light(type=LightType.POINT, power=math.pi, transform=looking_down(2.0)))
        scene.set_camera(**perspective(0.6, looking_down(3.0)))
        scene.commit()
        with Render(scene, width=8, height=8, photons_per_pass=20_000) as render:
            assert render.run(1).statistics["photons_stored"] == 0
