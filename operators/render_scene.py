# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders of the current frame by either engine, as Blender renders it, given back as arrays: parts of a job (`job`).

Pictures are (height, width, 4) float32, scene-linear, premultiplied, rows from the bottom up.
"""

from __future__ import annotations

import re
import shutil
import tempfile
import threading
import time
from collections.abc import Callable, Generator, Sequence
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


Rendering = Generator[Any, Any, Rendered]


def opal(context: Any, passes: Sequence[Any] = ()) -> Rendering:
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
        layer = context.view_layer.name
        seconds, memory = yield BlenderRender(context.scene, "Opal", lambda _words, _seconds: captured.done)
    if captured.failure:
        raise RenderFailed(captured.failure)
    if captured.stopped or layer not in captured.films:
        raise RenderFailed("The render was stopped.")
    films = captured.films[layer]
    return Rendered(films[Pass.COMBINED], seconds, memory, films, captured.passes_done[layer])


def cycles(context: Any, **settings: Any) -> Rendering:
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
        changed.keep(image_settings, "color_depth", "color_mode", "exr_codec")  # they follow the format
        changed.set(image_settings, media_type="IMAGE")
        changed.set(image_settings, file_format="OPEN_EXR")
        changed.set(image_settings, color_mode="RGBA", color_depth="32", exr_codec="ZIP", color_management="FOLLOW_SCENE")
        changed.set(scene.render, filepath=str(path), use_file_extension=False)
        try:
            limit = settings.get("time_limit", 0.0)
            seconds, memory = yield BlenderRender(scene, "Cycles", lambda words, now: _cycles_done(words, now, limit), write_still=True)
            if not path.exists():
                raise RenderFailed("Cycles gave no picture.")
            return Rendered(_read(path), seconds, memory)
        finally:
            shutil.rmtree(folder, ignore_errors=True)


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


def _cycles_done(words: str, seconds: float, limit: float) -> float:
    """How far Cycles is by what it says, (“… | Sample 3/64”), or by its time."""
    by_time = min(1.0, seconds / limit) if limit else 0.0
    found = re.search(r"Sample (\d+)/(\d+)", words)
    return max(by_time, int(found[1]) / max(1, int(found[2]))) if found else by_time


class BlenderRender:
    """A render by Blender as a step of a job; it gives its seconds and by how many bytes the process grew.

    Parameters
    ----------
    scene : bpy.types.Scene
        Rendered by its own engine.
    engine : str
        Its name, for the person.
    done : callable
        From the engine's last words and the seconds since the beginning to the part that is done.
    """

    def __init__(self, scene: Any, engine: str, done: Callable[[str, float], float], write_still: bool = False) -> None:
        self._scene, self._engine, self._done = scene, engine, done
        self._arguments = {"write_still": write_still, "scene": scene.name}
        self._said = ""
        self._handlers = ((bpy.app.handlers.render_stats, self._on_words), (bpy.app.handlers.render_cancel, self._on_cancel))
        self.stopped = False
        self.result: Any = None
        self.failure: Exception | None = None

    def run(self) -> None:
        self._start()
        try:
            bpy.ops.render.render(**self._arguments)
        except RuntimeError as error:
            self._fail(str(error))

    def begin(self) -> None:
        """Begins the render beside the interface, which Blender locks meanwhile: what the job has changed is not for editing."""
        self._start()
        for handlers, function in self._handlers:
            handlers.append(function)
        preferences = bpy.context.preferences
        was_dirty = preferences.is_dirty
        try:
            with Changed() as changed:
                # Both are looked at by the call only.
                changed.set(preferences.view, render_display_type="NONE")
                changed.set(self._scene.render, use_lock_interface=True)
                if "CANCELLED" in bpy.ops.render.render("INVOKE_DEFAULT", **self._arguments):
                    self._fail("Blender did not start the render: it renders something else.")
        except RuntimeError as error:
            self._fail(str(error))
        finally:
            preferences.is_dirty = was_dirty

    def runs(self) -> bool:
        return bpy.app.is_job_running("RENDER")

    def stop(self) -> None:
        """Blender itself hears Escape wherever a render is; there is no other way to stop one."""

    def end(self) -> None:
        for handlers, function in self._handlers:
            if function in handlers:
                handlers.remove(function)
        self.result = time.perf_counter() - self._begun, self._meter.stop()

    def _start(self) -> None:
        self._meter = _Meter()
        self._begun = time.perf_counter()
        self._meter.start()

    def _fail(self, text: str) -> None:
        sentence = text.strip().removeprefix("Error: ").splitlines()
        self.failure = RenderFailed(sentence[0] if sentence else "The render failed.")

    def _on_words(self, words: Any, *_: Any) -> None:
        self._said = str(words)

    def _on_cancel(self, *_: Any) -> None:
        self.stopped = True

    @property
    def words(self) -> str:
        return f"{self._engine} | {self._said}" if self._said else self._engine

    @property
    def done(self) -> float:
        return self._done(self._said, time.perf_counter() - self._begun)


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
