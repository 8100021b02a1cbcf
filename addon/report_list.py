# SPDX-License-Identifier: GPL-3.0-or-later
"""The report as a list in the render tab: what is missing, what is shown in another way, and a click that leads to it.

Blender draws lists from properties, and a panel may not write any while it is drawn: where the list is older than the report
(`report`), drawing asks for a timer that fills it. It lives on the window manager, which no undo touches.
"""

from __future__ import annotations

import textwrap
from typing import Any

import bpy
from bpy.props import BoolProperty, CollectionProperty, IntProperty, StringProperty

from . import report
from .panels import OpalPanel

LOST_ICON, CHANGED_ICON = "ERROR", "INFO"
_KIND_ICONS = {
    "OBJECT": "OBJECT_DATA",
    "MATERIAL": "MATERIAL",
    "WORLD": "WORLD",
    "LIGHT": "LIGHT",
    "CAMERA": "CAMERA_DATA",
    "IMAGE": "IMAGE_DATA",
    "MESH": "MESH_DATA",
}

# Scene and entries that the list shows.
_shown: tuple[Any, ...] = ()


class OpalReportItem(bpy.types.PropertyGroup):
    """A line of the report."""

    owner: StringProperty(name="Owner", description="Name of what the line is about")
    part: StringProperty(name="Part", description="The node or the setting that the line is about")
    message: StringProperty(name="Message", description="What could not be done, and what was done instead")
    lost: BoolProperty(name="Missing", description="Whether it is missing from the picture; what is not is only shown in another way")
    kind: StringProperty(name="Kind", description="What kind of data-block the line is about")


class OPAL_UL_report(bpy.types.UIList):
    """Lines of the report; searched by everything that they say."""

    def draw_item(self, _context: Any, layout: Any, _data: Any, item: Any, _icon: int, _active: Any, _name: str, index: int) -> None:
        split = layout.split(factor=0.5)
        row = split.row(align=True)
        row.alignment = "LEFT"
        row.label(text="", icon=LOST_ICON if item.lost else CHANGED_ICON)
        if item.owner:
            button = row.operator(
                "opal.select_reported", text=item.owner, icon=_KIND_ICONS.get(item.kind, "NONE"), emboss=False, translate=False
            )
            button.index = index
        else:
            row.label(text="Scene", icon="SCENE_DATA")
        split.label(text=f"{item.part}: {item.message}" if item.part else item.message, translate=False)

    def filter_items(self, _context: Any, data: Any, name: str) -> tuple[list[int], list[int]]:
        items, wanted = getattr(data, name), self.filter_name.lower()
        if not wanted:
            return [], []
        return [self.bitflag_filter_item if wanted in " ".join((i.owner, i.part, i.message)).lower() else 0 for i in items], []


def _state(scene: Any) -> tuple[Any, ...]:
    return scene.session_uid, *report.of(scene).entries


def is_current(scene: Any) -> bool:
    """Whether the list shows the scene's report."""
    return _shown == _state(scene)


def fill(scene: Any = None) -> None:
    """Writes the report of a scene, the window's where none is given, into the list, and has the panels drawn again."""
    global _shown
    scene, manager = scene or bpy.context.scene, bpy.context.window_manager
    if scene is None or manager is None or not hasattr(manager, "opal_report"):
        return
    manager.opal_report.clear()
    for entry in report.of(scene).entries:
        item = manager.opal_report.add()
        item.name = item.owner = entry.owner
        item.part, item.message, item.lost, item.kind = entry.part, entry.message, entry.lost, entry.kind
    manager.opal_report_index = min(manager.opal_report_index, max(0, len(manager.opal_report) - 1))
    _shown = _state(scene)
    for window in manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()


class OPAL_RENDER_PT_report(OpalPanel):
    """What the last render could not do as set."""

    bl_label = "Report"
    bl_context = "render"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and bool(report.of(context.scene).entries)

    def draw_header(self, context: Any) -> None:
        lost = any(entry.lost for entry in report.of(context.scene).entries)
        self.layout.label(text="", icon=LOST_ICON if lost else CHANGED_ICON)

    def draw(self, context: Any) -> None:
        layout, manager = self.layout, context.window_manager
        if not is_current(context.scene):
            if not bpy.app.timers.is_registered(fill):
                bpy.app.timers.register(fill, first_interval=0.0)
            layout.label(text=f"{len(report.of(context.scene).entries)} notes", translate=False)
            return
        layout.template_list("OPAL_UL_report", "", manager, "opal_report", manager, "opal_report_index", rows=3, maxrows=8)
        if manager.opal_report_index < len(manager.opal_report):
            item = manager.opal_report[manager.opal_report_index]
            column = layout.box().column(align=True)
            column.scale_y = 0.8
            for line in _wrapped(item, context):
                column.label(text=line, translate=False)


def _wrapped(item: Any, context: Any) -> list[str]:
    """A line of the list in full, as wide as the panel."""
    text = ": ".join(part for part in (item.owner, item.part, item.message) if part)
    scale = context.preferences.system.ui_scale
    width = context.region.width if context.region is not None else 400
    return textwrap.wrap(text, max(24, int(width / (7.0 * scale)) - 6))


_CLASSES = (OpalReportItem, OPAL_UL_report, OPAL_RENDER_PT_report)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    options = {"SKIP_SAVE"}
    bpy.types.WindowManager.opal_report = CollectionProperty(
        type=OpalReportItem, name="Report", description="What the last render could not do as set", options=options
    )
    bpy.types.WindowManager.opal_report_index = IntProperty(
        name="Line", description="The line of the report that is shown in full", default=0, min=0, options=options
    )


def unregister() -> None:
    global _shown
    _shown = ()
    if bpy.app.timers.is_registered(fill):
        bpy.app.timers.unregister(fill)
    del bpy.types.WindowManager.opal_report_index
    del bpy.types.WindowManager.opal_report
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
