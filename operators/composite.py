# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal's light in a Cycles picture: the base by Cycles, Opal's layers over it, and compositor nodes to tune them by."""

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty

from . import layer_names
from .render_layers import WritesFile


class OPAL_OT_composite(bpy.types.Operator, WritesFile):
    """Composite over Cycles"""

    bl_idname = "opal.composite"
    bl_label = "Composite over Cycles"
    bl_description = "Render this frame by Cycles without caustics and without what Opal renders better, and lay Opal's layers over it"
    bl_options = {"REGISTER", "UNDO"}

    layers: EnumProperty(
        name="Layers",
        description="Which of Opal's layers are laid over the base; what is left out is missing from the picture",
        items=layer_names.ITEMS[:4],
        options={"ENUM_FLAG"},
        default={"CAUSTICS", "GEMS", "MEDIA", "RAINBOW"},
    )
    attenuation: EnumProperty(
        name="Attenuation",
        description="Where media and rain dim what the camera sees through them",
        items=(
            ("LAYER", "Layer", "In a layer that multiplies the base, so that it can be tuned afterwards"),
            ("BASE", "Base", "In the base: Cycles renders the same media as pure absorbers"),
        ),
        default="LAYER",
    )
    samples: IntProperty(
        name="Samples",
        description="Samples of the base; 0 takes what is set for Cycles",
        default=0,
        min=0,
        soft_max=4096,
    )
    use_scene_settings: BoolProperty(
        name="Keep Cycles' Settings",
        description="Render the base with the bounces, clamping, denoising and filter that are set for Cycles instead of those that match "
        "Opal's; caustics are off in any case",
        default=False,
    )
    use_nodes: BoolProperty(
        name="Compositor Nodes",
        description="Build compositor nodes that lay the layers over the base, each with an exposure of its own",
        default=True,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene is not None and not bpy.app.is_job_running("RENDER")

    def execute(self, context: bpy.types.Context) -> set[str]:
        from opal_kernels.binding import OpalError

        from . import compositor, cycles_base, float_images, layers, render_scene

        chosen = set(self.layers) | ({"TRANSMITTANCE"} if self.attenuation == "LAYER" else set())
        try:
            rendered = render_scene.opal(context, layers.passes(chosen))
            with cycles_base.replaced(context.scene, dim_camera=self.attenuation == "BASE"):
                base = render_scene.cycles(context, **self._cycles_settings(context.scene))
            over = layers.pictures(rendered.films, chosen, context.scene.render.film_transparent)
            if base.picture.shape != rendered.picture.shape:
                raise render_scene.RenderFailed("Cycles and Opal gave pictures of different sizes: turn Crop to Render Region on.")
            result = layers.composite(base.picture, over)
            images = {name: float_images.put(layer_names.image_name(name), pixels) for name, pixels in over.items()}
            images["BASE"] = float_images.put("Opal Base", base.picture)
            float_images.put("Opal Composite", result)
            named = {layer_names.LABELS[name].replace(" ", ""): pixels for name, pixels in over.items()}
            told = self.write(context, {"Combined": result, "Base": base.picture, **named})
        except (render_scene.RenderFailed, OpalError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if self.use_nodes:
            _, shown = compositor.build(context.scene, images)
            told += "" if shown else f"; the scene has a compositor of its own: add the group “{compositor.NAME}” there"
        self.report({"INFO"}, f"Base {base.seconds:.1f} s, layers {rendered.seconds:.1f} s, in the image “Opal Composite”" + told)
        return {"FINISHED"}

    def _cycles_settings(self, scene: bpy.types.Scene) -> dict[str, object]:
        from . import cycles_base

        settings = cycles_base.settings(scene)
        if self.use_scene_settings:
            settings = {name: settings[name] for name in ("caustics_reflective", "caustics_refractive")}
        if self.samples:
            settings["samples"] = self.samples
        return settings


def register() -> None:
    bpy.utils.register_class(OPAL_OT_composite)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_composite)
