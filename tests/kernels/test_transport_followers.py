# SPDX-License-Identifier: GPL-3.0-or-later
"""Wavelengths that follow a camera path's hero through gems that disperse, to the light behind them."""

import numpy as np
import pytest
from opal_kernels import programs
from opal_kernels.cuts import round_brilliant
from opal_kernels.descriptions import World, wavelengths
from opal_kernels.scene import Scene
from transport_scenes import IDENTITY, looking_down, orthographic, picture, square


def beneath_a_stone(samples, seed=0):
    """What the camera sees of a white floor under a stone, in a white world: 1, by whatever way through the stone."""
    index = 1.5 + 0.03 * (550.0 / wavelengths()) ** 4  # five times as dispersive as diamond
    solid = round_brilliant().scaled(1.0).solid
    faces = [(f[0], f[i], f[i + 1]) for f in solid.faces for i in range(1, len(f) - 1)]
    stone = np.array(solid.vertices)
    stone[:, 2] += 0.1 - stone[:, 2].min()
    with Scene(threads=2) as scene:
        floor = scene.add_material(programs.diffuse((1.0, 1.0, 1.0)))
        scene.add_instances(scene.add_mesh(*square(50)), IDENTITY, [floor])
        scene.add_instances(scene.add_mesh(stone, faces), IDENTITY, [scene.add_gem(index)])
        scene.set_world(World(programs.emission()))
        scene.set_camera(**orthographic(0.3, looking_down(0.05)))
        scene.commit()
        return picture(scene, 8, size=16, samples_per_pass=samples, max_depth=1024, photons_per_pass=0, seed=seed)


def test_a_furnace_stays_white_behind_a_stone_that_the_floor_sees():
    image = beneath_a_stone(64)
    mean, error = image.mean(axis=(0, 1)), image.std(axis=(0, 1)) / 16
    assert error.max() < 0.002, f"too noisy to tell: {error}"
    assert mean == pytest.approx(1.0, abs=4 * error.max()), f"{mean} ± {error}"
