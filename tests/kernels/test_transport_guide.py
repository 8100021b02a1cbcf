# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons are sent where a pilot found them of use: through a slit, mostly; and the light is the same as by camera paths."""

import math

import numpy as np
from opal_kernels import programs
from opal_kernels.descriptions import Carry, Light, LightType, World
from opal_kernels.render import Render
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, box, looking_down, orthographic, square


def slit_and_plate(scene):
    """A lamp of 0.2 m over a black screen whose hole lets 2 % of what is aimed at the plate pass, and a white floor."""
    white, black = scene.add_material(programs.diffuse((0.8,) * 3)), scene.add_material(programs.diffuse((0.0,) * 3))
    scene.add_instances(scene.add_mesh(*square(4)), IDENTITY, [white])
    scene.add_instances(scene.add_mesh(*box((-0.5, -0.5, 0.3), (0.5, 0.5, 0.4))), IDENTITY, [scene.add_gem(1.5)])
    x, h = (-3.0, -0.07, 0.07, 3.0), 0.8
    corners = [(a, b, h) for a in x for b in x]
    quads = [(4 * i + j, 4 * i + j + 4, 4 * i + j + 5, 4 * i + j + 1) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    screen = scene.add_mesh(corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    scene.add_instances(screen, IDENTITY, [black])
    scene.add_light(Light(type=LightType.RECTANGLE, power=50.0, size_u=0.2, size_v=0.2, transform=looking_down(3.0)))
    scene.set_world(World(programs.emission((0.02,) * 3)))
    scene.set_camera(**orthographic(0.25, looking_down(0.28)))
    scene.commit()


def picture(seed, carry, passes=8, photons=50_000):
    with Scene(threads=2) as scene:
        slit_and_plate(scene)
        settings = {"samples_per_pass": 4, "photons_per_pass": photons, "photons_carry": carry}
        with Render(scene, width=12, height=12, seed=seed, max_depth=8, **settings) as render:
            return render.run(passes).film("COMBINED")[..., :3].mean(dtype=np.float64), render.statistics


def test_photons_go_through_the_slit():
    """Aimed at the plate's sphere, 2 % of the lamp's photons would pass; the pilot's densities bring several times as many."""
    _, statistics = picture(1, Carry.CAUSTICS, passes=2)
    assert statistics["photons_stored"] > 0.1 * statistics["photons_emitted"]


def test_guided_photons_bring_the_light_that_others_bring():
    """INDIRECT photons are sent everywhere alike. Means of four and of eight seeds, within three of their standard errors, which are under 1 %."""
    guided = [picture(seed, Carry.CAUSTICS)[0] for seed in range(4)]
    alike = [picture(seed, Carry.INDIRECT, photons=200_000)[0] for seed in range(4, 12)]
    error = math.hypot(np.std(guided, ddof=1) / 2, np.std(alike, ddof=1) / math.sqrt(8))
    mean = np.mean(alike)
    assert error < 0.01 * mean, f"too noisy to tell: {error / mean}"
    assert abs(np.mean(guided) - mean) < 3 * error + 0.002 * mean, f"{np.mean(guided)} guided, {mean} not, ± {error}"
