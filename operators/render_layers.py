# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders Opal's layers of the current frame into float images and, by choice, into a multilayer OpenEXR file."""

from pathlib import Path
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from . import layer_names
from .job import Steps
from .long_job import LongJob, refusal


class RendersFrame(LongJob):
    """What operators share that render the current frame: one at a time, with the scene changed meanwhile."""

    holds_scene = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if bpy.app.is_job_running("RENDER"):
            cls.poll_message_set(refusal() or "Blender is rendering: wait for its end, or stop it with Esc.")
            return False
        return context.scene is not None


class WritesFile:
    """What operators that write a multilayer file share."""

    use_file: BoolProperty(
        name="Multilayer EXR",
        description="Also write the pictures as layers of one OpenEXR file",
        default=False,
    )
    filepath: StringProperty(
        name="File",
        description="Where the multilayer file is written; # stands for a digit of the frame number",
        default="//opal_layers_####.exr",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )

    def write(self, context: Any, pictures: dict[str, Any]) -> str:
        """Writes the file if asked to; returns what to tell, and raises OpalError where it cannot."""
        if not self.use_file:
            return ""
        from ..addon.film_files import with_frame
        from . import float_images

        path = with_frame(self.filepath, context.scene.frame_current)
        path = Path(path if path.lower().endswith(".exr") else path + ".exr")
        if path.exists() and not context.scene.render.use_overwrite:
            return f"; {path.name} exists and is kept, because Overwrite is off"
        float_images.write_layers(path, {context.view_layer.name: pictures})
        return f"; written to {path}"


class OPAL_OT_render_layers(bpy.types.Operator, RendersFrame, WritesFile):
    """Render Opal's layers"""

    bl_idname = "opal.render_layers"
    bl_label = "Render Layers"
    bl_description = "Render Opal's layers of this frame into images, to be laid over a picture by another engine"
    bl_options = {"UNDO"}

    layers: EnumProperty(
        name="Layers",
        description="Which layers are rendered",
        items=layer_names.ITEMS,
        options={"ENUM_FLAG"},
        default={"CAUSTICS", "GEMS", "MEDIA", "RAINBOW", "TRANSMITTANCE"},
    )

    def steps(self, context: bpy.types.Context) -> Steps:
        from opal_kernels.binding import OpalError

        from . import float_images, layers, own_images, render_scene

        if not self.layers:
            self.report({"ERROR"}, "No layer is chosen.")
            return {"CANCELLED"}
        try:
            rendered = yield from render_scene.opal(context, layers.passes(self.layers))
            found = layers.pictures(rendered.films, self.layers, context.scene.render.film_transparent)
            owner = own_images.owner_of(context.scene, context.view_layer)
            for identifier, pixels in found.items():
                float_images.put(layer_names.image_name(identifier), pixels, owner)
            told = self.write(context, {layer_names.LABELS[name].replace(" ", ""): pixels for name, pixels in found.items()})
        except (render_scene.RenderFailed, OpalError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{len(found)} layers in {rendered.seconds:.1f} s" + told)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(OPAL_OT_render_layers)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_render_layers)
