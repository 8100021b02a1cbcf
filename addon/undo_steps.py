# SPDX-License-Identifier: GPL-3.0-or-later
"""How often the artist has undone or redone: a rendered view that was not told of a step reads the scene anew.

Undo replaces data-blocks beneath a view, and Blender does not always call the engine for it.
"""

from __future__ import annotations

from typing import Any

import bpy
from bpy.app.handlers import persistent

count = 0


@persistent
def _on_step(_scene: Any = None, _other: Any = None) -> None:
    global count
    count += 1


def register() -> None:
    bpy.app.handlers.undo_pre.append(_on_step)
    bpy.app.handlers.redo_pre.append(_on_step)


def unregister() -> None:
    bpy.app.handlers.redo_pre.remove(_on_step)
    bpy.app.handlers.undo_pre.remove(_on_step)
