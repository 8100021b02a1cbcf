# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders of the current frame by either engine, as Blender renders it, given back as arrays.

Pictures are (height, width, 4) float32, scene-linear, premultiplied, rows from the bottom up.
"""

from __future__ import annotations

import tempfile
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from .changed import Changed


class RenderFailed(Exception):
    """Blender or an engine could not render; the message is one sentence."""


@dataclass
class Rendered:
    """A render and what it took.

    Attributes
    ----------
    films : dict
        Of Opal: by `opal_kernels.descriptions.Pass`.
    seconds : float
        From the call to its end, translation included.
    memory : int
        By how many bytes the process grew at most while rendering.
    passes : int
        Of Opal: passes done.
    """

    picture: np.ndarray
    seconds: float
    memory: int
    films: dict[Any, np.ndarray] = field(default_factory=dict)
    passes: int = 0


def opal(context: Any, passes: Sequence[Any] = ()) -> Rendered:
    """Renders the scene's active view layer by Opal; ``passes`` are kept beside Combined.

    Raises
    ------
    RenderFailed
        With the engine's own sentence.
    """
    from opal_kernels.descriptions import Pass

    from ..addon import capture

    with Changed() as changed, capture.capturing(passes) as captured:
        _only(changed, context)
        changed.set(context.scene.render, engine="OPAL")
        seconds, memory = _render(context, changed)
    layer = context.view_layer.name
    if captured.failure:
        raise RenderFailed(captured.failure)
    if captured.stopped or layer not in captured.films:
        raise RenderFailed("The render was stopped.")
    films = captured.films[layer]
    return Rendered(films[Pass.COMBINED], seconds, memory, films, captured.passes_done[layer])


def cycles(context: Any, **settings: Any) -> Rendered:
    """Renders the scene's active view layer by Cycles; ``settings`` are set on `scene.cycles` meanwhile.

    Raises
    ------
    RenderFailed
        If there is no Cycles, or it gives no picture.
    """
    scene = context.scene
    if not hasattr(scene, "cycles"):
        raise RenderFailed("The add-on Cycles Render Engine is not enabled, and this needs it.")
    with Changed() as changed:
        _only(changed, context)
        changed.set(scene.render, engine="CYCLES")
        device = scene.cycles.device
        if device != "CPU" and not _has_gpu(context):
            settings.setdefault("device", "CPU")
        changed.set(scene.cycles, **settings)
        folder = Path(tempfile.mkdtemp(prefix="opal-", dir=bpy.app.tempdir or None))
        path = folder / "cycles.exr"
        image_settings = scene.render.image_settings
        changed.set(image_settings, media_type="IMAGE")
        changed.set(image_settings, file_format="OPEN_EXR")
        changed.set(image_settings, color_mode="RGBA", color_depth="32", exr_codec="ZIP", color_management="FOLLOW_SCENE")
        changed.set(scene.render, filepath=str(path), use_file_extension=False)
        try:
            seconds, memory = _render(context, changed, write_still=True)
            if not path.exists():
                raise RenderFailed("Cycles gave no picture.")
            return Rendered(_read(path), seconds, memory)
        finally:
            path.unlink(missing_ok=True)
            folder.rmdir()


def _only(changed: Changed, context: Any) -> None:
    """One view layer and the plain picture: no compositor, no sequencer, no border cropping surprises."""
    scene = context.scene
    for layer in scene.view_layers:
        changed.set(layer, use=layer.name == context.view_layer.name)
    changed.set(scene.render, use_compositing=False, use_sequencer=False, use_multiview=False)


def _has_gpu(context: Any) -> bool:
    """Whether Cycles would find a device other than the processor."""
    addon = context.preferences.addons.get("cycles")
    try:
        return addon is not None and addon.preferences.has_active_device()
    except Exception:
        return False


def _render(context: Any, changed: Changed, write_still: bool = False) -> tuple[float, int]:
    meter = _Meter()
    begun = time.perf_counter()
    meter.start()
    try:
        bpy.ops.render.render(write_still=write_still, scene=context.scene.name)
    except RuntimeError as error:
        sentence = str(error).strip().removeprefix("Error: ").splitlines()
        raise RenderFailed(sentence[0] if sentence else "The render failed.") from None
    finally:
        memory = meter.stop()
    return time.perf_counter() - begun, memory


def _read(path: Path) -> np.ndarray:
    image = bpy.data.images.load(str(path), check_existing=False)
    try:
        width, height = image.size
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        return pixels.reshape(height, width, -1)
    finally:
        bpy.data.images.remove(image)


class _Meter(threading.Thread):
    """How much the process grows while it runs; 0 where the system does not say."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self._ended = threading.Event()
        self._first = self._most = self._resident()

    @staticmethod
    def _resident() -> int:
        try:
            with open("/proc/self/statm", encoding="ascii") as numbers:
                return int(numbers.read().split()[1]) * 4096
        except OSError:
            return 0

    def run(self) -> None:
        while not self._ended.wait(0.02):
            self._most = max(self._most, self._resident())

    def stop(self) -> int:
        self._ended.set()
        self.join()
        return max(0, self._most - self._first)
