# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes with rain for the add-on's tests. Nothing here asserts."""

from __future__ import annotations

import math

import bpy
import stage

SUN_HEIGHT = math.radians(20.0)


def sun(height: float = SUN_HEIGHT, azimuth: float = math.pi, energy: float = 4.0) -> bpy.types.Object:
    """A sun at a height and an azimuth (from +Y towards +X)."""
    data = bpy.data.lights.new("Sun", "SUN")
    data.energy, data.angle = energy, math.radians(0.53)
    obj = stage.link("Sun", data)
    obj.rotation_euler = (math.pi / 2 - height, 0.0, math.pi - azimuth)
    bpy.context.view_layer.update()
    return obj


def looking(azimuth: float = 0.0, height: float = 0.2094, lens: float = 18.0) -> bpy.types.Object:
    """A camera at 2 m that looks at a height over the horizon."""
    return stage.camera((0, 0, 2), (math.pi / 2 + height, 0.0, -azimuth), lens=lens, clip_end=1e5)


def rain_scene(width: int = 48, height: int = 27, passes: int = 2, **drops: object) -> bpy.types.Scene:
    """A curtain of rain under a sun behind the camera; cheap drops."""
    scene = stage.scene(width, height, passes, 4)
    sun()
    looking()
    bpy.ops.opal.add_rain()
    rainbow = bpy.context.object.active_material.opal.rainbow
    rainbow.theory = "DESCARTES_SAMPLED"
    for name, value in drops.items():
        setattr(rainbow, name, value)
    return scene
