# SPDX-License-Identifier: GPL-3.0-or-later
"""What operators that take long share: in a window they go on beside it, show how far they are, and Escape stops them.

Scripts, and Blender without a window, wait for the end.

Their `bl_options` leave out REGISTER on purpose. With it Blender would offer the operator's settings in its panel Adjust Last Operation, and
call `execute` for each that is changed there: it waits for the end with the window frozen, and may not become a modal operator,
because Blender already keeps it as the last one. Whoever wants other settings presses the button again.
"""

from __future__ import annotations

from typing import Any

import bpy
from bpy.app.handlers import persistent

from .job import Job, Steps
from .quiet_views import quiet_views

# Seconds between looks at the job, and between what the person is told.
_LOOK_SECONDS, _TELL_SECONDS = 0.1, 0.2

_running: Job | None = None


def refusal() -> str:
    """Why no other job can begin; empty where one can."""
    if _running is None or _running.over:
        return ""
    return f"{_running.title} is still at work: wait for its end, or stop it with Esc."


class LongJob:
    """The operator's half of a job.

    Attributes
    ----------
    parts : int
        How many steps it takes, for the progress.
    holds_scene : bool
        Whether it changes the scene for a while: nothing may be edited meanwhile, and undo ends it.
    """

    parts = 1
    holds_scene = False
    _job: Job | None = None
    _timer: Any = None

    def steps(self, context: Any) -> Steps:
        """The job itself."""
        raise NotImplementedError

    def execute(self, context: Any) -> set[str]:
        if self._is_refused():
            return {"CANCELLED"}
        return Job(self.steps(context), self.parts).to_the_end()

    def invoke(self, context: Any, _event: Any) -> set[str]:
        global _running
        if bpy.app.background or context.window is None:
            return self.execute(context)
        if self._is_refused():
            return {"CANCELLED"}
        title = bpy.app.translations.pgettext_iface(self.bl_label, "Operator")
        steps = self._with_quiet_views(context) if self.holds_scene else self.steps(context)
        job = Job(steps, self.parts, title, self.holds_scene)
        if job.advance():
            return job.result
        self._job = _running = job
        manager = context.window_manager
        manager.progress_begin(0, 100)
        self._timer = manager.event_timer_add(_LOOK_SECONDS, window=context.window)
        manager.modal_handler_add(self)
        # Blender gives no events to operators while a render locks the interface; its own timers still come.
        bpy.app.timers.register(lambda window=context.window: _tell(job, window), first_interval=0.0)
        return {"RUNNING_MODAL"}

    def _with_quiet_views(self, context: Any) -> Steps:
        with quiet_views():
            return (yield from self.steps(context))

    def modal(self, context: Any, event: Any) -> set[str]:
        if event.type == "ESC" and event.value == "PRESS":
            self._job.stop()
        if event.type != "TIMER":
            return {"RUNNING_MODAL"} if self.holds_scene else {"PASS_THROUGH"}
        try:
            if not self._job.advance():
                return {"PASS_THROUGH"}
        except BaseException:
            self._end(context)
            raise
        self._end(context)
        if self._job.stopping:
            self.report({"INFO"}, f"Stopped: {self._job.title}")
            return {"CANCELLED"}
        return self._job.result

    def cancel(self, context: Any) -> None:
        """Blender takes the operator away: its window is closed, or another file comes."""
        self._job.abandon()
        self._end(context)

    def _is_refused(self) -> bool:
        if sentence := refusal():
            self.report({"ERROR"}, sentence)
        return bool(sentence)

    def _end(self, context: Any) -> None:
        manager = context.window_manager
        manager.event_timer_remove(self._timer)
        manager.progress_end()
        if context.workspace is not None:
            context.workspace.status_text_set(None)


def _tell(job: Job, window: Any) -> float | None:
    """Shows how far a job is; seconds until the next time."""
    if job.over or job.stopping:
        return None
    try:
        with bpy.context.temp_override(window=window):
            bpy.context.window_manager.progress_update(int(100 * job.done))
            words = f"{job.words}, " if job.words else ""
            bpy.context.workspace.status_text_set(f"{job.title}: {words}{job.done:.0%}, Esc to stop")
    except (ReferenceError, TypeError):
        return None  # the window is closed
    return _TELL_SECONDS


@persistent
def _on_undo(*_: Any) -> None:
    """Undo replaces the data beneath a job. Blender has ended its renders by now, and what the job changed is still there."""
    if _running is not None and _running.holds_scene and not _running.over:
        _running.abandon()


def register() -> None:
    bpy.app.handlers.undo_pre.append(_on_undo)
    bpy.app.handlers.redo_pre.append(_on_undo)


def unregister() -> None:
    bpy.app.handlers.redo_pre.remove(_on_undo)
    bpy.app.handlers.undo_pre.remove(_on_undo)
    if _running is not None and not _running.over:
        _running.abandon()
