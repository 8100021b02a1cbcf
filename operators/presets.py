# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets: a material's from a picture in a list, and those of the render settings."""

from typing import Any

import bpy
from bpy.props import EnumProperty, StringProperty

from ..addon import media_presets, presets, rainbow_presets, render_presets


def _has(kind: str, name: str) -> bool:
    if kind == "GEM":
        return any(name == item[0] for item in presets.species_items()[1:])
    return name in (media_presets.PRESETS if kind == "MEDIUM" else rainbow_presets.PRESETS)


class OPAL_OT_apply_preset(bpy.types.Operator):
    """Make the material a known one"""

    bl_idname = "opal.apply_preset"
    bl_label = "Apply Material Preset"
    bl_description = "Make the active material a gem, a medium or a rainbow of known numbers"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    kind: EnumProperty(
        name="Kind",
        description="What the material becomes",
        items=(
            ("GEM", "Gem", "A stone of a species"),
            ("MEDIUM", "Medium", "A medium of known coefficients"),
            ("RAINBOW", "Rainbow", "The drops of a known bow"),
        ),
        default="GEM",
    )
    preset: StringProperty(name="Preset", description="Name of the species, medium or bow, such as RUBY, MILK or FOGBOW", default="DIAMOND")

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:
        if properties.kind == "GEM":
            return next((item[2] for item in presets.species_items() if item[0] == properties.preset), cls.bl_description)
        rows = media_presets.items() if properties.kind == "MEDIUM" else rainbow_presets.items()
        return next((text for name, _, text in rows if name == properties.preset), cls.bl_description)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        material = _material(context)
        if material is None or material.library is not None:
            cls.poll_message_set("There is no active material that can be changed")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not _has(self.kind, self.preset):
            self.report({"ERROR"}, f"There is no {self.kind.lower()} named “{self.preset}”.")
            return {"CANCELLED"}
        opal = _material(context).opal
        opal.kind = self.kind
        if self.kind == "GEM":
            opal.gem.species = self.preset
        elif self.kind == "MEDIUM":
            opal.medium.preset = self.preset
        else:
            opal.rainbow.preset = self.preset
        return {"FINISHED"}


def _material(context: bpy.types.Context) -> Any:
    return getattr(context, "material", None) or getattr(context.object, "active_material", None)


class _RenderPreset:
    """What the operators of render presets share."""

    name: StringProperty(name="Name", description="Name of the preset", default="")

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.act(context.scene.opal)
        except render_presets.PresetError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class OPAL_OT_render_preset_apply(bpy.types.Operator, _RenderPreset):
    """Set the render as a preset says"""

    bl_idname = "opal.render_preset_apply"
    bl_label = "Apply Render Preset"
    bl_description = "Set passes, samples, photons and limits as the preset says, and what it does not say as in a new file"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    def act(self, opal: Any) -> None:
        if wrong := render_presets.apply(opal, self.name):
            self.report({"WARNING"}, f"The preset “{self.name}” says what Opal does not know: " + ", ".join(wrong))


class OPAL_OT_render_preset_add(bpy.types.Operator, _RenderPreset):
    """Keep the settings as a preset"""

    bl_idname = "opal.render_preset_add"
    bl_label = "Add Render Preset"
    bl_description = "Keep these settings under a name, for every file"
    bl_options = {"INTERNAL"}

    def act(self, opal: Any) -> None:
        path = render_presets.save(opal, self.name)
        self.report({"INFO"}, f"The preset “{path.stem}” is kept.")


class OPAL_OT_render_preset_remove(bpy.types.Operator, _RenderPreset):
    """Delete a preset"""

    bl_idname = "opal.render_preset_remove"
    bl_label = "Remove Render Preset"
    bl_description = "Delete this preset; the settings stay as they are"
    bl_options = {"INTERNAL"}

    def act(self, _opal: Any) -> None:
        render_presets.remove(self.name)


_CLASSES = (OPAL_OT_apply_preset, OPAL_OT_render_preset_apply, OPAL_OT_render_preset_add, OPAL_OT_render_preset_remove)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
