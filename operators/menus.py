# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the operators stand in Blender's menus; what stands in none is not found by Blender's search (F3) either."""

from __future__ import annotations

from collections.abc import Callable

import bpy

# Menu, and what is appended to it: an operator's name, its text if it is not the operator's own, its icon.
ENTRIES = {
    "VIEW3D_MT_volume_add": (("opal.add_rain", None, "OUTLINER_OB_FORCE_FIELD"),),
    "VIEW3D_MT_object": (("opal.gem_report", None, "NONE"), ("opal.update_twins", None, "NONE")),
    "TOPBAR_MT_file_import": (
        ("opal.import_gemcad", "GemCad (.asc)", "NONE"),
        ("opal.import_absorption", "Absorption of a Gem (.csv)", "NONE"),
    ),
    "TOPBAR_MT_render": (
        ("opal.composite", None, "NODE_COMPOSITING"),
        ("opal.render_layers", None, "RENDERLAYERS"),
        ("opal.compare_cycles", None, "NONE"),
        ("opal.merge", None, "NONE"),
        ("opal.rainbow_chart", None, "NONE"),
    ),
}

_drawers: dict[str, Callable] = {}


def _drawer(entries: tuple) -> Callable:
    def draw(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
        self.layout.separator()
        column = self.layout.column()
        column.operator_context = "INVOKE_DEFAULT"
        for name, text, icon in entries:
            column.operator(name, text=text, icon=icon)

    return draw


def register() -> None:
    """Append Opal's entries."""
    for menu, entries in ENTRIES.items():
        _drawers[menu] = _drawer(entries)
        getattr(bpy.types, menu).append(_drawers[menu])


def unregister() -> None:
    """Take them away again."""
    for menu, draw in _drawers.items():
        getattr(bpy.types, menu).remove(draw)
    _drawers.clear()
