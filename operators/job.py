# SPDX-License-Identifier: GPL-3.0-or-later
"""A job made of steps: what takes long is handed out as a step, and whoever drives the job waits for it in his own way.

A job is a generator. It yields steps (`Aside`, `render_scene.BlenderRender`), gets back what each gave, and returns what the
operator returns; a step that failed is raised where it was yielded. So one text serves scripts, which wait for each step, and the
interface, which looks again later (`long_job`). What a job changes for a while it changes in ``with`` blocks: given up at any
step, it leaves them, and everything is put back.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Generator
from typing import Any, Protocol

import bpy

_POLL_SECONDS = 0.1


class Step(Protocol):
    """What takes long.

    Attributes
    ----------
    words : str
        What is going on.
    done : float
        Part that is done, 0 to 1.
    stopped : bool
        Whether the person stopped this step itself, as Blender lets him stop a render.
    result, failure
        What it gave, or the exception that it ended with.
    """

    words: str
    done: float
    stopped: bool
    result: Any
    failure: Exception | None

    def run(self) -> None:
        """From beginning to end."""

    def begin(self) -> None:
        """Only begins."""

    def runs(self) -> bool:
        """Whether it has begun and not ended."""

    def stop(self) -> None:
        """Asks it to end soon."""

    def end(self) -> None:
        """Puts away what it needed, once it no longer runs."""


Steps = Generator[Step, Any, set[str]]


class Aside(threading.Thread):
    """A step in a thread of its own. Its work touches none of Blender's data.

    Parameters
    ----------
    work : callable
        Gets a function that it tells how much is done, and that returns whether to go on; may raise when that says no.
    words : str
        What is going on.
    owns_all : bool
        Whether nobody need wait for its end after a stop.
    """

    def __init__(self, work: Callable[[Callable[[float], bool]], Any], words: str, owns_all: bool = False) -> None:
        super().__init__(name=f"Opal: {words}", daemon=True)
        self._work, self._owns_all = work, owns_all
        self.words, self.done = words, 0.0
        self.stopped = False
        self.result: Any = None
        self.failure: Exception | None = None

    def _told(self, done: float) -> bool:
        self.done = done
        return not self.stopped

    def run(self) -> None:
        try:
            self.result = self._work(self._told)
        except Exception as error:
            self.failure = error

    def begin(self) -> None:
        self.start()

    def runs(self) -> bool:
        return self.is_alive() and not (self.stopped and self._owns_all)

    def stop(self) -> None:
        self.stopped = True

    def end(self) -> None:
        pass


class Job:
    """Drives the steps.

    Parameters
    ----------
    steps : generator
        See above.
    parts : int
        How many steps it takes, for the progress.
    title : str
        What the person calls it.
    holds_scene : bool
        Whether it changes the scene for a while.
    """

    def __init__(self, steps: Steps, parts: int = 1, title: str = "", holds_scene: bool = False) -> None:
        self._steps, self._parts, self._taken = steps, parts, 0
        self.title, self.holds_scene = title, holds_scene
        self._step: Step | None = None
        self._begun = False
        self.stopping = self.over = False
        self.result: set[str] = {"CANCELLED"}

    def to_the_end(self) -> set[str]:
        """Waits for each step; what the job returned."""
        while (step := self._next()) is not None:
            step.run()
        return self.result

    def advance(self) -> bool:
        """Goes on without waiting; whether the job is over.

        A step begins one call after the last has ended, so that Blender redraws in between what the job has changed: while a render
        locks the interface a view that needs it goes black.
        """
        step = self._step
        if self.over or (self._begun and step.runs()):
            return self.over
        if self.stopping or (step is not None and step.stopped and step.failure is None):
            self.abandon()
        elif step is None or self._begun:
            self._begun = False
            self._next()
        else:
            self._begun = True
            step.begin()
        return self.over

    def _next(self) -> Step | None:
        """Hands the job what the last step gave; the step that comes then, None at the end."""
        before, self._step = self._step, None
        try:
            if before is None:
                self._step = next(self._steps)
            else:
                self._taken += 1
                before.end()
                if before.failure is not None:
                    self._step = self._steps.throw(before.failure)
                else:
                    self._step = self._steps.send(before.result)
        except StopIteration as end:
            self.over, self.result = True, end.value
        except BaseException:
            self.over = True
            raise
        return self._step

    def stop(self) -> None:
        """Asks the present step to end; no other follows."""
        self.stopping = True
        if self._begun:
            self._step.stop()

    def abandon(self) -> None:
        """Ends the job without a result: at once, or as soon as the step has ended that would miss what is put back."""
        self.stop()
        if self._close() is not None:
            bpy.app.timers.register(self._close, first_interval=_POLL_SECONDS, persistent=True)

    def _close(self) -> float | None:
        """Leaves the job's ``with`` blocks; seconds to wait where a step still runs."""
        if self._begun:
            if self._step.runs():
                return _POLL_SECONDS
            self._step.end()
        self._step, self._begun, self.over = None, False, True
        self._steps.close()
        return None

    @property
    def words(self) -> str:
        """What is going on."""
        return self._step.words if self._step is not None else ""

    @property
    def done(self) -> float:
        """Part of the job that is done."""
        return min(1.0, (self._taken + (self._step.done if self._begun else 0.0)) / self._parts)
