# SPDX-License-Identifier: GPL-3.0-or-later
"""File › Import › GemCad: a design from a cutter's `.asc` file as a stone of real size."""

from pathlib import Path

import bpy
from bpy.props import EnumProperty, FloatProperty, StringProperty
from bpy_extras.io_utils import ImportHelper
from bpy_extras.object_utils import object_data_add

from ..addon.presets import species_items
from . import gem_object


class OPAL_OT_import_gemcad(bpy.types.Operator, ImportHelper):
    """Import a GemCad design"""

    bl_idname = "opal.import_gemcad"
    bl_label = "Import GemCad"
    bl_description = "Cut a stone after the instructions of a GemCad file (.asc)"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".asc"
    filter_glob: StringProperty(default="*.asc", options={"HIDDEN"})
    species: EnumProperty(
        name="Species",
        description="What the stone is; Custom takes the refractive index that the file gives, without dispersion",
        items=species_items,
    )
    size: FloatProperty(
        name="Width",
        description="Width of the stone at the girdle",
        default=0.0065,
        min=1e-5,
        soft_max=0.1,
        subtype="DISTANCE",
        precision=5,
        step=0.05,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "OBJECT"

    def execute(self, context: bpy.types.Context) -> set[str]:
        from opal_kernels.cuts import gemcad

        path = Path(self.filepath)
        try:
            design = gemcad.parse(gemcad.decode(path.read_bytes()))
            stone = design.cut().scaled(self.size)
        except (OSError, gemcad.GemCadError) as error:
            self.report({"ERROR"}, f"{path.name}: {error}" if isinstance(error, ValueError) else str(error))
            return {"CANCELLED"}
        mesh = gem_object.mesh_from_stone(stone, path.stem)
        index = design.refractive_index if self.species == gem_object.CUSTOM and design.refractive_index else None
        mesh.materials.append(gem_object.gem_material(self.species, index))
        object_data_add(context, mesh)
        self.report(
            {"INFO"}, f"{' '.join(design.headers) or path.stem}: {stone.facet_count()} facets, {gem_object.weight(stone, self.species)}"
        )
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(OPAL_OT_import_gemcad)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_import_gemcad)
