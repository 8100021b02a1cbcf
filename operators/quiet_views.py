# SPDX-License-Identifier: GPL-3.0-or-later
"""Views that render, shown solid for a while.

While a job changes the scene's engine and materials for its own renders, a rendered view would follow these changes, and take the
processors from the job.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy


@contextmanager
def quiet_views() -> Iterator[None]:
    """While it lasts no view renders; then those do that did, as far as they are still there."""
    rendered = {space.as_pointer() for space in _views() if space.shading.type == "RENDERED"}

    def turn(before: str, after: str) -> None:
        for space in _views():
            if space.as_pointer() in rendered and space.shading.type == before:
                space.shading.type = after

    turn("RENDERED", "SOLID")
    try:
        yield
    finally:
        turn("SOLID", "RENDERED")


def _views() -> Iterator[Any]:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            yield from (space for space in area.spaces if space.type == "VIEW_3D")
