# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons seen directly: what they show of a surface is what a camera path shows, also where its weights depend on the viewer."""

import numpy as np
import pytest
from bsdf_under_test import Bsdf, direction
from opal_kernels import programs
from opal_kernels.descriptions import Carry, Light, LightType, World
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, orthographic, picture, square

VIEW, SUN = 70, 20  # degrees from the floor's normal
MULTISCATTER = 10  # column of the Glossy instruction: with it the lobe scales with the viewer


def tilted(theta, distance):
    """Transform of what stands at ``theta`` degrees from +Z, in the XZ plane, and looks at the origin."""
    z = direction(theta)
    y = np.array([0.0, 1.0, 0.0])
    return np.column_stack([np.cross(y, z), y, z, distance * z])


@pytest.mark.parametrize("carry", [Carry.ALL, Carry.NONE], ids=["photons", "paths"])
def test_sunlit_rough_metal_at_a_grazing_view_has_its_closed_form(carry):
    """Radiance f cos(sun) of irradiance 1, within 4 standard errors; weighed for the light's direction instead it would be two thirds more."""
    metal = programs.mirror((1, 1, 1), roughness=1.0)
    metal.code[0, MULTISCATTER] = 1
    expected = Bsdf("GLOSSY", direction(VIEW), roughness=1, multiscatter=1).eval(direction(SUN))[0][0, 0]
    with Scene(threads=2) as scene:
        corners, faces = square(2.0)
        scene.add_instances(scene.add_mesh(corners, faces), IDENTITY, [scene.add_material(metal)])
        scene.add_light(Light(type=LightType.SUN, transform=tilted(SUN, 5.0), power=1.0))
        scene.set_world(World())
        scene.set_camera(**orthographic(0.3, tilted(VIEW, 5.0)))
        scene.commit()
        image = picture(scene, 8, size=8, samples_per_pass=4, photons_per_pass=1 << 17, photons_carry=carry)
    mean, error = image.mean(), image.mean(axis=2).std() / 8
    assert error < 0.01 * expected
    assert mean == pytest.approx(expected, abs=4 * error + 1e-3 * expected), f"{mean:.4f} ± {error:.4f}, expected {expected:.4f}"
