# SPDX-License-Identifier: GPL-3.0-or-later
"""The same frame by Opal and by Cycles, and what is different between them, in numbers and pictures."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from . import cycles_base, difference_map, float_images, own_images, render_scene
from .changed import Changed
from .compare_cycles import DIFFERENCE, SIDE_BY_SIDE


def cycles_settings(scene: Any, ours: render_scene.Rendered, equal: str, use_scene_settings: bool) -> dict[str, Any]:
    """Settings under which Cycles gets as many samples or as much time; see the operator's properties."""
    settings = {} if use_scene_settings else cycles_base.settings(scene)
    if not use_scene_settings:
        settings |= {"caustics_reflective": True, "caustics_refractive": True}
    if equal == "TIME":
        return {**settings, "samples": 1 << 20, "time_limit": max(0.1, ours.seconds), "use_adaptive_sampling": False}
    return {**settings, "samples": ours.passes * scene.opal.samples_per_pass, "time_limit": 0.0}


def numbers(ours: np.ndarray, theirs: np.ndarray, regions: int) -> dict[str, Any]:
    """What is different between the pictures; with ``regions``, also in so many along each side. Touches nothing of Blender's."""
    from opal_kernels import metrics

    found = metrics.all_of(ours, theirs)
    if found["flip"] is None:
        found["flip_left_out"] = "The package flip_evaluator is not installed."
    if regions:
        found["regions"] = metrics.regions(ours, theirs, regions, regions)
    return found


def describe(scene: Any, ours: Any, theirs: Any, mode: str, equal: str, edited: list[str], found: dict[str, Any]) -> dict[str, Any]:
    """The comparison's numbers with what they are of, ready for JSON."""
    return {
        "scene": scene.name,
        "frame": scene.frame_current,
        "resolution": [ours.picture.shape[1], ours.picture.shape[0]],
        "mode": mode,
        "equal": equal,
        "samples": ours.passes * scene.opal.samples_per_pass,
        "seconds": {"opal": ours.seconds, "cycles": theirs.seconds},
        "memory": {"opal": ours.memory, "cycles": theirs.memory},
        "edited_twins": edited,
        **found,
    }


def show(context: Any, ours: np.ndarray, theirs: np.ndarray, result: dict[str, Any]) -> dict[str, np.ndarray]:
    """Makes the pictures, as Blender images and as display values for files, and opens one."""
    from opal_kernels import metrics

    both = difference_map.side_by_side(ours, theirs)
    limit = result["difference_limit"] = difference_map.limit_of(ours, theirs)
    boxes = [region["box"] for region in result.get("regions", ())]
    difference = difference_map.draw(ours, theirs, limit, boxes)
    owner = own_images.owner_of(context.scene, context.view_layer)
    float_images.put("Opal Comparison", ours, owner, "Opal's picture of the comparison")
    float_images.put("Cycles Comparison", theirs, owner, "Cycles' picture of the comparison")
    image = float_images.put(SIDE_BY_SIDE, both, owner, "Opal left, Cycles right")
    float_images.put(DIFFERENCE, _linear(difference), owner, "Opal less Cycles: red is brighter, blue darker")
    if not bpy.app.background:
        _open(context, image)
    return {"side_by_side": metrics.srgb(both), "difference": difference}


def write(scene: Any, filepath: str, pictures: dict[str, np.ndarray], result: dict[str, Any]) -> str:
    """Writes pictures and numbers; returns what to tell, and raises OpalError where it cannot."""
    from opal_kernels.binding import OpalError

    from ..addon.film_files import with_frame

    stem = Path(with_frame(filepath, scene.frame_current))
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


def bring_twins_up_to_date(scene: Any) -> list[str]:
    """Makes every twin follow, in a scene's units; names of those that were edited by hand."""
    from ..addon import twins

    edited = []
    for owner in twins.worlds_and_materials():
        function = twins.update_world if isinstance(owner, bpy.types.World) else twins.update
        if function(owner, scene=scene) is twins.Result.EDITED:
            edited.append(owner.name_full)
    return edited


def hide_all_but_volumes(changed: Changed, scene: Any) -> None:
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
