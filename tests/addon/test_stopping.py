# SPDX-License-Identifier: GPL-3.0-or-later
"""Escape is heard at once, whatever the render is about, and the next render knows nothing of it.

Escape is Blender's `test_break`; here it turns true when a test says so.
"""

import threading
import time

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402
from opal_kernels import denoise  # noqa: E402
from opal_kernels.binding import Cancelled  # noqa: E402
from opal_kernels.render import Render  # noqa: E402
from opal_kernels.scene import Scene  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


class Escape:
    """An engine whose person presses Escape when `pressed` is set."""

    def __init__(self, engine, pressed):
        self._engine, self._pressed = engine, pressed

    def test_break(self):
        return self._pressed.is_set()

    def __getattr__(self, name):
        return getattr(self._engine, name)


@pytest.fixture
def pressed(monkeypatch):
    """Set it to stop the render that runs."""
    event = threading.Event()
    final_render = stage.addon("final_render")

    class Stoppable(final_render._FinalRender):
        def __init__(self, engine, *arguments):
            super().__init__(Escape(engine, event), *arguments)

    monkeypatch.setattr(final_render, "_FinalRender", Stoppable)
    return event


def noted(monkeypatch, owner, name, before):
    """Lets `before(*arguments, **more)` run ahead of a function; the list that is returned gets what it raises, or None."""
    original, ends = getattr(owner, name), []

    def wrapped(*arguments, **more):
        before(*arguments, **more)
        try:
            result = original(*arguments, **more)
        except Exception as error:
            ends.append(error)
            raise
        ends.append(None)
        return result

    monkeypatch.setattr(owner, name, wrapped)
    return ends


def test_a_running_pass_stops_within_a_third_of_a_second_and_is_not_denoised(monkeypatch):
    """Escape is Blender's `test_break`: here it turns true while one very long pass runs."""
    scene = stage.scene(passes=1)
    stage.camera((0, 0, 5))
    stage.world()
    stage.plane(size=20, material=stage.matte())
    scene.render.resolution_x, scene.render.resolution_y, scene.opal.samples_per_pass = 640, 480, 64
    final_render = stage.addon("final_render")
    scene.opal.denoise = True
    pressed = {}

    class Wrapped(final_render._FinalRender):
        def _run_pass(self, render, *arguments):
            timer = threading.Timer(0.5, lambda: pressed.setdefault("at", time.perf_counter()))
            timer.start()
            outer = self.engine

            class Engine:
                def test_break(self):
                    return "at" in pressed

                def __getattr__(self, name):
                    return getattr(outer, name)

            self.engine = Engine()
            finished = super()._run_pass(render, *arguments)
            pressed["stopped"] = time.perf_counter()
            self.engine = outer
            return finished

    monkeypatch.setattr(final_render, "_FinalRender", Wrapped)
    monkeypatch.setattr(denoise, "denoise", lambda *_, **__: pytest.fail("a render that was stopped is denoised"))
    bpy.ops.render.render()
    assert pressed["stopped"] > pressed["at"], "the pass was too short to be stopped"
    assert pressed["stopped"] - pressed["at"] < 0.3


@pytest.mark.parametrize("position", ["START", "END"])
def test_the_frame_is_what_it_was_though_the_scene_is_read_no_further(position, pressed, monkeypatch):
    """The middle of such a shutter is another moment: frame 7 was left at 7.25."""
    scene = stage.scene()
    stage.camera((0, 0, 5))
    scene.frame_set(7)
    scene.render.use_motion_blur, scene.render.motion_blur_position = True, position
    builder = stage.addon("translate.scene_builder").SceneBuilder
    reads = noted(monkeypatch, builder, "read", lambda *_: pressed.set())
    bpy.ops.render.render()
    assert [type(end).__name__ for end in reads] == ["Stopped"]
    assert (scene.frame_current, scene.frame_subframe) == (7, 0.0)


def test_a_scene_that_is_being_built_is_given_up(pressed, monkeypatch, tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.world()
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=300, y_subdivisions=300, size=20)

    def wait_for_the_stop(scene):
        """Embree would be done with a small scene before the stop comes."""
        if pressed.is_set():
            return
        pressed.set()
        while not stopping.is_set():
            time.sleep(0.002)

    stopping = threading.Event()
    commits = noted(monkeypatch, Scene, "commit", wait_for_the_stop)
    monkeypatch.setattr(Scene, "cancel", lambda scene, cancel=Scene.cancel: (cancel(scene), stopping.set()))
    passes = noted(monkeypatch, Render, "run_pass", lambda *_: None)
    bpy.ops.render.render()
    assert [type(end) for end in commits] == [Cancelled] and not passes
    monkeypatch.undo()
    assert stage.render(tmp_path)[..., :3].mean() == pytest.approx(0.8, rel=0.05)


def test_a_picture_that_is_being_denoised_is_kept_as_it_is(pressed, monkeypatch, tmp_path):
    if reason := denoise.unavailable():
        pytest.skip(reason)
    scene = stage.scene(width=64, height=48)
    stage.camera((0, 0, 5))
    stage.world()
    stage.plane(size=20, material=stage.matte())
    noisy = stage.render(tmp_path)
    scene.opal.denoise = True
    clean = stage.render(tmp_path)

    def wait_for_the_stop(*_, wants_stop, **__):
        pressed.set()
        while not wants_stop():
            time.sleep(0.002)

    runs = noted(monkeypatch, denoise, "denoise", wait_for_the_stop)
    stopped = stage.render(tmp_path)
    for thread in threading.enumerate():
        if thread.name == "Opal denoising":
            thread.join()
    assert [type(end) for end in runs] == [Cancelled]
    np.testing.assert_array_equal(stopped, noisy)
    monkeypatch.undo()
    again = stage.render(tmp_path)
    np.testing.assert_array_equal(again, clean)
    assert not np.array_equal(again, noisy)
