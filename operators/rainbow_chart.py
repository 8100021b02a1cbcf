# SPDX-License-Identifier: GPL-3.0-or-later
"""A sheet that compares the theories of the rainbow: a picture in Blender, PNG and EXR files, the errors as text."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty

from . import image_files
from .job import Aside, Steps
from .long_job import LongJob

_NAME = "Rainbow Chart"


class OPAL_OT_rainbow_chart(bpy.types.Operator, LongJob):
    """Compare the theories of the rainbow on a sheet"""

    bl_idname = "opal.rainbow_chart"
    bl_label = "Rainbow Chart"
    bl_description = (
        "Draw the bows of all five theories without a scene: strips and Lee diagrams in true colour, curves of luminance and polarisation, "
        "and the errors against Lorenz-Mie theory in numbers"
    )
    bl_options = {"UNDO"}

    filepath: StringProperty(
        name="File",
        description="Where the sheet is written as PNG and, beside it, as EXR; empty keeps it in Blender alone",
        default="",
        subtype="FILE_PATH",
    )
    radius: FloatProperty(name="Radius", description="Mean radius of the drops in millimetres", default=0.25, soft_min=0.01, soft_max=1.0)
    spread: FloatProperty(name="Spread", description="Width of the distribution of radii relative to the mean", default=0.05, soft_max=1.0)
    largest: FloatProperty(
        name="Largest Radius", description="Largest drops of the Lee diagrams in millimetres", default=0.5, soft_min=0.05, soft_max=1.0
    )
    rows: IntProperty(name="Sizes", description="How many drop sizes a Lee diagram has", default=32, min=2, soft_max=128)
    use_exr: BoolProperty(
        name="EXR", description="Also write the colours as they are, those that no screen can show included", default=True
    )

    def steps(self, context: bpy.types.Context) -> Steps:
        arguments = (self.radius * 1000.0, self.spread, self.largest * 1000.0, self.rows)
        try:
            pixels, table = yield Aside(lambda told: _drawn(arguments, told), "")
        except (ValueError, MemoryError) as error:
            self.report({"ERROR"}, str(error) or "There is not enough memory for the chart.")
            return {"CANCELLED"}
        image = image_files.to_image(_NAME, pixels)
        text = image_files.to_text(_NAME, table + "\n")
        written = []
        if self.filepath:
            path = Path(bpy.path.abspath(self.filepath)).with_suffix("")
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                written.append(_save_png(path.with_suffix(".png"), pixels))
                if self.use_exr:
                    written.append(_save(image, path.with_suffix(".exr"), "OPEN_EXR"))
            except (OSError, RuntimeError) as error:
                self.report({"ERROR"}, f"The chart stays in Blender: {path.with_suffix('.png')} cannot be written ({error}).")
                return {"FINISHED"}
        where = f", written to {' and '.join(written)}" if written else ""
        self.report({"INFO"}, f"The chart is the image “{image.name}”, its numbers the text “{text.name}”{where}.")
        return {"FINISHED"}


def _drawn(arguments: tuple[Any, ...], told: Callable[[float], bool]) -> tuple[Any, str]:
    """The sheet and its numbers; touches nothing of Blender's."""
    from opal_kernels.charts import rainbow_chart, rainbow_data

    sheet = rainbow_data.compute(*arguments, progress=told)
    return rainbow_chart.draw(sheet), rainbow_data.table(sheet)


def _save_png(path: Path, pixels: Any) -> str:
    import numpy as np
    from opal_kernels.charts.rainbow_chart import encode

    height, width = pixels.shape[:2]
    image = bpy.data.images.new(path.stem, width, height, alpha=False)
    try:
        flat = np.ones((height, width, 4), np.float32)
        flat[..., :3] = encode(pixels)[::-1]
        image.pixels.foreach_set(flat.reshape(-1))
        return _save(image, path, "PNG")
    finally:
        bpy.data.images.remove(image)


def _save(image: bpy.types.Image, path: Path, file_format: str) -> str:
    before = image.filepath_raw
    image.file_format = file_format
    image.filepath_raw = str(path)
    try:
        image.save()
    finally:
        image.filepath_raw = before
    return str(path)


def register() -> None:
    bpy.utils.register_class(OPAL_OT_rainbow_chart)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_rainbow_chart)
