# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of rainbows: the drops of a material or a world, and the camera's filter."""

from __future__ import annotations

from typing import Any

import bpy

AIRY_FROM = 0.05  # mm: below, the cubic wavefront is too simple


def too_small_for_airy(rainbow: Any) -> bool:
    """Whether Airy's theory would show a plausible bow that is wrong."""
    return rainbow.theory == "AIRY" and rainbow.radius < AIRY_FROM


def draw_drops(layout: Any, rainbow: Any) -> None:
    """The settings of `OpalRainbowProperties`."""
    layout.prop(rainbow, "preset")
    layout.prop(rainbow, "theory")
    if too_small_for_airy(rainbow):
        layout.label(text="Lorenz-Mie is right for drops below 0.05 mm", icon="INFO")
    column = layout.column()
    column.prop(rainbow, "distribution")
    column.prop(rainbow, "radius", text="Radius (mm)")
    row = column.row()
    row.active = rainbow.distribution not in {"SINGLE", "MARSHALL_PALMER"}
    row.prop(rainbow, "spread")
    layout.prop(rainbow, "extinction", text="Extinction (1/m)")
    column = layout.column()
    column.prop(rainbow, "liquid")
    if rainbow.liquid == "CUSTOM":
        column.prop(rainbow, "index")
        column.prop(rainbow, "index_dispersion", text="Dispersion (µm²)")
    else:
        column.prop(rainbow, "temperature", text="Temperature (°C)")
        if rainbow.liquid == "SEA_WATER":
            column.prop(rainbow, "salinity", text="Salinity (‰)")
    row = layout.row()
    row.active = rainbow.theory == "DROPLET"
    row.prop(rainbow, "flattening")
    column = layout.column(heading="Keep")
    column.prop(rainbow, "diffraction")
    column.prop(rainbow, "polarization")


class OPAL_MATERIAL_PT_rainbow(bpy.types.Panel):
    bl_label = "Rainbow"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"
    COMPAT_ENGINES = {"OPAL"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        material = context.material
        return context.engine in cls.COMPAT_ENGINES and material is not None and material.opal.kind == "RAINBOW"

    def draw(self, context: Any) -> None:
        self.layout.use_property_split = True
        draw_drops(self.layout, context.material.opal.rainbow)


class OPAL_CAMERA_PT_polarizer(bpy.types.Panel):
    bl_label = "Polarizing Filter"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"
    bl_options = {"DEFAULT_CLOSED"}
    COMPAT_ENGINES = {"OPAL"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.engine in cls.COMPAT_ENGINES and context.camera is not None

    def draw_header(self, context: Any) -> None:
        self.layout.prop(context.camera.opal, "polarizer", text="")

    def draw(self, context: Any) -> None:
        self.layout.use_property_split = True
        self.layout.active = context.camera.opal.polarizer
        self.layout.prop(context.camera.opal, "polarizer_angle")


CLASSES = (OPAL_MATERIAL_PT_rainbow, OPAL_CAMERA_PT_polarizer)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
