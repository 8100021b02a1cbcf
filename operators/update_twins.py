# SPDX-License-Identifier: GPL-3.0-or-later
"""Brings the node trees that Cycles and EEVEE show up to date with Opal's settings."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty


class OPAL_OT_update_twins(bpy.types.Operator):
    """Make the twins follow"""

    bl_idname = "opal.update_twins"
    bl_label = "Update Twins"
    bl_description = "Make the node trees that Cycles and EEVEE show follow Opal's settings; trees that were edited by hand are left alone"
    bl_options = {"REGISTER", "UNDO"}

    scope: EnumProperty(
        name="Scope",
        description="Whose twins are updated",
        items=(
            ("ALL", "All", "Every material and world of the file"),
            ("ACTIVE", "Active Material", "The material that is shown"),
        ),
        default="ALL",
    )
    overwrite: BoolProperty(
        name="Overwrite Edited Trees",
        description="Also write over node trees that were made or edited by hand",
        default=False,
        options={"SKIP_SAVE"},
    )

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        from ..addon import twins

        result = self.execute(context)
        if self.overwrite or not self._with(twins.Result.EDITED):
            return result
        return context.window_manager.invoke_props_dialog(self, width=420)

    def draw(self, _context: bpy.types.Context) -> None:
        from ..addon import twins

        column = self.layout.column()
        for name in self._with(twins.Result.EDITED)[:8]:
            column.label(text=f"“{name}” {twins.Result.EDITED.value}", icon="INFO")
        column.prop(self, "overwrite")

    def execute(self, context: bpy.types.Context) -> set[str]:
        from ..addon import twins

        self.results = {}
        for owner in self._owners(context):
            function = twins.update_world if isinstance(owner, bpy.types.World) else twins.update
            self.results[owner.name_full] = function(owner, self.overwrite, context.scene)
        updated, edited = self._with(twins.Result.UPDATED), self._with(twins.Result.EDITED)
        sentence = f"{len(updated)} twins follow Opal's settings"
        if edited:
            sentence += "; edited by hand and left alone: " + ", ".join(edited)
        if linked := self._with(twins.Result.LINKED):
            sentence += "; linked from a library: " + ", ".join(linked)
        self.report({"INFO"}, sentence)
        return {"FINISHED"}

    def _owners(self, context: bpy.types.Context) -> list[Any]:
        from ..addon import twins

        if self.scope == "ALL":
            return list(twins.worlds_and_materials())
        material = getattr(context, "material", None) or (context.object.active_material if context.object else None)
        return [material] if material is not None else []

    def _with(self, result: Any) -> list[str]:
        return [name for name, got in self.results.items() if got is result]


def register() -> None:
    bpy.utils.register_class(OPAL_OT_update_twins)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_update_twins)
