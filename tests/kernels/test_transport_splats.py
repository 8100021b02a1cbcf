# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons seen directly: what they show of a surface is what a camera path shows, also where its weights depend on the viewer."""

import numpy as np
import pytest
from bsdf_under_test import Bsdf, direction
from opal_kernels import programs
from opal_kernels.descriptions import Carry, Density, Light, LightType, MaterialFlag, Pass, World, wavelengths
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, orthographic, picture, placed, square

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


def test_smoke_that_takes_red_away_leaves_the_blue_of_a_prism():
    """Noise without contrast, which is tracked, beside even smoke of half its density, in closed form. What follows a photon's hero comes through by the hero's walk."""

    def blue(extinction, **density):
        with Scene(threads=2) as scene:
            scene.add_instances(scene.add_mesh(*square(3.0)), IDENTITY, [scene.add_material(programs.diffuse((1.0, 1.0, 1.0)))])
            prism = [(-0.5, -0.5, 1), (0.5, -0.5, 1), (0.5, 0.5, 1), (-0.5, 0.5, 1), (-0.5, 0, 1.6), (0.5, 0, 1.6)]
            faces = [(0, 3, 2), (0, 2, 1), (0, 1, 5), (0, 5, 4), (2, 3, 4), (2, 4, 5), (0, 4, 3), (1, 2, 5)]
            scene.add_instances(scene.add_mesh(prism, faces), IDENTITY, [scene.add_gem(1.5 + 0.03 * (550.0 / wavelengths()) ** 4)])
            red = scene.add_medium(np.where(wavelengths() > 510, extinction, 0.0), 0.0, **density)
            material = scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=red)
            scene.add_instances(scene.add_mesh(*box((-4, -4, 2.0), (4, 4, 4.0))), IDENTITY, [material])
            scene.add_light(Light(type=LightType.POINT, power=300.0, transform=placed(0, 1.5, 1.9)[:3]))
            scene.set_camera(**orthographic(2.5, looking_down(5.0)))
            scene.commit()
            with Render(scene, width=8, height=8, samples_per_pass=1, photons_per_pass=60_000, seed=1, passes=[Pass.CAUSTICS]) as render:
                return render.run(1).film("CAUSTICS")[..., 2].astype(np.float64).mean()

    assert blue(1.0, density=Density.NOISE, noise_contrast=0.0) == pytest.approx(blue(0.5), rel=0.1)
