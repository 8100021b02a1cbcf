# SPDX-License-Identifier: GPL-3.0-or-later
"""The caustic scenes in Opal."""

from __future__ import annotations

import math
import time

import numpy as np
from caustic_scenes import FLOOR_REFLECTANCE, LAMP_RADIANCE, SIZE, CausticScene, looking
from opal_kernels import programs
from opal_kernels.descriptions import Light, LightType, wavelengths
from opal_kernels.render import Render
from opal_kernels.scene import Scene

METHODS = ("photons",)


def snapshots(description: CausticScene, method: str, times: list[float], seed: int) -> list[tuple[float, np.ndarray]]:
    """(seconds, picture) when each of ``times`` has passed."""
    identity = [np.eye(4)]
    with Scene() as scene:
        white = scene.add_material(programs.diffuse((FLOOR_REFLECTANCE,) * 3))
        black = scene.add_material(programs.diffuse((0.0,) * 3))
        glass = scene.add_gem(description.index(wavelengths()))
        for mesh, material in ((description.floor, white), (description.glass, glass), (description.screen, black)):
            if mesh is not None:
                scene.add_instances(scene.add_mesh(mesh.corners, mesh.triangles), identity, [material])
        side = description.lamp_side
        transform = looking(description.lamp_centre, description.lamp_target)
        power = LAMP_RADIANCE * math.pi * side**2
        scene.add_light(Light(type=LightType.RECTANGLE, power=power, size_u=side, size_v=side, transform=transform))
        half = math.tan(0.5 * description.field_of_view)
        scene.set_camera(transform=looking(description.eye, description.target), window=(-half, half, -half, half))
        start, found = time.perf_counter(), []
        scene.commit()
        film = {"width": SIZE, "height": SIZE, "filter": 0, "filter_width": 1.0}
        defaults = {"samples_per_pass": 4, "photons_per_pass": 200_000, "adaptive": True}  # the add-on's
        with Render(scene, **film, **defaults, max_depth=64, seed=seed) as render:
            for number in range(1_000_000):
                render.run_pass(number)
                if (now := time.perf_counter() - start) >= times[len(found)]:
                    found.append((now, render.film("COMBINED")[::-1, :, :3].copy()))
                    if len(found) == len(times):
                        return found
    return found
