# SPDX-License-Identifier: GPL-3.0-or-later
"""A sheet that compares the theories of the rainbow: a picture in Blender, PNG and EXR files, the errors as text."""

import threading
from pathlib import Path
from typing import Any

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty

from . import image_files

_NAME = "Rainbow Chart"


class OPAL_OT_rainbow_chart(bpy.types.Operator):
    """Compare the theories of the rainbow on a sheet"""

    bl_idname = "opal.rainbow_chart"
    bl_label = "Rainbow Chart"
    bl_description = (
        "Draw the bows of all five theories without a scene: strips and Lee diagrams in true colour, curves of luminance and polarisation, "
        "and the errors against Lorenz-Mie theory in numbers"
    )
    bl_options = {"REGISTER", "UNDO"}

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

    _timer: Any = None
    _work: Any = None

    def execute(self, context: bpy.types.Context) -> set[str]:
        work = _Work(self)
        work.run()
        return self._finish(context, work)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._work = _Work(self)
        self._work.start()
        manager = context.window_manager
        manager.progress_begin(0, 100)
        self._timer = manager.event_timer_add(0.1, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC":
            self._work.stopping = True
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self._work.is_alive():
            context.window_manager.progress_update(int(100 * self._work.done))
            if context.workspace is not None:
                context.workspace.status_text_set(f"Rainbow chart: {self._work.done:.0%}, Esc to stop")
            return {"RUNNING_MODAL"}
        self._end(context)
        return self._finish(context, self._work)

    def cancel(self, context: bpy.types.Context) -> None:
        self._work.stopping = True
        self._work.join()
        self._end(context)

    def _end(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        if context.workspace is not None:
            context.workspace.status_text_set(None)

    def _finish(self, _context: bpy.types.Context, work: Any) -> set[str]:
        if work.sentence:
            self.report({"ERROR"}, work.sentence)
            return {"CANCELLED"}
        if work.pixels is None:
            self.report({"INFO"}, "The chart was stopped.")
            return {"CANCELLED"}
        image = image_files.to_image(_NAME, work.pixels)
        text = image_files.to_text(_NAME, work.table + "\n")
        written = []
        if self.filepath:
            path = Path(bpy.path.abspath(self.filepath)).with_suffix("")
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                written.append(_save_png(path.with_suffix(".png"), work.pixels))
                if self.use_exr:
                    written.append(_save(image, path.with_suffix(".exr"), "OPEN_EXR"))
            except (OSError, RuntimeError) as error:
                self.report({"ERROR"}, f"The chart stays in Blender: {path.with_suffix('.png')} cannot be written ({error}).")
                return {"FINISHED"}
        where = f", written to {' and '.join(written)}" if written else ""
        self.report({"INFO"}, f"The chart is the image “{image.name}”, its numbers the text “{text.name}”{where}.")
        return {"FINISHED"}


class _Work(threading.Thread):
    """The computation; it can run in the operator's own thread or beside Blender's."""

    def __init__(self, settings: OPAL_OT_rainbow_chart) -> None:
        super().__init__(name="Opal chart", daemon=True)
        self._arguments = (settings.radius * 1000.0, settings.spread, settings.largest * 1000.0, settings.rows)
        self.stopping = False
        self.done = 0.0
        self.pixels: Any = None
        self.table = ""
        self.sentence = ""

    def _told(self, done: float) -> bool:
        self.done = done
        return not self.stopping

    def run(self) -> None:
        from opal_kernels.charts import rainbow_chart, rainbow_data
        from opal_kernels.optics.rainbow import Cancelled

        try:
            sheet = rainbow_data.compute(*self._arguments, progress=self._told)
            self.table = rainbow_data.table(sheet)
            self.pixels = rainbow_chart.draw(sheet)
        except Cancelled:
            pass
        except (ValueError, MemoryError) as error:
            self.sentence = str(error) or "There is not enough memory for the chart."


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
