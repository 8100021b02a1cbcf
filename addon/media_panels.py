# SPDX-License-Identifier: GPL-3.0-or-later
"""Material panels of media."""

from __future__ import annotations

from typing import Any

import bpy


class _MediaPanel(bpy.types.Panel):
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"
    COMPAT_ENGINES = {"OPAL"}
    kind = ""

    @classmethod
    def poll(cls, context: Any) -> bool:
        material = context.material
        return context.engine in cls.COMPAT_ENGINES and material is not None and material.opal.kind == cls.kind

    def draw(self, context: Any) -> None:
        self.layout.use_property_split = True
        self.draw_settings(self.layout, context.material.opal)

    def draw_settings(self, layout: Any, opal: Any) -> None:
        raise NotImplementedError


class OPAL_MATERIAL_PT_medium(_MediaPanel):
    bl_label = "Medium"
    kind = "MEDIUM"

    def draw_settings(self, layout: Any, opal: Any) -> None:
        medium = opal.medium
        layout.prop(medium, "extinction", text="Extinction (1/m)")
        layout.prop(medium, "albedo")
        layout.prop(medium, "phase", text="Phase")
        row = layout.row()
        row.active = medium.phase == "HENYEY_GREENSTEIN"
        row.prop(medium, "anisotropy")
        column = layout.column(align=True)
        column.prop(medium, "emission_color", text="Emission")
        column.prop(medium, "emission_strength", text="Strength (1/m)")


CLASSES = (OPAL_MATERIAL_PT_medium,)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
