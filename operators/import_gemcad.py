# SPDX-License-Identifier: GPL-3.0-or-later
"""File › Import › GemCad: a design from a cutter's `.asc` file as a stone of real size."""

from pathlib import Path

import bpy
from bpy.props import EnumProperty, FloatProperty, StringProperty
from bpy_extras.io_utils import ImportHelper
from bpy_extras.object_utils import object_data_add

from ..addon import units
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
        default=gem_object.USUAL_WIDTH,
        min=1e-9,
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

        path = Path(bpy.path.abspath(self.filepath))
        try:
            design = gemcad.parse(gemcad.decode(path.read_bytes()))
            as_designed = design.cut()
        except OSError as error:
            self.report({"ERROR"}, f"{path.name} cannot be read: {error.strerror or error}")
            return {"CANCELLED"}
        except gemcad.GemCadError as error:
            self.report({"ERROR"}, f"{path.name}: {error}")
            return {"CANCELLED"}
        metres = units.metres_per_unit(context.scene)
        gem_object.take_usual_width(self, metres)
        stone = as_designed.scaled(self.size * metres)
        mesh = gem_object.mesh_from_stone(stone, path.stem, metres=metres)
        index = design.refractive_index if self.species == gem_object.CUSTOM and design.refractive_index else None
        mesh.materials.append(gem_object.gem_material(self.species, index))
        object_data_add(context, mesh)
        if self.species == gem_object.CUSTOM and index is None:
            self.report({"WARNING"}, f"{path.name} gives no refractive index (line I): the stone has diamond's; choose a species")
        if outside := design.outside(as_designed):
            lie = "1 facet lies" if len(outside) == 1 else f"{len(outside)} facets lie"
            self.report({"WARNING"}, f"{path.name}: {lie} outside the stone and cut nothing: {_listed(outside)}")
        self.report(
            {"INFO"}, f"{' '.join(design.headers) or path.stem}: {stone.facet_count()} facets, {gem_object.weight(stone, self.species)}"
        )
        return {"FINISHED"}


def _listed(names: list[str], most: int = 6) -> str:
    """Different names, each once and the first few only."""
    different = list(dict.fromkeys(names))
    return ", ".join(different[:most]) + (", …" if len(different) > most else "")


def register() -> None:
    bpy.utils.register_class(OPAL_OT_import_gemcad)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_import_gemcad)
