# SPDX-License-Identifier: GPL-3.0-or-later
"""From a line of the report to what it is about: selects the objects that show it, or turns the properties to the world."""

from collections.abc import Callable, Iterable
from typing import Any

import bpy
from bpy.props import IntProperty

from ..addon import report
from ..addon.identity import key_of


class OPAL_OT_select_reported(bpy.types.Operator):
    """Select what the report names"""

    bl_idname = "opal.select_reported"
    bl_label = "Select Reported"
    bl_description = "Select the objects that a line of the last render's report is about; for a material, image or lamp, those that use it"
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(name="Line", description="Which line of the report is meant, counted from 0", default=0, min=0)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or not report.of(context.scene).entries:
            cls.poll_message_set("The last render has nothing to report")
            return False
        if context.mode != "OBJECT":
            cls.poll_message_set("Objects are selected in Object Mode")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        entries = list(report.of(context.scene).entries)
        if self.index >= len(entries):
            self.report({"ERROR"}, f"The report has {len(entries)} lines: there is no line {self.index}.")
            return {"CANCELLED"}
        entry = entries[self.index]
        manager = context.window_manager
        manager.opal_report_index = min(self.index, max(0, len(manager.opal_report) - 1))
        if entry.kind in {"", "WORLD", "SCENE"}:
            _show_tab(context, "WORLD" if entry.kind == "WORLD" else "RENDER")
            self.report({"INFO"}, str(entry))
            return {"FINISHED"}
        if not _exists(entry):
            self.report({"WARNING"}, f"“{entry.owner}” is no longer in this file.")
            return {"CANCELLED"}
        found = objects_of(entry, context)
        shown = [obj for obj in found if obj.visible_get(view_layer=context.view_layer) and not obj.hide_select]
        if not shown:
            reason = "is hidden or cannot be selected" if found else "belongs to no object of this view layer"
            self.report({"WARNING"}, f"“{entry.owner}” {reason}.")
            return {"CANCELLED"}
        _select(shown, entry, context)
        names = ", ".join(f"“{obj.name}”" for obj in shown[:3]) + ("…" if len(shown) > 3 else "")
        self.report({"INFO"}, f"Selected {names}: {entry.message}")
        return {"FINISHED"}


_COLLECTIONS = {
    "OBJECT": "objects",
    "MATERIAL": "materials",
    "LIGHT": "lights",
    "CAMERA": "cameras",
    "IMAGE": "images",
    "MESH": "meshes",
    "VOLUME": "volumes",
}


def _exists(entry: report.Entry) -> bool:
    blocks = getattr(bpy.data, _COLLECTIONS.get(entry.kind, ""), ())
    return any(key_of(block) == entry.key for block in blocks)


def objects_of(entry: report.Entry, context: Any) -> list[Any]:
    """The view layer's objects that show what an entry is about; what shows it only as an instance is found by its instancer."""
    shows = _test_of(entry)
    found = [obj for obj in context.view_layer.objects if shows(obj)]
    if found:
        return found
    parents = {}
    for instance in context.evaluated_depsgraph_get().object_instances:
        if instance.is_instance and instance.parent is not None and shows(instance.object.original):
            parents[key_of(instance.parent)] = instance.parent.original
    return [obj for obj in context.view_layer.objects if key_of(obj) in parents]


def _test_of(entry: report.Entry) -> Callable[[Any], bool]:
    """Whether an original object shows what an entry is about."""
    if entry.kind == "OBJECT":
        return lambda obj: key_of(obj) == entry.key
    if entry.kind == "MATERIAL":
        return lambda obj: any(key_of(material) == entry.key for material in _materials(obj))
    if entry.kind == "IMAGE":
        return lambda obj: any(_shows_image(material.node_tree, entry.key, set()) for material in _materials(obj))
    return lambda obj: obj.data is not None and key_of(obj.data) == entry.key


def _materials(obj: Any) -> Iterable[Any]:
    return (slot.material for slot in obj.material_slots if slot.material is not None)


def _shows_image(tree: Any, key: Any, seen: set[Any]) -> bool:
    """Whether a node tree or a group in it has a node with the image."""
    if tree is None or tree in seen:
        return False
    seen.add(tree)
    for node in tree.nodes:
        image = getattr(node, "image", None)
        if (image is not None and key_of(image) == key) or _shows_image(getattr(node, "node_tree", None), key, seen):
            return True
    return False


def _select(objects: list[Any], entry: report.Entry, context: Any) -> None:
    for obj in context.view_layer.objects:
        obj.select_set(obj in objects)
    active = objects[0]
    context.view_layer.objects.active = active
    if entry.kind == "MATERIAL":
        for number, slot in enumerate(active.material_slots):
            if slot.material is not None and key_of(slot.material) == entry.key and active.library is None:
                active.active_material_index = number
                break


def _show_tab(context: Any, tab: str) -> None:
    """Turns the properties editor that was clicked in to a tab; nothing where there is none."""
    space = context.space_data
    if space is not None and space.type == "PROPERTIES":
        space.context = tab


def register() -> None:
    bpy.utils.register_class(OPAL_OT_select_reported)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_select_reported)
