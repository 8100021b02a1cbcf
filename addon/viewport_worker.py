# SPDX-License-Identifier: GPL-3.0-or-later
"""The thread that renders what a 3D view shows: coarse pixels first, then the view's own, pass after pass.

How coarse the first picture is depends on how long a pixel took so far, so that it is there at once while the view is
turned. The thread knows the kernels' scene and numpy alone; nothing of Blender's is in it but the call that asks for a redraw.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from opal_kernels import denoise
from opal_kernels.binding import Cancelled, OpalError
from opal_kernels.descriptions import Camera, Pass, RenderSettings
from opal_kernels.render import Render
from opal_kernels.scene import Scene

# The first picture may take this long (s); what the first view of a scene takes for a pixel (s), before one was measured.
_FIRST_SECONDS = 0.1
_USUAL_PIXEL_SECONDS = 4e-6
# Edges of the first picture's pixels, in pixels of the view; the next picture's are a quarter of them.
_COARSENESS = (1, 2, 4, 8, 16)


@dataclass
class Pace:
    """How long a sample of a pixel took, from one start of a view's render to the next (s)."""

    seconds: float = _USUAL_PIXEL_SECONDS

    def coarseness(self, width: int, height: int) -> int:
        """Edge of pixels with which a first picture of so many pixels is ready in time."""
        fitting = (c for c in _COARSENESS if self.seconds * (width // c) * (height // c) <= _FIRST_SECONDS)
        return next(fitting, _COARSENESS[-1])

    def note(self, samples: int, seconds: float) -> None:
        """What a pass took; the mean leans to the last one, for scenes change."""
        self.seconds += 0.5 * (seconds / max(1, samples) - self.seconds)


def coarse(wanted: RenderSettings, edge: int) -> RenderSettings:
    """The same view in pixels of another size, with as many photons fewer as its edges are longer."""
    if edge == 1:
        return wanted
    width, height = max(1, wanted.width // edge), max(1, wanted.height // edge)
    return replace(
        wanted, width=width, height=height, region=(0, 0, width, height), photons_per_pass=wanted.photons_per_pass // edge, passes=()
    )


class Worker:
    """Renders until there are passes enough or it is stopped.

    Parameters
    ----------
    scene : Scene
        Committed; nobody else may touch it before `stop` has returned.
    camera : Camera
    wanted : RenderSettings
        Of the view's own pixels.
    total : int
        Passes of those.
    pace : Pace
        Read at the start, and told of each pass.
    redraw : callable
        Called after each pass, from the thread.
    denoised : bool
        Whether pictures are denoised, after passes 1, 2, 4, 8 ... and the last.

    Attributes
    ----------
    picture : ndarray or None
        The newest, (height, width, 4) float32, rows from the bottom up.
    done : int
        Passes of the view's own pixels in it.
    failure : str
        Why the thread ended, in one sentence; empty where it did not fail.
    """

    def __init__(
        self,
        scene: Scene,
        camera: Camera,
        wanted: RenderSettings,
        total: int,
        pace: Pace,
        redraw: Callable[[], None],
        denoised: bool = False,
    ) -> None:
        self._scene, self._camera, self._settings = scene, camera, wanted
        self._pace, self._ask_redraw = pace, redraw
        self._denoised = denoised and not denoise.unavailable()
        if self._denoised:
            self._settings = replace(wanted, passes=(Pass.ALBEDO, Pass.NORMAL))
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
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def wait(self, seconds: float | None = None) -> None:
        """Returns when every pass is done, or after so many seconds."""
        self._thread.join(seconds)

    def _run(self) -> None:
        try:
            self._scene.set_camera(self._camera)
            self._scene.commit()
            edge = self._pace.coarseness(self._settings.width, self._settings.height)
            while edge > 1:
                self._render_passes(coarse(self._settings, edge), 1)
                edge //= 4
            self._render_passes(self._settings, self.total)
        except Cancelled:
            pass
        except (OpalError, MemoryError) as error:
            self.failure = str(error) or "There is not enough memory."
            self._redraw()

    def _render_passes(self, wanted: RenderSettings, total: int) -> None:
        final = wanted is self._settings
        if self._stopping:
            return
        with Render(self._scene, wanted) as render:
            try:
                for number in range(total):
                    with self._lock:
                        if self._stopping:
                            return
                        self._render = render
                    begun = time.perf_counter()
                    render.run_pass(number)
                    self._pace.note(wanted.width * wanted.height, time.perf_counter() - begun)
                    self._show(render, number + 1, final)
            finally:
                with self._lock:
                    self._render = None

    def _show(self, render: Render, passes: int, final: bool) -> None:
        self.done = passes if final else 0
        if not (final and self._denoised) or passes == 1:
            self.picture = render.film(Pass.COMBINED)
            self._redraw()
        if final and self._denoised and (passes & (passes - 1) == 0 or passes == self.total) and not self._stopping:
            guides = render.film(Pass.ALBEDO), render.film(Pass.NORMAL)
            picture = render.film(Pass.COMBINED)
            self.picture = denoise.denoise(picture, *guides, threads=self._settings.threads, wants_stop=lambda: self._stopping)
        if final and self._denoised:
            self._redraw()

    def _redraw(self) -> None:
        if not self._stopping:
            self._ask_redraw()
