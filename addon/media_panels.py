# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of media: of a material, of a clouded gem, of a world."""

from __future__ import annotations

from typing import Any

import bpy

from .rainbow_panels import draw_drops


def draw_medium(layout: Any, medium: Any, grids: bool = True) -> None:
    """The settings of `OpalMediumProperties`; a world has no grids."""
    layout.prop(medium, "preset")
    column = layout.column()
    column.prop(medium, "extinction", text="Extinction (1/m)")
    column.prop(medium, "extinction_color", text="Color")
    column.prop(medium, "albedo")
    column = layout.column()
    column.prop(medium, "phase", text="Phase")
    row = column.row()
    row.active = medium.phase == "HENYEY_GREENSTEIN"
    row.prop(medium, "anisotropy")
    column = layout.column()
    column.prop(medium, "density")
    if medium.density == "NOISE":
        for name in ("noise_scale", "noise_detail", "noise_contrast", "noise_seed"):
            column.prop(medium, name)
    elif medium.density == "GRID" and grids:
        column.prop(medium, "grid")
    column = layout.column()
    column.prop(medium, "emission_strength", text="Emission (1/m)")
    column = column.column()
    column.active = medium.emission_strength > 0.0
    column.prop(medium, "emission_source", text="Source")
    column.prop(medium, "emission_temperature" if medium.emission_source == "BLACKBODY" else "emission_color")
    if grids:
        column.prop(medium, "emission_grid")


class _Panel(bpy.types.Panel):
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {"OPAL"}


class OPAL_MATERIAL_PT_medium(_Panel):
    bl_label = "Medium"
    bl_context = "material"

    @classmethod
    def poll(cls, context: Any) -> bool:
        material = context.material
        return context.engine in cls.COMPAT_ENGINES and material is not None and material.opal.kind == "MEDIUM"

    def draw(self, context: Any) -> None:
        self.layout.use_property_split = True
        draw_medium(self.layout, context.material.opal.medium)


class OPAL_MATERIAL_PT_clouded(_Panel):
    bl_label = "Clouded"
    bl_context = "material"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        material = context.material
        return context.engine in cls.COMPAT_ENGINES and material is not None and material.opal.kind == "GEM"

    def draw_header(self, context: Any) -> None:
        self.layout.prop(context.material.opal, "use_medium", text="")

    def draw(self, context: Any) -> None:
        self.layout.use_property_split = True
        self.layout.active = context.material.opal.use_medium
        draw_medium(self.layout, context.material.opal.medium)


class OPAL_WORLD_PT_medium(_Panel):
    bl_label = "Medium"
    bl_context = "world"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.engine in cls.COMPAT_ENGINES and context.world is not None

    def draw(self, context: Any) -> None:
        layout, world = self.layout, context.world.opal
        layout.use_property_split = True
        layout.prop(world, "kind")
        if world.kind == "NONE":
            return
        column = layout.column()
        column.prop(world, "scale_height")
        row = column.row()
        row.active = world.scale_height > 0.0
        row.prop(world, "base_height")
        if world.kind == "MEDIUM":
            draw_medium(layout, world.medium, grids=False)
        else:
            draw_drops(layout, world.rainbow)


CLASSES = (OPAL_MATERIAL_PT_medium, OPAL_MATERIAL_PT_clouded, OPAL_WORLD_PT_medium)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
