# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a render's film is written, and what tells one picture's films from another's."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy
from opal_kernels.binding import OpalError
from opal_kernels.descriptions import RenderSettings

# Settings that do not change the picture, or that the film says itself.
_LEFT_OUT = {"threads", "passes"}


def with_frame(path: str, frame: int) -> str:
    """A path with its # replaced by the frame's digits.

    Raises
    ------
    OpalError
        If it is relative to a file that was never saved: Blender would write it into the folder that it was started from.
    """
    if path.startswith("//") and not bpy.data.filepath:
        raise OpalError(f"Save the file first: “{path}” is relative to it.")
    return re.sub(r"#+", lambda run: f"{frame:0{len(run.group())}d}", bpy.path.abspath(path))


def path_of(scene: Any, layer: str, passes: Sequence[int], suffix: str = "") -> Path:
    """Where a film goes: the scene's film path, the layer where there are several, the view's suffix, and the passes, counted from 1."""
    path = with_frame(scene.opal.film_path, scene.frame_current)
    stem = path[:-4] if path.lower().endswith(".npz") else path
    if len(scene.view_layers) > 1:
        stem += f"_{bpy.path.clean_name(layer)}"
    return Path(f"{stem}{suffix}_{min(passes) + 1:04d}-{max(passes) + 1:04d}.npz")


def info_of(name: str, scene: Any, layer: str, settings: RenderSettings, view: str = "") -> dict[str, Any]:
    """What has to agree between films that are merged, in JSON's types."""
    values = {key: value for key, value in dataclasses.asdict(settings).items() if key not in _LEFT_OUT}
    values = {key: list(value) if isinstance(value, tuple) else value for key, value in values.items()}
    if view:
        layer = f"{layer} {view}"
    return {"scene": name, "frame": scene.frame_current, "layer": layer, **values}
