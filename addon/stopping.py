# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that may take long, in a thread of its own: Blender only asks whether to stop on the thread that it gave to the engine."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

from opal_kernels.binding import Cancelled

# How long the engine's thread sleeps between looking whether the person wants to stop.
_POLL_SECONDS = 0.03

Result = TypeVar("Result")


class Stopped(Exception):
    """The person stopped the render."""


def _nothing() -> None:
    pass


def run(
    work: Callable[[], Result],
    cancel: Callable[[], None],
    wants_stop: Callable[[], bool],
    tell: Callable[[], None] = _nothing,
    name: str = "Opal",
    owns_all: bool = False,
) -> Result:
    """Does work aside, and returns what it returns or raises what it raises.

    Parameters
    ----------
    work : callable
        Touches nothing of Blender's. It may raise `Cancelled`.
    cancel : callable
        Called once, from this thread, when the person wants to stop; has to make ``work`` return or raise soon.
    wants_stop, tell : callable
        Called on this thread time and again while it works.
    name : str
        The thread's.
    owns_all : bool
        Whether the work touches nothing that the caller goes on with or frees: then nobody waits for its end after a stop.

    Raises
    ------
    Stopped
        If the person wanted to stop, whether the work was done by then or not.
    """
    results: list[Result] = []
    failures: list[BaseException] = []

    def at_work() -> None:
        try:
            results.append(work())
        except BaseException as error:
            failures.append(error)

    worker = threading.Thread(target=at_work, name=name)
    worker.start()
    stopped = False
    while worker.is_alive():
        worker.join(_POLL_SECONDS)
        if not stopped and wants_stop():
            stopped = True
            cancel()
            if owns_all:
                raise Stopped
        tell()
    for failure in failures:
        if not isinstance(failure, Cancelled):
            raise failure
        raise Stopped from failure
    if stopped:
        raise Stopped
    return results[0]
