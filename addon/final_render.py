# SPDX-License-Identifier: GPL-3.0-or-later
"""A final render: translate, render pass after pass while the person may stop, show, finish.

What takes long and can be stopped in the midst (building the scene, a pass, denoising) runs in a thread of its own (`stopping`).
"""

from __future__ import annotations

import math
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import bpy
import numpy as np
from opal_kernels import denoise, memory
from opal_kernels.binding import OpalError
from opal_kernels.descriptions import Camera, Carry, Pass, RenderSettings
from opal_kernels.render import Render
from opal_kernels.scene import Scene

from . import capture as captures
from . import empty_result, film_files, main_thread, render_views, report, settings, spectral_exr, stopping, units
from .identity import Named
from .render_passes import RenderPass, wanted
from .render_views import Place, View
from .stopping import Stopped
from .translate import clipping
from .translate.camera import camera_from_object
from .translate.scene_builder import SceneBuilder, Snapshot

# Blender is shown the picture at most this often, and at once after the first pass.
_SHOW_SECONDS = 1.0
# Part of the free memory that a film may take.
_MEMORY_SHARE = 0.8


def render(engine: Any, depsgraph: Any) -> None:
    """Renders one view layer into the engine's result; what fails is reported in one sentence."""
    scene = depsgraph.scene
    found = report.start(scene)
    job = None
    try:
        job = _FinalRender(engine, depsgraph, found)
        job.run()
    except Stopped:  # before there was a picture
        empty_result.hand_back(engine, depsgraph)
        return
    except Exception as error:
        # Blender 4.5 crashes when it writes the picture of an engine that raised.
        if isinstance(error, MemoryError):
            sentence = str(error) or "There is not enough memory to render this scene."
        elif isinstance(error, OpalError | ValueError):
            sentence = str(error)
        else:
            traceback.print_exc()
            sentence = f"Opal failed on this scene ({type(error).__name__}: {error}); the console has the details."
        if (capture := captures.current()) is not None:
            capture.failure = sentence
        # Where memory is short an empty picture might not fit either: then there is none, and after an error Blender writes none.
        if (job is None or not job.has_result) and not isinstance(error, MemoryError | _DoesNotFit):
            empty_result.hand_back(engine, depsgraph)
        engine.report({"ERROR"}, sentence)
        return
    if not engine.is_preview and (summary := found.summary()):
        engine.report({"WARNING"}, summary)


# A first pass of more camera paths and photons than this is preceded by a coarse picture of so many pixels and photons.
_LONG_PASS = 2_000_000
_LOOK_PIXELS, _LOOK_PHOTONS = 20_000, 4_000


class _DoesNotFit(OpalError):
    """The picture is too large for the memory that there is."""


