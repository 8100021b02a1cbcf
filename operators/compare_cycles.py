# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that renders the same frame by Opal and by Cycles; `comparison` says what is different between them."""

import json

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from .job import Aside, Steps
from .render_layers import RendersFrame

# Custom property of the scene that holds the last comparison.
KEY = "opal_comparison"
SIDE_BY_SIDE, DIFFERENCE = "Opal Side by Side", "Opal Difference"


class OPAL_OT_compare_cycles(bpy.types.Operator, RendersFrame):
    """Compare with Cycles"""

    bl_idname = "opal.compare_cycles"
    bl_label = "Compare with Cycles"
    bl_description = (
        "Render this frame by both engines with the same camera and light, Opal's materials by their twins, and measure the difference"
    )
    bl_options = {"UNDO"}
    parts = 2

    mode: EnumProperty(
        name="Compare",
        description="What of the scene is compared",
        items=(
            ("SCENE", "Scene", "Everything, as it is"),
            ("VOLUMES", "Volumes", "Media and rain alone, region by region; everything else is hidden meanwhile"),
        ),
        default="SCENE",
    )
    equal: EnumProperty(
        name="Equal",
        description="What both engines get the same amount of",
        items=(
            ("SAMPLES", "Samples", "As many camera paths a pixel as Opal renders"),
            ("TIME", "Time", "As many seconds as Opal takes"),
        ),
        default="SAMPLES",
    )
    use_scene_settings: BoolProperty(
        name="Keep Cycles' Settings",
        description="Render with the bounces, clamping, denoising and filter that are set for Cycles instead of those that match Opal's",
        default=False,
    )
    regions: IntProperty(name="Regions", description="Regions along each side of the picture, for volumes", default=4, min=1, max=32)
    use_file: BoolProperty(name="Write Files", description="Also write the pictures as PNG and the numbers as JSON", default=False)
    filepath: StringProperty(
        name="File",
        description="Beginning of the files' names; # stands for a digit of the frame number",
        default="//opal_comparison_####",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )

    def steps(self, context: bpy.types.Context) -> Steps:
        from opal_kernels.binding import OpalError

        from . import comparison, render_scene
        from .changed import Changed

        scene = context.scene
        try:
            edited = comparison.bring_twins_up_to_date(scene)
            with Changed() as changed:
                if not self.use_scene_settings:
                    # A denoiser shifts means: what is compared is what the engines have rendered.
                    changed.set(context.scene.opal, denoise=False)
                if self.equal == "SAMPLES":
                    changed.set(context.scene.opal, use_adaptive_sampling=False)
                if self.mode == "VOLUMES":
                    comparison.hide_all_but_volumes(changed, scene)
                ours = yield from render_scene.opal(context)
                settings = comparison.cycles_settings(scene, ours, self.equal, self.use_scene_settings)
                theirs = yield from render_scene.cycles(context, **settings)
            if ours.picture.shape != theirs.picture.shape:
                raise render_scene.RenderFailed("Cycles and Opal gave pictures of different sizes: turn Crop to Render Region on.")
            regions = self.regions if self.mode == "VOLUMES" else 0
            numbers = yield Aside(lambda _told: comparison.numbers(ours.picture, theirs.picture, regions), "Measuring", owns_all=True)
            result = comparison.describe(scene, ours, theirs, self.mode, self.equal, edited, numbers)
            pictures = comparison.show(context, ours.picture, theirs.picture, result)
            told = comparison.write(scene, self.filepath, pictures, result) if self.use_file else ""
        except (render_scene.RenderFailed, OpalError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        scene[KEY] = json.dumps(result)
        if edited:
            self.report({"WARNING"}, "Node trees edited by hand were compared as they are: " + ", ".join(edited))
        self.report({"INFO"}, comparison.sentence(result) + told)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(OPAL_OT_compare_cycles)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_compare_cycles)
