# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading Blender's data while nobody can delete it.

F12 renders in a thread of Blender's own while the interface goes on, and the list of a depsgraph's instances looks into the original
objects. What is deleted meanwhile is freed beneath it, and Blender ends. Deletions come from the main thread; so what must not be
disturbed is called there, and first asks whether all that the depsgraph shows is still in the file.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, TypeVar

import bpy

Result = TypeVar("Result")

# A main thread that does not come within so many seconds is waiting for something else: the caller's thread reads.
_PATIENCE = 2.0
# How long the caller sleeps between looking whether the person wants to stop.
_POLL_SECONDS = 0.02
_KINDS = (
    (bpy.types.Object, "objects"),
    (bpy.types.Mesh, "meshes"),
    (bpy.types.Material, "materials"),
    (bpy.types.Light, "lights"),
    (bpy.types.Camera, "cameras"),
    (bpy.types.World, "worlds"),
    (bpy.types.Collection, "collections"),
)


def call(function: Callable[[], Result], on_wait: Callable[[], None]) -> Result:
    """Calls a function on the main thread, or here where that is the same or where there is no interface.

    Parameters
    ----------
    function : callable
        What it returns or raises comes back.
    on_wait : callable
        Called while the main thread does something else; may raise, and then nothing is called any more.
    """
    if bpy.app.background or threading.current_thread() is threading.main_thread():
        return function()
    turn, done = threading.Lock(), threading.Event()
    results: list[Result] = []
    failures: list[BaseException] = []

    def run() -> None:
        if not turn.acquire(blocking=False):
            return  # the caller no longer waits
        try:
            results.append(function())
        except BaseException as error:
            failures.append(error)
        finally:
            done.set()

    bpy.app.timers.register(run, first_interval=0.0)
    waited = 0.0
    try:
        while not done.wait(_POLL_SECONDS):
            waited += _POLL_SECONDS
            if turn.locked():
                continue
            on_wait()
            if waited >= _PATIENCE and turn.acquire(blocking=False):
                return function()
    except BaseException:
        turn.acquire(blocking=False)
        raise
    if failures:
        raise failures[0]
    return results[0]


def deleted(depsgraph: Any) -> list[str]:
    """Names of what a depsgraph of this file shows and what is no longer in the file; looks at no original that may be gone.

    An evaluated copy knows neither the number nor, safely, the address of its original. So every block that is in the file is asked
    for its copy, and copies that none of them has are of what was deleted.
    """
    kept = {kind: {block.evaluated_get(depsgraph).as_pointer() for block in getattr(bpy.data, name)} for kind, name in _KINDS}
    gone = []
    for block in depsgraph.ids:
        for kind, copies in kept.items():
            if isinstance(block, kind) and not block.is_embedded_data and block.as_pointer() not in copies:
                gone.append(block.name)
    return gone
