# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of presets that open from a panel's header, as Blender's do: render settings by name, materials by their swatches."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
from bpy.props import StringProperty

from . import media_presets, presets, rainbow_presets, render_presets, swatches


class _Popover(bpy.types.Panel):
    bl_space_type = "PROPERTIES"
    bl_region_type = "HEADER"
    COMPAT_ENGINES = {"OPAL"}

    @classmethod
    def button(cls, layout: Any) -> None:
        """The icon in a panel's header that opens the list."""
        layout.emboss = "NONE"
        layout.popover(panel=cls.__name__, icon="PRESET", text="")


class OPAL_PT_render_presets(_Popover):
    bl_label = "Render Presets"
    bl_ui_units_x = 9

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.emboss = "PULLDOWN_MENU"
        layout.operator_context = "EXEC_DEFAULT"
        for name in render_presets.BUILT_IN:
            layout.operator("opal.render_preset_apply", text=name).name = name
        own = render_presets.own()
        if own:
            layout.separator()
        for name in own:
            row = layout.row(align=True)
            row.operator("opal.render_preset_apply", text=name, translate=False).name = name
            row.operator("opal.render_preset_remove", text="", icon="REMOVE").name = name
        layout.separator()
        row = layout.row(align=True)
        row.emboss = "NORMAL"
        row.prop(context.window_manager, "opal_preset_name", text="")
        row.operator("opal.render_preset_add", text="", icon="ADD").name = context.window_manager.opal_preset_name


class OPAL_PT_material_presets(_Popover):
    bl_label = "Material Presets"
    bl_ui_units_x = 20

    def draw(self, context: Any) -> None:
        layout, material = self.layout, context.material
        if material is None:
            return
        kind = material.opal.kind if material.opal.kind != "SURFACE" else "GEM"
        grid = layout.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
        grid.emboss = "PULLDOWN_MENU"
        for name, label, icon in _rows(kind):
            button = grid.operator("opal.apply_preset", text=label, icon_value=icon, translate=False)
            button.kind, button.preset = kind, name


def _rows(kind: str) -> list[tuple[str, str, int]]:
    """Name, label and icon of each preset of a kind."""
    items: Callable[[], Any] = {"GEM": presets.species_items, "MEDIUM": media_presets.items, "RAINBOW": rainbow_presets.items}[kind]
    return [(row[0], row[1], swatches.icon(kind, row[0])) for row in list(items())[1:]]


_CLASSES = (OPAL_PT_render_presets, OPAL_PT_material_presets)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.WindowManager.opal_preset_name = StringProperty(
        name="Name", description="Name under which the settings are kept as a preset", default="", options={"SKIP_SAVE"}
    )


def unregister() -> None:
    swatches.clear()
    del bpy.types.WindowManager.opal_preset_name
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
