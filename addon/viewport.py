# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered 3D view: what Blender calls when the scene changed and when the view is drawn.

`viewport_sync` keeps the kernels' scene, `viewport_worker` renders it in a thread, and this draws the newest picture.
"""

from __future__ import annotations

import os
import traceback
import weakref
from dataclasses import replace
from typing import Any

import gpu
import numpy as np
from gpu_extras.presets import draw_texture_2d
from opal_kernels.binding import OpalError
from opal_kernels.camera import window_of_region

from . import report, settings, undo_steps
from .translate.camera import camera_from_view
from .viewport_border import region_of_view
from .viewport_sync import SceneSync
from .viewport_worker import Pace, Worker


class Viewport:
    """What one 3D view shows.

    Parameters
    ----------
    engine : OpalRenderEngine
        Asked to redraw after each pass. It owns this view, so it is not kept alive by it.
    """

    def __init__(self, engine: Any) -> None:
        self._engine = weakref.ref(engine)
        self._sync: SceneSync | None = None
        self._worker: Worker | None = None
        self._pace = Pace()
        self._shown: tuple[Any, ...] | None = None
        self._failure = ""
        self._undo_steps = undo_steps.count
        self._texture: Any = None
        self._texture_of: np.ndarray | None = None
        # Left, bottom, right and top of what the worker and the texture show, in fractions of the view.
        self._place = self._texture_place = (0.0, 0.0, 1.0, 1.0)

    def close(self) -> None:
        """Stops the thread and frees the scene."""
        self._stop()
        sync, self._sync = self._sync, None
        if sync is not None:
            sync.close()

    def update(self, depsgraph: Any, everything: bool = False) -> None:
        """Brings the scene up to date; the running render goes on where nothing has become different."""
        self._undo_steps = undo_steps.count
        if self._sync is None:
            self._sync = SceneSync(settings.threads_of(depsgraph.scene.render))
        self._failure = ""
        try:
            if self._sync.update(depsgraph, self._stop, everything):
                self._shown = None
        except (OpalError, ValueError, MemoryError) as error:
            self._shown = None
            self._failure = str(error) or "There is not enough memory to show this scene."
        except Exception as error:  # what Blender swallows would leave a view that shows its last picture for good
            traceback.print_exc()
            self._shown = None
            self._failure = f"Opal failed on this scene ({type(error).__name__}: {error}); the console has the details."

    def draw(self, context: Any, depsgraph: Any) -> None:
        """Draws the newest picture; restarts the render when the view is another."""
        engine, region = self._engine(), context.region
        if self._undo_steps != undo_steps.count:
            self.update(depsgraph, everything=True)
        if self._failure:
            engine.update_stats("", f"Error: {self._failure}")
            return
        if self._sync is None or self._sync.scene is None:
            return
        self._restart_if_needed(context, depsgraph, region)
        worker = self._worker
        if worker is None:
            return
        if worker.failure:
            engine.update_stats("", f"Error: {worker.failure}")
        elif worker.done < worker.total:
            engine.update_stats("", f"Pass {worker.done + 1} of {worker.total}")
        else:
            engine.update_stats("", f"{worker.total} passes done")
        self._draw_picture(engine, depsgraph.scene, region, worker.picture)

    def _draw_picture(self, engine: Any, scene: Any, region: Any, picture: np.ndarray | None) -> None:
        if picture is not None and picture is not self._texture_of:
            height, width, _ = picture.shape
            pixels = gpu.types.Buffer("FLOAT", width * height * 4, picture.reshape(-1))
            self._texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=pixels)
            self._texture_of, self._texture_place = picture, self._place
        if self._texture is None:
            return
        x0, y0, x1, y1 = (part * size for part, size in zip(self._texture_place, (region.width, region.height) * 2, strict=True))
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        draw_texture_2d(self._texture, (x0, y0), x1 - x0, y1 - y0)
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")

    def _restart_if_needed(self, context: Any, depsgraph: Any, region: Any) -> None:
        scene, space, region_data = depsgraph.scene_eval, context.space_data, context.region_data
        width, height = region.width, region.height
        found = report.of(depsgraph.scene)
        try:
            camera = camera_from_view(scene, space, region_data, width, height, found.add)
            x0, y0, x1, y1 = part = region_of_view(scene, space, region_data, width, height, camera.window)
        except ValueError as error:
            self._engine().update_stats("", f"Error: {error}")
            return
        # What is rendered is a frame of its own: a coarse picture of it has pixels that end where it does.
        camera = replace(camera, window=window_of_region(camera.window, width, height, part))
        frame = settings.Frame(x1 - x0, y1 - y0, (0, 0, x1 - x0, y1 - y0))
        wanted = replace(settings.render_settings(scene, frame, preview=True), threads=_threads(scene.render))
        key = (repr(camera), repr(wanted), scene.opal.passes, scene.opal.denoise)
        if key == self._shown:
            return
        self._stop()
        self._shown, self._place = key, (x0 / width, y0 / height, x1 / width, y1 / height)
        self._worker = Worker(self._sync.scene, camera, wanted, scene.opal.passes, self._pace, _redraw_of(self._engine), scene.opal.denoise)

    def _stop(self) -> None:
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.stop()


def _redraw_of(engine: Any) -> Any:
    """What asks an engine to redraw, for as long as it is there: Blender takes it away with the view's shading or its file."""

    def redraw() -> None:
        owner = engine()
        if owner is None:
            return
        try:
            owner.tag_redraw()
        except ReferenceError:
            pass

    return redraw


def _threads(render: Any) -> int:
    """All cores but one, which Blender's interface needs, unless the scene says how many."""
    return settings.threads_of(render) or max(1, (os.cpu_count() or 2) - 1)