class _FinalRender:
    """One view layer's render, of every view where there are several."""

    def __init__(self, engine: Any, depsgraph: Any, found: report.Report) -> None:
        self.engine, self.depsgraph, self.report = engine, depsgraph, found
        self.scene = depsgraph.scene_eval
        self.layer = depsgraph.view_layer_eval
        self.frame = settings.frame_of(self.scene.render)
        self.passes: list[RenderPass] = [] if engine.is_preview else wanted(depsgraph.view_layer)
        self.denoise = self.scene.opal.denoise and not engine.is_preview
        self.capture = None if engine.is_preview else captures.current()
        self.views = [View()] if engine.is_preview else render_views.views_of(self.scene.render)
        self.view = self.views[0]
        self.cameras: list[Camera] = []
        self.settings = self._settings()
        self.last_shown = self.last_stage = -np.inf
        self.has_result = False

    def _settings(self) -> RenderSettings:
        kept: list[Pass] = [row.source for row in self.passes]
        if self.denoise:
            kept += [Pass.ALBEDO, Pass.NORMAL]
        if self.capture is not None:
            kept += self.capture.passes
        result = settings.render_settings(self.scene, self.frame, sorted(set(kept)), self.engine.is_preview, self.layer)
        if any(number >= Pass.LAYER_BASE for number in kept) and result.photons_carry != Carry.NONE:
            result.photons_carry = Carry.CAUSTICS  # photons that bring ordinary light would not know its layer
        return result

    def run(self) -> None:
        self._refuse_what_does_not_fit()
        with self._translate() as scene:
            width, height = self.frame.region_size
            result = self.engine.begin_result(0, 0, width, height, layer=self.layer.name)
            self.has_result = True
            try:
                for view, camera in zip(self.views, self.cameras, strict=True):
                    self.view = view
                    render_views.choose(self.engine, view)
                    if camera is not self.cameras[0]:
                        scene.set_camera(camera)
                        scene.commit()
                    if not self._run_view(scene, result):
                        break
            finally:
                self.engine.end_result(result, cancel=False, do_merge_results=False)

    def _run_view(self, scene: Scene, result: Any) -> bool:
        """Renders what the scene's camera sees; False if the person stopped it."""
        with Render(scene, self.settings) as render:
            finished = self._look(scene, result) and self._run_passes(render, result)
            self._note_overlaps(render)
            cancelled = not (self._write_everything(render, result, denoised=self.denoise and finished) and finished)
            if self.capture is not None and render.passes_done:
                self.capture.take(self.layer.name, render)
                self.capture.stopped |= cancelled
            if not cancelled:
                self._write_spectrum(render)
                self._write_film(render)
        return not cancelled

    def _note_overlaps(self, render: Render) -> None:
        if render.statistics["gems_passed_over"]:
            self.report.add("", "more than 32 gems lie within each other: what is inside of them turns dark", lost=True)
        if render.statistics["media_passed_over"]:
            self.report.add("", "more than 32 media overlap: those that light comes into last are left out there", lost=True)

    def _refuse_what_does_not_fit(self) -> None:
        width, height = self.frame.region_size
        bins = self.settings.spectral_bins
        needed = memory.film_bytes(width * height, self.settings.passes, bins)
        needed += memory.copies_bytes(width * height, bins, self.denoise)
        whole = width * height if self.scene.render.use_crop_to_border else self.frame.width * self.frame.height
        needed += len(self.views) * memory.result_bytes(whole, [row.source for row in self.passes])
        available = memory.available_bytes()
        if available is not None and needed > _MEMORY_SHARE * available:
            raise _DoesNotFit(
                f"Rendering {width} x {height} pixels would take {needed / 2**30:.1f} GB of memory and "
                f"{available / 2**30:.1f} GB are free: lower Resolution or render a border."
            )

    def _stage(self, text: str, done: float = 0.0) -> None:
        if (now := time.monotonic()) - self.last_stage > 0.1:
            self.last_stage = now
            self.engine.update_stats("", text)
            self.engine.update_progress(done)
        if self.engine.test_break():
            raise Stopped

    def _translate(self) -> Scene:
        builder = SceneBuilder(
            self.report, self.settings.threads, self._stage, self.engine.is_preview, undisturbed=self._undisturbed, aside=self._aside
        )
        try:
            snapshot, places = self._read(builder)
            for view, of_view in zip(self.views, places, strict=True):
                render_views.choose(self.engine, view)
                camera = self._camera_at(of_view)
                builder.rain.look(camera)
                self._tell_of_hidden_gems(camera, snapshot)
                self.cameras.append(camera)
            return builder.finish(snapshot, self.cameras[0])
        except BaseException:
            builder.scene.close()
            raise

    def _read(self, builder: SceneBuilder) -> tuple[Snapshot, list[list[Place]]]:
        """What is seen, and where each view's camera stands: in the middle of the shutter and, if motion blurs, at its opening and close."""
        motion = self.settings.motion_blur
        frame, subframe = self.scene.frame_current, self.scene.frame_subframe
        opening, middle, close = (frame + subframe + time for time in _shutter(self.scene.render))
        try:
            if motion and middle != frame + subframe:
                self._go_to(middle)
            snapshot = builder.read(self.depsgraph)
            places = [[place] for place in self._places()]
            for time in (opening, close) if motion else ():
                self._go_to(time)
                builder.read_motion(self.depsgraph, snapshot)
                for of_view, place in zip(places, self._places(), strict=True):
                    of_view.append(place)
        finally:
            if motion:
                self.engine.frame_set(frame, subframe)
        return snapshot, places

    def _places(self) -> list[Place]:
        found = []
        for view in self.views:
            render_views.choose(self.engine, view)
            found.append(render_views.place(self.engine, view, self._camera()))
        return found

    def _camera_at(self, places: list[Place]) -> Camera:
        """The camera of the chosen view."""
        return camera_from_object(
            self._camera(),
            self.scene,
            self.frame.width,
            self.frame.height,
            matrix=places[0].matrix,
            matrix_ends=[place.matrix for place in places[1:]],
            shift_x=places[0].shift_x,
            report=self.report.add,
        )

    def _tell_of_hidden_gems(self, camera: Any, snapshot: Any) -> None:
        if hidden := clipping.hidden_gems(camera, snapshot):
            start = bpy.utils.units.to_string(
                self.scene.unit_settings.system, "LENGTH", camera.clip_start * units.metres_per_unit(self.scene), precision=4
            )
            self.report.add(Named(self._camera()), clipping.sentence(hidden, start), "Clip Start", lost=True)

    def _undisturbed(self, read: Callable[[], Any], depsgraph: Any) -> Any:
        """Reads while nothing can be deleted; what went before is refused, for Blender's list of instances would look for it."""
        if self.engine.is_preview:  # of a file of its own
            return read()

        def read_what_is_there() -> Any:
            if gone := main_thread.deleted(depsgraph):
                others = f" and {len(gone) - 1} more were" if len(gone) > 1 else " was"
                raise OpalError(f"“{gone[0]}”{others} deleted while the render started: render again.")
            return read()

        return main_thread.call(read_what_is_there, lambda: self._stage("Reading objects"))

    def _aside(self, work: Callable[[], None], cancel: Callable[[], None]) -> None:
        stopping.run(work, cancel, self.engine.test_break, name="Opal scene")

    def _go_to(self, time_in_frames: float) -> None:
        whole = int(np.floor(time_in_frames))
        self.engine.frame_set(whole, time_in_frames - whole)

    def _camera(self) -> Any:
        camera = self.engine.camera_override or self.scene.camera
        if camera is None:
            raise OpalError(f"The scene “{self.depsgraph.scene.name}” has no camera to render from.")
        return camera.evaluated_get(self.depsgraph)

    def _look(self, scene: Scene, result: Any) -> bool:
        """A coarse picture to look at while a long first pass runs; it is no part of the render. False if the person stopped it."""
        wanted, (width, height) = self.settings, self.frame.region_size
        if self.engine.is_preview or width * height * wanted.samples_per_pass + wanted.photons_per_pass < _LONG_PASS:
            return True
        edge = math.ceil(math.sqrt(width * height / _LOOK_PIXELS))
        x0, y0, x1, y1 = (coordinate // edge for coordinate in self.frame.region)
        coarse = replace(
            wanted,
            width=max(wanted.width // edge, 1),
            height=max(wanted.height // edge, 1),
            samples_per_pass=1,
            photons_per_pass=min(wanted.photons_per_pass, _LOOK_PHOTONS),
            volume_photons=min(wanted.volume_photons, _LOOK_PHOTONS),
            region=(x0, y0, x1, y1),
            passes=(),
            spectral_bins=0,
            adaptive=False,
        )
        if not (x0 < x1 <= coarse.width and y0 < y1 <= coarse.height):
            return True
        with Render(scene, coarse) as look:
            if not self._run_pass(look, 0, 0, self.scene.opal.passes, time.monotonic()):
                return False
            picture = look.film(Pass.COMBINED)
        rows, columns = (np.minimum(np.arange(n) // edge, m - 1) for n, m in zip((height, width), picture.shape, strict=False))
        self._put(result, "Combined", picture[rows[:, None], columns[None, :]])
        self.engine.update_result(result)
        return True

    def _run_passes(self, render: Render, result: Any) -> bool:
        """Renders until the passes, the time or the noise say enough; False if the person stopped it."""
        opal = self.scene.opal
        total, time_limit, threshold = opal.passes, opal.time_limit, opal.noise_threshold
        if self.engine.is_preview:
            total, time_limit, threshold = settings.PREVIEW_PASSES, settings.PREVIEW_SECONDS, 0.0
        begun = time.monotonic()
        first = 0 if self.engine.is_preview else opal.pass_first - 1
        for number in range(total):
            if not self._run_pass(render, first, number, total, begun):
                return False
            now = time.monotonic()
            if number + 1 < total and now - self.last_shown > _SHOW_SECONDS:
                self._show(render, result)
            # Another pass only if that brings the end nearer to the limit.
            if time_limit and (now - begun) * (1 + 0.5 / (number + 1)) >= time_limit:
                break
            if threshold and 0 <= render.noise < threshold:
                break
        return True

    def _run_pass(self, render: Render, first: int, number: int, total: int, begun: float) -> bool:
        last_told = -np.inf

        def tell() -> None:
            nonlocal last_told
            if (now := time.monotonic()) - last_told > 0.25:
                last_told = now
                self._tell(number, total, number + render.progress, now - begun)

        try:
            stopping.run(lambda: render.run_pass(first + number), render.cancel, self.engine.test_break, tell, "Opal pass")
        except Stopped:
            return False
        return True

    def _tell(self, number: int, total: int, done: float, elapsed: float) -> None:
        limit = self.scene.opal.time_limit
        left = elapsed / done * (total - done) if done > 0 else None
        fraction = done / total
        if limit:
            left = min(left, max(0.0, limit - elapsed)) if left is not None else max(0.0, limit - elapsed)
            fraction = max(fraction, min(1.0, elapsed / limit))
        fraction = (self.views.index(self.view) + fraction) / len(self.views)
        remaining = f" | Remaining: {_clock(left)}" if left is not None else ""
        which = f"{self.view.name} | " if self.view.name else ""
        self.engine.update_stats("", f"{which}Pass {number + 1} of {total} | Time: {_clock(elapsed)}{remaining}")
        self.engine.update_progress(fraction)
        if self.capture is not None:
            self.capture.done = fraction

    # ---- Pixels ----

    def _show(self, render: Render, result: Any) -> None:
        self.last_shown = time.monotonic()
        self._put(result, "Combined", render.film(Pass.COMBINED))
        self.engine.update_result(result)

    def _write_everything(self, render: Render, result: Any, denoised: bool) -> bool:
        """Hands every pass to Blender; False if the person stopped the denoising, whose picture is then the noisy one."""
        combined = render.film(Pass.COMBINED)
        finished = True
        if denoised and render.passes_done:
            try:
                combined = self._denoised(render, combined)
            except Stopped:
                finished = False
        self._put(result, "Combined", combined)
        for row in self.passes:
            self._put(result, row.name, render.film(row.source))
        return finished

    def _put(self, result: Any, name: str, pixels: np.ndarray) -> None:
        render_views.put(result, self.view, name, np.ascontiguousarray(pixels, np.float32))

    def _denoised(self, render: Render, combined: np.ndarray) -> np.ndarray:
        self.engine.update_stats("", "Denoising")
        guides = render.film(Pass.ALBEDO), render.film(Pass.NORMAL)
        stop = threading.Event()

        def work() -> np.ndarray:
            return denoise.denoise(combined, *guides, threads=self.settings.threads, wants_stop=stop.is_set)

        try:
            # One layer of the network may take a second for a large picture, and ends only as a whole.
            return stopping.run(work, stop.set, self.engine.test_break, name="Opal denoising", owns_all=True)
        except OpalError as error:
            self.report.add("", f"The picture is not denoised: {error}")
            return combined

    def _write_film(self, render: Render) -> None:
        opal = self.scene.opal
        if not opal.use_film_file or self.engine.is_preview:
            return
        sums = render.sums()
        sums.info = film_files.info_of(self.depsgraph.scene.name, self.scene, self.layer.name, self.settings, self.view.name)
        try:
            sums.save(film_files.path_of(self.scene, self.layer.name, sums.passes, self.view.suffix))
        except OpalError as error:
            self.report.add("", str(error))

    def _write_spectrum(self, render: Render) -> None:
        if not self.settings.spectral_bins:
            return
        first, last = self.settings.wavelength_first, self.settings.wavelength_last
        centers = spectral_exr.bin_centers(first, last, self.settings.spectral_bins)
        try:
            path = spectral_exr.output_path(self.scene, self.layer.name, self.view.suffix)
            spectral_exr.write(path, render.film(Pass.SPECTRAL), render.film(Pass.COMBINED), centers)
        except OpalError as error:
            self.report.add("", str(error))


def _shutter(render: Any) -> tuple[float, float, float]:
    """Shutter open, middle and close in frames relative to the current one."""
    half = 0.5 * render.motion_blur_shutter
    middle = {"START": half, "CENTER": 0.0, "END": -half}[render.motion_blur_position]
    return middle - half, middle, middle + half


def _clock(seconds: float) -> str:
    whole = int(seconds)
    hours, minutes = whole // 3600, whole // 60 % 60
    return f"{hours}:{minutes:02d}:{whole % 60:02d}" if hours else f"{minutes:02d}:{seconds % 60:05.2f}"
