# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of what the operators make: layers over Cycles, the comparison, films of a farm, a material's twin."""

from __future__ import annotations

import json
from typing import Any

import bpy

from . import compare_cycles, own_images


class _Panel(bpy.types.Panel):
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}
    COMPAT_ENGINES = {"OPAL", "CYCLES"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.engine in cls.COMPAT_ENGINES


class OPAL_RENDER_PT_over_cycles(_Panel):
    bl_label = "Opal over Cycles"

    def draw(self, _context: Any) -> None:
        column = self.layout.column()
        column.operator("opal.composite", icon="NODE_COMPOSITING")
        column.operator("opal.render_layers", icon="RENDERLAYERS")


class OPAL_RENDER_PT_comparison(_Panel):
    bl_label = "Comparison with Cycles"

    def draw(self, context: Any) -> None:
        layout = self.layout
        row = layout.row(align=True)
        row.operator("opal.compare_cycles", text="Scene").mode = "SCENE"
        row.operator("opal.compare_cycles", text="Volumes").mode = "VOLUMES"
        text = context.scene.get(compare_cycles.KEY)
        if not isinstance(text, str):
            return
        box = layout.box().column(align=True)
        for name, value in rows_of(json.loads(text)):
            split = box.split(factor=0.45)
            split.label(text=name)
            split.label(text=value)
        owner = own_images.owner_of(context.scene, context.view_layer)
        for name in (compare_cycles.SIDE_BY_SIDE, compare_cycles.DIFFERENCE):
            if (image := own_images.own(name, owner)) is not None:
                layout.template_icon(image.preview_ensure().icon_id, scale=7.0)
                layout.label(text=f"Image “{image.name}”: {image[own_images.KEY]}")


def rows_of(result: dict[str, Any]) -> list[tuple[str, str]]:
    """A comparison's numbers as rows of text."""
    rows = [("Mean ratio (R G B)", "  ".join("-" if r is None else f"{r:.4f}" for r in result["mean_ratio"]))]
    for key, name, form in (("relative_mse", "Relative MSE", ".3g"), ("psnr", "PSNR (dB)", ".2f"), ("ssim", "SSIM", ".4f")):
        rows.append((name, "-" if result[key] is None else format(result[key], form)))
    rows.append(("FLIP", "not installed" if result["flip"] is None else f"{result['flip']:.4f}"))
    rows += [
        (f"{name}", f"{result['seconds'][key]:.1f} s, {result['memory'][key] / 2**20:.0f} MB")
        for key, name in (("opal", "Opal"), ("cycles", "Cycles"))
    ]
    for region in result.get("regions", ()):
        x0, y0, x1, y1 = region["box"]
        ratio = "dark" if region["ratio"] is None else f"{region['ratio']:.4f} ± {region['error']:.4f}"
        rows.append((f"{x0}–{x1}, {y0}–{y1}", ratio))
    return rows


class OPAL_RENDER_PT_farm(_Panel):
    bl_label = "Animation and Farm"
    COMPAT_ENGINES = {"OPAL"}

    def draw(self, context: Any) -> None:
        layout, opal = self.layout, context.scene.opal
        layout.use_property_split = True
        layout.prop(opal, "seed_per_frame")
        layout.prop(opal, "pass_first")
        layout.prop(opal, "use_film_file")
        column = layout.column()
        column.active = opal.use_film_file
        column.prop(opal, "film_path")
        layout.operator("opal.merge", icon="SELECT_EXTEND")


class OPAL_MATERIAL_PT_twin(_Panel):
    bl_label = "Cycles and EEVEE Twin"
    bl_context = "material"
    COMPAT_ENGINES = {"OPAL", "CYCLES", "BLENDER_EEVEE", "BLENDER_EEVEE_NEXT", "BLENDER_WORKBENCH"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        material = context.material
        return super().poll(context) and material is not None and material.opal.kind != "SURFACE"

    def draw(self, context: Any) -> None:
        from ..addon import twins

        layout, material = self.layout, context.material
        managed = twins.is_managed(material)
        layout.label(
            text="The node tree follows Opal's settings" if managed else "The node tree was made by hand and is left alone",
            icon="LINKED" if managed else "UNLINKED",
        )
        row = layout.row(align=True)
        row.operator_context = "EXEC_DEFAULT"
        action = row.operator("opal.update_twins", text="Update" if managed else "Replace by Twin")
        action.scope, action.overwrite = "ACTIVE", not managed


CLASSES = (OPAL_RENDER_PT_over_cycles, OPAL_RENDER_PT_comparison, OPAL_RENDER_PT_farm, OPAL_MATERIAL_PT_twin)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
