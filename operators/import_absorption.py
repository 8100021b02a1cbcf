# SPDX-License-Identifier: GPL-3.0-or-later
"""A measured absorption curve from a CSV file for the gem of the active material."""

from pathlib import Path

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ImportHelper

from ..addon import presets


def _gem(context: bpy.types.Context) -> bpy.types.Material | None:
    material = getattr(context, "material", None) or getattr(context.object, "active_material", None)
    return material if material is not None and material.opal.kind == "GEM" else None


class OPAL_OT_import_absorption(bpy.types.Operator, ImportHelper):
    """Import a measured absorption curve"""

    bl_idname = "opal.import_absorption"
    bl_label = "Import Absorption"
    bl_description = "Read how the stone absorbs from a text file: a wavelength in nm and an absorption in 1/mm on each line"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".csv"
    filter_glob: StringProperty(default="*.csv;*.txt;*.tsv;*.dat", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        gem = _gem(context)
        if gem is None:
            cls.poll_message_set("The active material is no gem: choose the kind Gem in its Opal panel first")
            return False
        if gem.library is not None or gem.override_library is not None:
            cls.poll_message_set("The material belongs to a library, and with it its curve: make it local first")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        from opal_kernels import curves

        material, path = _gem(context), Path(bpy.path.abspath(self.filepath))
        try:
            nm, per_mm, ignored = curves.parse(path.read_text(encoding="utf-8", errors="replace"))
        except OSError as error:
            self.report({"ERROR"}, f"{path.name} cannot be read: {error.strerror or error}")
            return {"CANCELLED"}
        except curves.CurveError as error:
            self.report({"ERROR"}, f"{path.name}: {error}")
            return {"CANCELLED"}
        presets.take_curve(material.opal.gem, zip(nm.tolist(), per_mm.tolist(), strict=True))
        further = "" if not ignored else "; a further column is ignored" if ignored == 1 else f"; {ignored} further columns are ignored"
        self.report({"INFO"}, f"{material.name}: {len(nm)} samples from {nm[0]:g} to {nm[-1]:g} nm{further}")
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(OPAL_OT_import_absorption)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_import_absorption)
