# SPDX-License-Identifier: GPL-3.0-or-later
"""Material panels: what kind a material is, its surface, its gem."""

from __future__ import annotations

import math
from typing import Any

import bpy

from . import curve_icons, preset_panels, presets, units
from .panels import OpalPanel


class _MaterialPanel(OpalPanel):
    bl_context = "material"

    @classmethod
    def poll(cls, context: Any) -> bool:
        material = context.material
        return super().poll(context) and material is not None and not material.grease_pencil


class OPAL_MATERIAL_PT_kind(_MaterialPanel):
    bl_label = "Opal"

    def draw_header_preset(self, _context: Any) -> None:
        preset_panels.OPAL_PT_material_presets.button(self.layout)

    def draw(self, context: Any) -> None:
        self.layout.prop(context.material.opal, "kind", expand=True)


class OPAL_MATERIAL_PT_surface(_MaterialPanel):
    bl_label = "Surface"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.material.opal.kind == "SURFACE"

    def draw(self, context: Any) -> None:
        layout, material = self.layout, context.material
        layout.use_property_split = True
        tree = material.node_tree
        output = tree.get_output_node("ALL") if tree is not None else None
        if output is None:
            layout.prop(material, "diffuse_color")
        else:
            layout.template_node_view(tree, output, output.inputs["Surface"])


class OPAL_MATERIAL_PT_gem(_MaterialPanel):
    bl_label = "Gem"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.material.opal.kind == "GEM"

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        gem = context.material.opal.gem
        layout.prop(gem, "species")
        if gem.refusal:
            layout.label(text=gem.refusal, icon="ERROR")
        if gem.species != presets.CUSTOM and presets.species_of(gem) == presets.CUSTOM:
            layout.label(text="Rendered by its numbers, which are not the species' own", icon="INFO")
        _draw_read_out(layout, gem)
        curve_icons.draw(layout, presets.index_chart(gem))
        layout.prop(gem, "roughness")
        layout.prop(gem, "fresnel")
        layout.prop(gem, "priority")


class OPAL_MATERIAL_PT_gem_dispersion(_MaterialPanel):
    bl_label = "Dispersion"
    bl_parent_id = "OPAL_MATERIAL_PT_gem"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        gem = context.material.opal.gem
        layout.prop(gem, "dispersion", text="Formula")
        if gem.dispersion == "CAUCHY":
            column = layout.column(align=True)
            column.prop(gem, "cauchy_b")
            column.prop(gem, "cauchy_c", text="C (µm²)")
        else:
            layout.prop(gem, "sellmeier_b")
            layout.prop(gem, "sellmeier_c", text="C (µm²)")


class OPAL_MATERIAL_PT_gem_absorption(_MaterialPanel):
    bl_label = "Absorption"
    bl_parent_id = "OPAL_MATERIAL_PT_gem"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        gem = context.material.opal.gem
        layout.prop(gem, "absorption_source", text="From", expand=True)
        if gem.absorption_source == "CURVE":
            row = layout.row()
            row.label(text=f"{len(gem.absorption_curve)} samples")
            curve_icons.draw(layout, presets.absorption_chart(gem, units.here(context)))
        else:
            layout.prop(gem, "absorption_color", text="Color")
            layout.prop(gem, "absorption_depth", text="Depth")
        layout.operator("opal.import_absorption", icon="FILE_FOLDER")


def _draw_read_out(layout: Any, gem: Any) -> None:
    numbers = presets.read_out(gem)
    if numbers is None:
        return
    box = layout.box().column(align=True)
    rows = (
        ("Index at 589.3 nm", f"{numbers.n_d:.4f}"),
        ("Abbe number", f"{numbers.abbe:.1f}" if math.isfinite(numbers.abbe) else "no dispersion"),
        ("Dispersion B to G", f"{numbers.b_to_g:.4f}"),
        ("Critical angle", f"{math.degrees(numbers.critical_angle):.2f}°"),
    )
    for name, value in rows:
        split = box.split(factor=0.6)
        split.label(text=name)
        split.label(text=value)


CLASSES = (
    OPAL_MATERIAL_PT_kind,
    OPAL_MATERIAL_PT_surface,
    OPAL_MATERIAL_PT_gem,
    OPAL_MATERIAL_PT_gem_dispersion,
    OPAL_MATERIAL_PT_gem_absorption,
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    curve_icons.clear()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
