# SPDX-License-Identifier: GPL-3.0-or-later
"""The same frame by Opal and by Cycles, and what is different between them, in numbers and pictures."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from . import cycles_base, difference_map, float_images, render_scene
from .changed import Changed

# Custom property of the scene that holds the last comparison.
KEY = "opal_comparison"
SIDE_BY_SIDE, DIFFERENCE = "Opal Side by Side", "Opal Difference"


class OPAL_OT_compare_cycles(bpy.types.Operator):
    """Compare with Cycles"""

    bl_idname = "opal.compare_cycles"
    bl_label = "Compare with Cycles"
    bl_description = (
        "Render this frame by both engines with the same camera and light, Opal's materials by their twins, and measure the difference"
    )
    bl_options = {"REGISTER"}

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

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene is not None and not bpy.app.is_job_running("RENDER")

    def execute(self, context: bpy.types.Context) -> set[str]:
        from opal_kernels.binding import OpalError

        try:
            edited = _bring_twins_up_to_date()
            with Changed() as changed:
                if self.equal == "SAMPLES":
                    changed.set(context.scene.opal, use_adaptive_sampling=False)
                if self.mode == "VOLUMES":
                    _hide_all_but_volumes(changed, context.scene)
                ours = render_scene.opal(context)
                theirs = render_scene.cycles(context, **self._cycles_settings(context.scene, ours))
            if ours.picture.shape != theirs.picture.shape:
                raise render_scene.RenderFailed("Cycles and Opal gave pictures of different sizes: turn Crop to Render Region on.")
            result = self._measure(context.scene, ours, theirs, edited)
            pictures = self._show(context, ours.picture, theirs.picture, result)
            told = self._write(context.scene, pictures, result)
        except (render_scene.RenderFailed, OpalError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.scene[KEY] = json.dumps(result)
        if edited:
            self.report({"WARNING"}, "Node trees edited by hand were compared as they are: " + ", ".join(edited))
        self.report({"INFO"}, sentence(result) + told)
        return {"FINISHED"}

    def _cycles_settings(self, scene: Any, ours: render_scene.Rendered) -> dict[str, Any]:
        settings = {} if self.use_scene_settings else cycles_base.settings(scene)
        if not self.use_scene_settings:
            settings |= {"caustics_reflective": True, "caustics_refractive": True}
        if self.equal == "TIME":
            return {**settings, "samples": 1 << 20, "time_limit": max(0.1, ours.seconds), "use_adaptive_sampling": False}
        return {**settings, "samples": ours.passes * scene.opal.samples_per_pass, "time_limit": 0.0}

    def _measure(self, scene: Any, ours: Any, theirs: Any, edited: list[str]) -> dict[str, Any]:
        from opal_kernels import metrics

        result = {
            "scene": scene.name,
            "frame": scene.frame_current,
            "resolution": [ours.picture.shape[1], ours.picture.shape[0]],
            "mode": self.mode,
            "equal": self.equal,
            "samples": ours.passes * scene.opal.samples_per_pass,
            "seconds": {"opal": ours.seconds, "cycles": theirs.seconds},
            "memory": {"opal": ours.memory, "cycles": theirs.memory},
            "edited_twins": edited,
            **metrics.all_of(ours.picture, theirs.picture),
        }
        if result["flip"] is None:
            result["flip_left_out"] = "The package flip_evaluator is not installed."
        if self.mode == "VOLUMES":
            result["regions"] = metrics.regions(ours.picture, theirs.picture, self.regions, self.regions)
        return result

    def _show(self, context: Any, ours: np.ndarray, theirs: np.ndarray, result: dict[str, Any]) -> dict[str, np.ndarray]:
        from opal_kernels import metrics

        both = difference_map.side_by_side(ours, theirs)
        limit = result["difference_limit"] = difference_map.limit_of(ours, theirs)
        boxes = [region["box"] for region in result.get("regions", ())]
        difference = difference_map.draw(ours, theirs, limit, boxes)
        float_images.put("Opal Comparison", ours, "Opal's picture of the comparison")
        float_images.put("Cycles Comparison", theirs, "Cycles' picture of the comparison")
        image = float_images.put(SIDE_BY_SIDE, both, "Opal left, Cycles right")
        float_images.put(DIFFERENCE, _linear(difference), "Opal less Cycles: red is brighter, blue darker")
        if not bpy.app.background:
            _open(context, image)
        return {"side_by_side": metrics.srgb(both), "difference": difference}

    def _write(self, scene: Any, pictures: dict[str, np.ndarray], result: dict[str, Any]) -> str:
        if not self.use_file:
            return ""
        from opal_kernels.binding import OpalError

        from ..addon.film_files import with_frame

        if self.filepath.startswith("//") and not bpy.data.filepath:
            raise OpalError(f"Save the file first: “{self.filepath}” is relative to it.")
        stem = Path(with_frame(self.filepath, scene.frame_current))
        try:
            stem.parent.mkdir(parents=True, exist_ok=True)
            stem.with_name(stem.name + ".json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
        except OSError as error:
            raise OpalError(f"The comparison {stem}.json cannot be written: {error.strerror or error}.") from error
        for name, picture in pictures.items():
            float_images.write_png(stem.with_name(f"{stem.name}_{name}.png"), picture)
        return f"; written to {stem}…"


def sentence(result: dict[str, Any]) -> str:
    """A comparison in one line."""
    ratio = " ".join("-" if r is None else f"{r:.4f}" for r in result["mean_ratio"])
    text = f"Mean ratio {ratio}, relative MSE {result['relative_mse']:.3g}"
    if regions := [r for r in result.get("regions", ()) if r["ratio"] is not None]:
        worst = max(regions, key=lambda r: abs(math.log(max(r["ratio"], 1e-6))))
        text += f", worst of {len(regions)} regions {worst['ratio']:.4f} ± {worst['error']:.4f}"
    return text + f"; Opal {result['seconds']['opal']:.1f} s, Cycles {result['seconds']['cycles']:.1f} s"


def _bring_twins_up_to_date() -> list[str]:
    """Makes every twin follow; names of those that were edited by hand."""
    from ..addon import twins

    edited = []
    for owner in twins.worlds_and_materials():
        function = twins.update_world if isinstance(owner, bpy.types.World) else twins.update
        if function(owner) is twins.Result.EDITED:
            edited.append(owner.name_full)
    return edited


def _hide_all_but_volumes(changed: Changed, scene: Any) -> None:
    shown = 0
    for obj in scene.objects:
        materials = [slot.material for slot in getattr(obj, "material_slots", ()) if slot.material]
        if obj.type == "VOLUME" or any(material.opal.kind in {"MEDIUM", "RAINBOW"} for material in materials):
            shown += not obj.hide_render
        elif obj.type not in {"LIGHT", "CAMERA", "EMPTY"}:
            changed.set(obj, hide_render=True)
    filled = scene.world is not None and scene.world.opal.kind in {"MEDIUM", "RAINBOW"}
    if not shown and not filled:
        raise render_scene.RenderFailed(f"The scene “{scene.name}” has no medium and no rain to compare.")


def _linear(display: np.ndarray) -> np.ndarray:
    """Scene-linear values that are shown as these under the view transform Standard."""
    low = display / 12.92
    linear = np.where(display <= 0.04045, low, ((display + 0.055) / 1.055) ** 2.4)
    linear[..., 3] = display[..., 3]
    return linear


def _open(context: Any, image: Any) -> None:
    """Shows an image where there is an image editor, else in a new window."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = image
                return
    bpy.ops.wm.window_new()
    area = context.window_manager.windows[-1].screen.areas[0]
    area.type = "IMAGE_EDITOR"
    area.spaces.active.image = image


def register() -> None:
    bpy.utils.register_class(OPAL_OT_compare_cycles)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_compare_cycles)
