# SPDX-License-Identifier: GPL-3.0-or-later
"""Three media side by side under one sun: a cloud of procedural noise, a ball of milk, and a glowing smoke that turns light into heat.

The milk is the measured one of Jensen et al. 2001: light goes into it and comes out again after thousands of scatterings. The cloud is as
dense as noise says, tracked by null collisions. The smoke takes most of what it meets and glows as a black body of 1400 K.
"""

import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import _scene


def medium(name: str, **settings: object) -> bpy.types.Material:
    """A material that fills what it covers."""
    material = bpy.data.materials.new(name)
    material.opal.kind = "MEDIUM"
    for key, value in settings.items():
        setattr(material.opal.medium, key, value)
    return material


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    _scene.stage(3.0, _scene.checker("Floor", (0.35, 0.33, 0.3), (0.6, 0.58, 0.55), 30.0))
    cloud = medium(
        "Cloud", preset="FOG", extinction=60.0, density="NOISE", noise_scale=0.08, noise_detail=5.0, noise_contrast=5.0, noise_seed=3
    )
    # The sample of milk is a thousand times larger than the ball would need to be: thinner by as much, it looks like a drop close by.
    milk = medium("Milk", preset="MILK", extinction=400.0)
    smoke = medium(
        "Smoke",
        preset="SMOKE",
        extinction=30.0,
        density="NOISE",
        noise_scale=0.1,
        noise_detail=2.0,
        noise_contrast=4.0,
        noise_seed=8,
        emission_source="BLACKBODY",
        emission_temperature=1400.0,
        emission_strength=3.0,
    )
    for place, material in ((-0.24, cloud), (0.0, milk), (0.24, smoke)):
        _scene.sphere(material.name, (place, 0.0, 0.1005), 0.1, material)
    _scene.lamp("Sun", "SUN", (-1.0, 0.6, 1.2), (0.0, 0.0, 0.0), 3.0, angle=0.02)
    _scene.plain_world((0.35, 0.5, 0.8), 0.35)
    _scene.camera((0.0, -0.95, 0.34), (0.0, 0.0, 0.085), 42.0)
    scene.render.resolution_x, scene.render.resolution_y = 640, 360
    _scene.limit(scene, 18, 0)
    return scene


if __name__ == "__main__":
    _scene.run(build, "cloud_milk_fire")
