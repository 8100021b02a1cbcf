# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered 3D view: a progressive render of what the view shows, restarted when the scene or the view changes.

A thread renders passes, first one with coarse pixels, and asks Blender to redraw after each; drawing shows the newest
finished picture. The thread touches only the kernels' scene, never Blender's data.
"""

from __future__ import annotations

import os
import threading
from dataclasses import replace
from typing import Any

import gpu
import numpy as np
from gpu_extras.presets import draw_texture_2d
from opal_kernels.binding import Cancelled, OpalError
from opal_kernels.descriptions import Camera, Pass, RenderSettings
from opal_kernels.render import Render
from opal_kernels.scene import Scene

from . import report, settings
from .translate.camera import camera_from_view
from .translate.scene_builder import SceneBuilder

# Pixels of the first pass are this many of the region's wide, so that something is seen at once.
_COARSE = 4


class Viewport:
    """What one 3D view shows.

    Parameters
    ----------
    engine : OpalRenderEngine
        Asked to redraw after each pass.
    """

    def __init__(self, engine: Any) -> None:
        self._engine = engine
        self._scene: Scene | None = None
        self._worker: _Worker | None = None
        self._shown: tuple[Any, ...] | None = None
        self._texture: Any = None
        self._texture_of: np.ndarray | None = None

    def close(self) -> None:
        """Stops the thread and frees the scene."""
        self._stop()
        if self._scene is not None:
            self._scene.close()
            self._scene = None

    def update(self, context: Any, depsgraph: Any) -> None:
        """Reads the scene anew, unless only a camera changed."""
        if self._scene is not None and _only_cameras(depsgraph):
            self._shown = None
            return
        self.close()
        self._shown = None
        found = report.start(depsgraph.scene)
        builder = SceneBuilder(found, settings.threads_of(depsgraph.scene.render))
        try:
            self._scene = builder.finish(builder.read(depsgraph))
        except (OpalError, ValueError, MemoryError) as error:
            builder.scene.close()
            self._engine.update_stats("", f"Error: {error}")

    def draw(self, context: Any, depsgraph: Any) -> None:
        """Draws the newest picture; restarts the render when the view is another."""
        region = context.region
        if self._scene is None:
            return
        self._restart_if_needed(context, depsgraph, region)
        worker = self._worker
        if worker is None:
            return
        if worker.failure:
            self._engine.update_stats("", f"Error: {worker.failure}")
        elif worker.done < worker.total:
            self._engine.update_stats("", f"Pass {worker.done + 1} of {worker.total}")
        else:
            self._engine.update_stats("", f"{worker.total} passes done")
        picture = worker.picture
        if picture is None:
            return
        if picture is not self._texture_of:
            height, width, _ = picture.shape
            pixels = gpu.types.Buffer("FLOAT", width * height * 4, picture.reshape(-1))
            self._texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=pixels)
            self._texture_of = picture
        gpu.state.blend_set("ALPHA_PREMULT")
        self._engine.bind_display_space_shader(depsgraph.scene)
        draw_texture_2d(self._texture, (0, 0), region.width, region.height)
        self._engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")

    def _restart_if_needed(self, context: Any, depsgraph: Any, region: Any) -> None:
        scene = depsgraph.scene_eval
        found = report.of(depsgraph.scene)
        try:
            camera = camera_from_view(scene, context.space_data, context.region_data, region.width, region.height, found.add)
        except ValueError as error:
            self._engine.update_stats("", f"Error: {error}")
            return
        frame = settings.Frame(region.width, region.height, (0, 0, region.width, region.height))
        wanted = replace(settings.render_settings(scene, frame, preview=True), threads=_threads(scene.render))
        key = (repr(camera), repr(wanted), scene.opal.passes)
        if key == self._shown:
            return
        self._stop()
        self._shown = key
        self._worker = _Worker(self._engine, self._scene, camera, wanted, scene.opal.passes)

    def _stop(self) -> None:
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.stop()


def _threads(render: Any) -> int:
    """All cores but one, which Blender's interface needs, unless the scene says how many."""
    return settings.threads_of(render) or max(1, (os.cpu_count() or 2) - 1)


def _only_cameras(depsgraph: Any) -> bool:
    """Whether nothing but cameras, where they stand included, was changed."""
    changed = [update.id for update in depsgraph.updates]
    return bool(changed) and all(block.id_type == "CAMERA" or (block.id_type == "OBJECT" and block.type == "CAMERA") for block in changed)


class _Worker:
    """Renders passes in a thread until there are enough or it is stopped."""

    def __init__(self, engine: Any, scene: Any, camera: Camera, wanted: RenderSettings, total: int) -> None:
        self._engine, self._scene, self._camera = engine, scene, camera
        self._settings = wanted
        self._stopping = False
        self._render: Render | None = None
        self._lock = threading.Lock()
        self.total = total
        self.done = 0
        self.failure = ""
        self.picture: np.ndarray | None = None
        self._thread = threading.Thread(target=self._run, name="Opal viewport", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Ends the thread; returns when it has ended."""
        with self._lock:
            self._stopping = True
            if self._render is not None:
                self._render.cancel()
        self._thread.join()

    def _run(self) -> None:
        try:
            self._scene.set_camera(self._camera)
            self._scene.commit()
            self._render_passes(self._coarse_settings(), 1)
            self._render_passes(self._settings, self.total)
        except Cancelled:
            pass
        except ReferenceError:
            pass  # Blender took the engine away meanwhile (another shading, the extension disabled): nobody is left to draw for
        except (OpalError, MemoryError) as error:
            self.failure = str(error) or "There is not enough memory."
            self._redraw()

    def _coarse_settings(self) -> RenderSettings:
        width = max(1, self._settings.width // _COARSE)
        height = max(1, self._settings.height // _COARSE)
        return replace(self._settings, width=width, height=height, region=(0, 0, width, height))

    def _render_passes(self, wanted: RenderSettings, total: int) -> None:
        final = wanted is self._settings
        with Render(self._scene, wanted) as render:
            try:
                for number in range(total):
                    with self._lock:
                        if self._stopping:
                            return
                        self._render = render
                    render.run_pass(number)
                    self.picture = render.film(Pass.COMBINED)
                    self.done = number + 1 if final else 0
                    self._redraw()
            finally:
                with self._lock:
                    self._render = None

    def _redraw(self) -> None:
        if not self._stopping:
            self._engine.tag_redraw()
