# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal's light in a Cycles picture: the base by Cycles, Opal's layers over it, and compositor nodes to tune them by."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty

from . import layer_names
from .job import Steps
from .render_layers import RendersFrame, WritesFile


class OPAL_OT_composite(bpy.types.Operator, RendersFrame, WritesFile):
    """Composite over Cycles"""

    bl_idname = "opal.composite"
    bl_label = "Composite over Cycles"
    bl_description = "Render this frame by Cycles without caustics and without what Opal renders better, and lay Opal's layers over it"
    bl_options = {"UNDO"}
    parts = 2

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
        description="Build a group of compositor nodes that lay the layers over the base, each with an exposure of its own",
        default=True,
    )
    show_in_compositor: BoolProperty(
        name="Show in the Scene's Compositor",
        description="Make the group the scene's compositor where there is none: every later render then shows this still, tuned, instead of "
        "what it renders",
        default=False,
    )

    def steps(self, context: bpy.types.Context) -> Steps:
        from opal_kernels.binding import OpalError

        from . import cycles_base, float_images, layers, own_images, render_scene

        chosen = set(self.layers) | ({"TRANSMITTANCE"} if self.attenuation == "LAYER" else set())
        try:
            rendered = yield from render_scene.opal(context, layers.passes(chosen))
            with cycles_base.replaced(context.scene, dim_camera=self.attenuation == "BASE"):
                base = yield from render_scene.cycles(context, **self._cycles_settings(context.scene))
            over = layers.pictures(rendered.films, chosen, context.scene.render.film_transparent)
            if base.picture.shape != rendered.picture.shape:
                raise render_scene.RenderFailed("Cycles and Opal gave pictures of different sizes: turn Crop to Render Region on.")
            result = layers.composite(base.picture, over)
            owner = own_images.owner_of(context.scene, context.view_layer)
            images = {name: float_images.put(layer_names.image_name(name), pixels, owner) for name, pixels in over.items()}
            images["BASE"] = float_images.put("Opal Base", base.picture, owner)
            whole = float_images.put("Opal Composite", result, owner)
            named = {layer_names.LABELS[name].replace(" ", ""): pixels for name, pixels in over.items()}
            told = self.write(context, {"Combined": result, "Base": base.picture, **named})
        except (render_scene.RenderFailed, OpalError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if bpy.app.version < (5, 0) and context.scene.world is not None and context.scene.world.opal.kind != "NONE":
            # Cycles 4.5 marches such a world to a sun in steps as long as the way over their greatest number: past all of the haze.
            told += "; under this world's haze Cycles of Blender 4.5 does not dim the sun, so that the ground of its base is too bright"
        if self.use_nodes:
            told += self._build_nodes(context.scene, images, owner)
        self.report({"INFO"}, f"Base {base.seconds:.1f} s, layers {rendered.seconds:.1f} s, in the image “{whole.name}”" + told)
        return {"FINISHED"}

    def _build_nodes(self, scene: bpy.types.Scene, images: dict[str, Any], owner: str) -> str:
        """Builds the compositor's group; returns what to tell of it."""
        from . import compositor

        group = compositor.build(images, owner)
        if not self.show_in_compositor:
            return f"; to tune it, use the node group “{group.name}” in the compositor"
        if not compositor.show(scene, group):
            return f"; the scene has a compositor of its own: add the group “{group.name}” there"
        return f"; every render now shows this still of frame {scene.frame_current}, until “{group.name}” leaves the compositor"

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
