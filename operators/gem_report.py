# SPDX-License-Identifier: GPL-3.0-or-later
"""The eye of a gemmologist: light return, fire, leakage and the tilt curve of the active stone, as numbers and as a page."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
from bpy.props import FloatProperty, IntProperty, StringProperty

from ..addon import presets, units
from . import image_files
from .job import Aside, Steps
from .long_job import LongJob

_NAME = "Gem Report"


class OPAL_OT_gem_report(bpy.types.Operator, LongJob):
    """Judge the active stone as a gemmologist does"""

    bl_idname = "opal.gem_report"
    bl_label = "Gem Report"
    bl_description = (
        "Render the active stone face-up under a bright hemisphere with the shadow of the observer's head, and measure its light return, "
        "fire, leakage and tilt curve; the stone looks up along its own Z axis"
    )
    bl_options = {"UNDO"}

    filepath: StringProperty(
        name="File",
        description="Where the page is written as PNG and its numbers, beside it, as text; empty keeps both in Blender alone",
        default="",
        subtype="FILE_PATH",
    )
    size: IntProperty(name="Size", description="Pixels across each picture of the stone", default=256, min=128, soft_max=1024, max=4096)
    passes: IntProperty(name="Passes", description="Passes of eight samples a pixel for the pictures", default=16, min=1, soft_max=256)
    head_angle: FloatProperty(
        name="Head",
        description="Full angle of the cone that the observer's head takes out of the hemisphere",
        default=math.radians(30.0),
        min=0.0,
        max=math.radians(120.0),
        subtype="ANGLE",
    )
    tilt: FloatProperty(
        name="Tilt",
        description="The tilt curve runs from minus this angle to this angle, about the stone's own X axis",
        default=math.radians(30.0),
        min=math.radians(1.0),
        max=math.radians(80.0),
        subtype="ANGLE",
    )
    tilt_steps: IntProperty(name="Tilt Steps", description="How many tilts the curve has", default=13, min=3, soft_max=61)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = context.active_object
        if obj is None or obj.type != "MESH":
            cls.poll_message_set("Choose a stone: a mesh with a material of the kind Gem")
            return False
        return True

    def steps(self, context: bpy.types.Context) -> Steps:
        from opal_kernels.binding import OpalError

        obj = context.active_object
        try:
            stone, notes = _stone_of(obj, context.evaluated_depsgraph_get(), units.metres_per_unit(context.scene))
        except ValueError as error:
            self.report({"ERROR"}, f"“{obj.name}”: {error}")
            return {"CANCELLED"}
        work = _Work(self, stone, obj.name, notes)
        try:
            yield Aside(work.make, "")
        except (OpalError, ValueError, MemoryError) as error:
            self.report({"ERROR"}, str(error) or "There is not enough memory for the report.")
            return {"CANCELLED"}
        for note in work.notes:
            self.report({"WARNING"}, f"“{work.title}”: {note}")
        image = image_files.to_image(_NAME, work.page)
        text = image_files.to_text(_NAME, work.table)
        if self.filepath:
            path = Path(bpy.path.abspath(self.filepath)).with_suffix(".png")
            try:
                image_files.save_png(path, work.page)
                path.with_suffix(".txt").write_text(work.table, encoding="utf-8")
            except (OSError, RuntimeError) as error:
                self.report({"ERROR"}, f"The report stays in Blender: {path} cannot be written ({error}).")
                return {"FINISHED"}
        shares = work.result.face_up
        self.report(
            {"INFO"},
            f"{work.title}: light return {shares.light_return:.1%}, fire {work.result.fire:.2f}°, leakage {shares.leakage:.1%}; "
            f"the page is the image “{image.name}”, the numbers the text “{text.name}”",
        )
        return {"FINISHED"}


def _stone_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, metres: float) -> tuple[Any, list[str]]:
    """An object as the `opal_kernels.gem_report.FacetedStone` it is at its scale, and what that leaves out; ValueError says what is wrong.

    Parameters
    ----------
    metres : float
        Per unit.
    """
    import numpy as np
    from opal_kernels import gem as gems
    from opal_kernels.gem_report import FacetedStone

    from ..addon.translate.materials import gem_spectra
    from ..addon.translate.meshes import read_mesh

    evaluated = obj.evaluated_get(depsgraph)
    materials = [slot.material for slot in evaluated.material_slots]
    gems_of_slots = [material for material in materials if material and material.opal.kind == "GEM"]
    if not gems_of_slots:
        raise ValueError("the stone has no material of the kind Gem")
    arrays = read_mesh(evaluated.data)
    if arrays is None:
        raise ValueError("the stone has no faces")
    slots = arrays.material_slots if arrays.material_slots is not None else np.zeros(1, int)
    used = [materials[slot] for slot in np.unique(np.clip(slots, 0, len(materials) - 1))]
    material = next((m for m in used if m in gems_of_slots), gems_of_slots[0])
    gem = material.opal.gem
    if presets.species_of(gem) == presets.CUSTOM and (sentence := gems.refusal(presets.settings_of(gem))):
        raise ValueError(sentence)
    scale = np.array(evaluated.matrix_world.to_scale())
    positions = arrays.positions.astype(float) * scale * metres
    if not np.isfinite(positions).all() or not (scale != 0).all():
        raise ValueError("the stone is scaled to nothing or has corners that are not finite")
    triangles = arrays.triangles if scale.prod() > 0 else arrays.triangles[:, ::-1]
    index, absorption = gem_spectra(gem, metres)
    others = [m.name if m else "none" for m in used if m != material]
    notes = _left_out(material, others, smooth=arrays.corner_normals is not None)
    return FacetedStone(positions, triangles, index, absorption), notes


def _left_out(material: bpy.types.Material, others: list[str], smooth: bool) -> list[str]:
    """Sentences on what the report does not regard.

    Parameters
    ----------
    others : list of str
        Names of the other materials on the stone's faces.
    smooth : bool
        Whether faces are shaded as parts of a curved surface.
    """
    gem = material.opal.gem
    notes = []
    if gem.roughness > 0:
        notes.append(f"the roughness of “{material.name}” ({gem.roughness:.2f}) is ignored: the stone is judged polished")
    if gem.fresnel != "EXACT":
        notes.append(f"Schlick's approximation of “{material.name}” is ignored: the shares are those of exact Fresnel reflection")
    if material.opal.use_medium:
        notes.append(f"the clouding of “{material.name}” is ignored: the stone is judged clear")
    if others:
        notes.append(f"every face is judged as “{material.name}”, those of other materials ({', '.join(others)}) as well")
    if smooth:
        notes.append("its smooth faces are judged as small flat facets: fire, which compares light through the same facets, means little")
    return notes


class _Work:
    """The report in the making; it touches none of Blender's data."""

    def __init__(self, settings: OPAL_OT_gem_report, stone: Any, title: str, notes: list[str]) -> None:
        self._stone, self.title, self.notes = stone, title, notes
        self._size, self._passes = settings.size, settings.passes
        self._head = 0.5 * settings.head_angle
        self._tilt, self._tilt_steps = math.degrees(settings.tilt), settings.tilt_steps
        self.result: Any = None
        self.page: Any = None
        self.table = ""

    def make(self, told: Callable[[float], bool]) -> None:
        """Measures and draws; ``told`` hears how much is done, and says whether to go on."""
        import numpy as np
        from opal_kernels import gem_report

        def part(start: float, end: float) -> Callable[[float], bool]:
            return lambda done: told(start + (end - start) * done)

        tilts = np.linspace(-self._tilt, self._tilt, self._tilt_steps)
        self.result = gem_report.measure(self._stone, tilts, self._head, progress=part(0.0, 0.3))
        picture = gem_report.face_up(self._stone, self._size, self._passes, self._head, part(0.3, 0.65))
        fire = gem_report.flashes(self._stone, self._size, self._passes, self._head, part(0.65, 1.0))
        self.table = gem_report.table(self.result, self.title, self.notes)
        self.page = gem_report.draw(self.result, picture, fire, self.title, self.notes)


def register() -> None:
    bpy.utils.register_class(OPAL_OT_gem_report)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_gem_report)
