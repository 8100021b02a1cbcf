# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scenes with rain share: fields with trees under a dark sky, a low sun behind the camera, and a curtain of drops."""

from __future__ import annotations

import math

import _countryside
import _scene
import _storm_sky
import bpy


def sun(height_rad: float, energy: float = 4.0, angle: float = math.radians(0.533)) -> bpy.types.Object:
    """A low sun behind the camera, a little reddened."""
    toward = (0.0, -math.cos(height_rad), math.sin(height_rad))
    return _scene.lamp("Sun", "SUN", toward, (0.0, 0.0, 0.0), energy, angle=angle, color=(1.0, 0.88, 0.72))


def curtain(extinction: float, near: float = 150.0, far: float = 270.0, **drops: object) -> bpy.types.Material:
    """A wall of drops between two distances; settings go to `material.opal.rainbow`."""
    material = bpy.data.materials.new("Rain")
    if hasattr(material, "opal"):
        material.opal.kind = "RAINBOW"
        for name, value in drops.items():
            setattr(material.opal.rainbow, name, value)
        material.opal.rainbow.extinction = extinction
    _scene.box("Rain", (-900.0, near, -30.0), (900.0, far, 420.0), material)
    return material


def everywhere(world: bpy.types.World, extinction: float, scale_height: float, **drops: object) -> None:
    """Drops in all the air, thinning out with height; settings go to `world.opal.rainbow`."""
    if hasattr(world, "opal"):
        world.opal.kind, world.opal.scale_height = "RAINBOW", scale_height
        for name, value in drops.items():
            setattr(world.opal.rainbow, name, value)
        world.opal.rainbow.extinction = extinction


def landscape(sun_height: float, target: tuple[float, float, float], lens: float, **drops: object) -> bpy.types.Scene:
    """Fields, trees, a storm's sky, the sun behind and a curtain of these drops; the camera stands at eye height on a bank."""
    scene = fair_weather(sun_height, target, lens)
    curtain(0.0052, **drops)
    return scene


def fair_weather(sun_height: float, target: tuple[float, float, float], lens: float) -> bpy.types.Scene:
    """The same without rain."""
    scene = _scene.empty()
    _countryside.build()
    sun(sun_height)
    _storm_sky.build(0.65)
    _scene.camera((0.0, 0.0, 5.0), target, lens)
    scene.camera.data.clip_end = 1e5
    scene.view_settings.exposure, scene.view_settings.look = 0.9, "AgX - High Contrast"
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    _scene.limit(scene, 4, 0, 50.0)
    return scene
