# SPDX-License-Identifier: GPL-3.0-or-later
"""Drives a window by mouse and keys: a gem from the menu, F12, Escape, the rendered view, the comparison, the gem report, panels.

    blender --python tests/ui/keys.py -- ZIP FOLDER

Writes its pictures and `result.json` into FOLDER. Any exception is written there too, and Blender quits either way.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import long_jobs  # noqa: E402
import window as w  # noqa: E402

RESULT = w.RESULT


def prepare():
    """Blender's own first scene without its cube, in Opal."""
    scene = bpy.context.scene
    scene.render.engine = "OPAL"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 480, 270, 100
    scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = 4, 4, 10_000
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.mesh.primitive_plane_add(size=10, location=(0, 0, -0.001))
    camera = scene.camera
    camera.location, camera.rotation_euler = (0, -0.03, 0.02), (0.98, 0, 0)
    camera.data.clip_start = 0.001


def add_gem_from_the_menu():
    """Shift A, then the entry by its name, as Blender's menus are searched."""
    view = w.area("VIEW_3D")
    before = set(bpy.data.objects.keys())
    w.point_at(view, 0.4, 0.6)
    yield 0.5
    w.press("shift+a")
    yield 1.0
    w.screenshot("menu")
    w.write_text("round brilliant")
    yield 1.0
    w.screenshot("menu_searched")
    w.press("Return")
    yield from w.until(lambda: set(bpy.data.objects.keys()) - before, 10, "a gem from the menu")
    gem = bpy.data.objects[next(iter(set(bpy.data.objects.keys()) - before))]
    RESULT["gem"] = {"name": gem.name, "kind": gem.active_material.opal.kind, "selected": gem.select_get()}
    begun = time.monotonic()
    gem.active_material.opal.gem.species = "RUBY"
    RESULT["species_seconds"] = time.monotonic() - begun
    gem.location = (0, 0, 0.003)
    w.show_tab("MATERIAL")
    yield 1.0
    RESULT["material_panel"] = w.tones(w.screenshot("material"), w.box_of(w.area("PROPERTIES")))
    RESULT["species"] = gem.active_material.opal.gem.species


def search():
    """F3 finds what has no other key: the twins are brought up to date."""
    w.point_at(w.area("VIEW_3D"), 0.5, 0.6)
    yield 0.5
    w.press("F3")
    yield 1.0
    w.write_text("update twins")
    yield 1.0
    w.screenshot("searched")
    w.press("Return")
    yield 1.0
    RESULT["searched"] = [operator.bl_idname for operator in bpy.context.window_manager.operators][-1:]


def render_and_escape():
    """F12, the words that Blender shows of it, then Escape; how long that takes, and what is left."""
    scene = bpy.context.scene
    words, ended = [], []
    bpy.app.handlers.render_stats.append(lambda text, *_: words.append(str(text)))
    bpy.app.handlers.render_complete.append(lambda *_: ended.append("complete"))
    bpy.app.handlers.render_cancel.append(lambda *_: ended.append(time.monotonic()))
    scene.opal.passes, scene.opal.samples_per_pass = 10_000, 16
    w.point_at(w.area("VIEW_3D"), 0.5, 0.6)
    yield 0.5
    w.press("F12")
    yield from w.until(lambda: bpy.app.is_job_running("RENDER"), 15, "a render after F12")
    yield from w.until(lambda: any("Pass 2" in text for text in words), 90, "the second pass")
    yield 1.5
    RESULT["while_rendering"] = w.tones(w.screenshot("rendering"), w.box_of(w.area("IMAGE_EDITOR")))
    w.point_at(w.area("IMAGE_EDITOR"), 0.5, 0.5)
    yield 0.2
    w.press("Escape")
    begun = time.monotonic()
    while bpy.app.is_job_running("RENDER") and time.monotonic() < begun + 20:
        yield 0.01
    RESULT["escape_seconds"] = time.monotonic() - begun
    RESULT["stopped"] = bool(ended) and ended[0] != "complete"
    RESULT["words"] = sorted({text for text in words if "Pass" in text})[:3]
    yield 0.5
    RESULT["after_escape"] = w.tones(w.screenshot("escaped"), w.box_of(w.area("IMAGE_EDITOR")))
    w.press("Escape")  # back to the 3D view
    yield 0.5
    for editor in w.window().screen.areas:
        if editor.type == "IMAGE_EDITOR":
            editor.type = "VIEW_3D"
    scene.opal.passes, scene.opal.samples_per_pass = 4, 4
    yield 0.5


def look_at_the_rendered_view():
    """The view through the camera: a first picture, which refines; a colour that is changed shows."""
    view = w.area("VIEW_3D")
    space = view.spaces.active
    space.region_3d.view_perspective = "CAMERA"
    space.overlay.show_overlays = False
    bpy.context.scene.opal.passes = 1000
    space.shading.type = "RENDERED"
    box = _middle(view)
    yield from w.seen("view_first", box, lambda t: t["grain"] > 0.02 and t["colourful"] > 0.3)
    first = RESULT["view_first"]
    yield from w.seen("view_later", box, lambda t: t["spread"] > 0.05 and t["grain"] < 0.7 * first["grain"])
    ruby = RESULT["view_later"]
    bpy.context.object.active_material.opal.gem.species = "EMERALD"
    yield from w.seen("view_edited", box, lambda t: t["green"] - t["red"] > ruby["green"] - ruby["red"] + 0.005)
    # What is rendered goes away, and comes back.
    bpy.ops.ed.undo_push(message="the stone")
    with bpy.context.temp_override(window=w.window(), area=view):
        bpy.ops.object.delete("EXEC_DEFAULT", True)
    yield from w.seen("view_deleted", box, lambda t: t["spread"] < 0.5 * ruby["spread"])
    with bpy.context.temp_override(window=w.window()):
        bpy.ops.ed.undo()
    yield from w.seen("view_undone", box, lambda t: t["spread"] > 0.8 * ruby["spread"])
    w.area("VIEW_3D").spaces.active.shading.type = "SOLID"
    yield 0.5


def _middle(editor):
    left, bottom, right, top = w.box_of(editor)
    width, height = right - left, top - bottom
    return left + 0.35 * width, bottom + 0.3 * height, left + 0.65 * width, bottom + 0.7 * height


def compare():
    """The comparison opens its picture."""
    yield from long_jobs.run()
    yield 2.0
    shown = [
        (win, a)
        for win in bpy.context.window_manager.windows
        for a in win.screen.areas
        if a.type == "IMAGE_EDITOR" and a.spaces.active.image is not None
    ]
    RESULT["compare_shown"] = [a.spaces.active.image.name for _, a in shown]
    w.screenshot("compared")
    for other in bpy.context.window_manager.windows[1:]:
        with bpy.context.temp_override(window=other):
            bpy.ops.wm.window_close()
    long_jobs.undo()
    yield 1.0


def stop_the_gem_report():
    """The gem's report in the background of the interface, and Escape."""
    gem = next(o for o in bpy.data.objects if o.active_material is not None and o.active_material.opal.kind == "GEM")
    bpy.context.view_layer.objects.active = gem
    view = w.area("VIEW_3D")
    with bpy.context.temp_override(window=w.window(), area=view, region=next(r for r in view.regions if r.type == "WINDOW")):
        RESULT["report"] = sorted(bpy.ops.opal.gem_report("INVOKE_DEFAULT", passes=256, size=512))

    def runs():
        return any("gem_report" in o.bl_idname.lower() for o in w.window().modal_operators)

    yield 1.0
    RESULT["report_runs"] = runs()
    w.point_at(view, 0.5, 0.5)
    yield 0.3
    w.screenshot("report")
    w.press("Escape")
    begun = time.monotonic()
    while runs() and time.monotonic() < begun + 20:
        yield 0.01
    RESULT["report_escape_seconds"] = time.monotonic() - begun


def look_at_the_curves():
    """The pictures of n(lambda) and of a lamp's spectrum in their panels."""
    w.show_tab("MATERIAL")
    yield 1.0
    RESULT["gem_curve"] = w.tones(w.screenshot("curve_gem"), w.box_of(w.area("PROPERTIES")))
    lamp = next(o for o in bpy.data.objects if o.type == "LIGHT")
    for spectrum in ("COLOR", "F11"):
        lamp.data.opal.spectrum = spectrum
        bpy.context.view_layer.objects.active = lamp
        yield 0.5
        w.show_tab("DATA")
        yield 1.5
        RESULT[f"lamp_{spectrum}"] = w.tones(w.screenshot(f"curve_lamp_{spectrum}"), w.box_of(w.area("PROPERTIES")))


def click_on_a_line_of_the_report():
    """A render that names an object; a click of the mouse on that line selects it."""
    scene = bpy.context.scene
    flat = bpy.data.objects.new("Flattened", bpy.data.meshes.new_from_object(next(o for o in bpy.data.objects if o.type == "MESH")))
    flat.scale = (0, 0, 0)
    scene.collection.objects.link(flat)
    for obj in bpy.context.view_layer.objects:
        obj.select_set(False)
    scene.opal.passes, scene.render.resolution_percentage = 1, 10
    ended = []
    bpy.app.handlers.render_complete.append(lambda *_: ended.append(1))
    bpy.ops.render.render()
    yield from w.until(lambda: bool(ended), 30, "a render with a report")
    others = [
        kind
        for kind in (getattr(bpy.types, name) for name in dir(bpy.types) if "_PT_" in name)
        if getattr(kind, "bl_context", "") == "render" and kind.__name__ != "OPAL_RENDER_PT_report"
    ]
    own = {kind: kind.__dict__.get("poll") for kind in others}
    for kind in others:  # the report alone, so that it is in sight
        kind.poll = classmethod(lambda _cls, _context: False)
    w.show_tab("RENDER")
    yield 2.0
    editor = w.area("PROPERTIES")
    picture = w.screenshot("report_list")
    RESULT["report_line"] = [(item.owner, item.kind) for item in bpy.context.window_manager.opal_report]
    RESULT["report_selected_before"] = [o.name for o in bpy.context.selected_objects]
    RESULT["report_list"] = w.tones(picture, w.box_of(editor))
    # The list's active line is blue; the name stands in its left half, right of the icons.
    part = w.pixels(picture, w.box_of(editor))
    blue = ((part[..., 2] - part[..., 0]) > 0.2).sum(axis=1)
    rows = [number for number, count in enumerate(blue) if count > 0.5 * part.shape[1]]
    RESULT["report_line_rows"] = len(rows)
    w.point_at(editor, 0.33, (rows[len(rows) // 2] + 0.5) / part.shape[0])
    yield 0.5
    w.click()
    yield 0.5
    w.screenshot("report_clicked")
    RESULT["report_selected"] = [o.name for o in bpy.context.selected_objects]
    for kind, poll in own.items():
        if poll is None:
            del kind.poll
        else:
            kind.poll = poll


def leave():
    """Disabled, nothing of it is left."""
    with bpy.context.temp_override(window=w.window()):
        bpy.ops.preferences.addon_disable(module=w.PACKAGE)
    yield 1.0
    RESULT["left_behind"] = [name for name in dir(bpy.types) if name.startswith(("OPAL", "Opal"))]
    w.screenshot("left")


# Screenshots whose structure is compared with `blocks.json`, and the part of the screen that is looked at.
STRUCTURES = {
    "rendering": (0.0, 0.1, 0.82, 0.94),
    "view_later": (0.2, 0.33, 0.62, 0.74),
    "curve_gem": (0.845, 0.03, 0.995, 0.72),
    "report_list": (0.845, 0.03, 0.995, 0.72),
}


def steps():
    yield 1.0
    with bpy.context.temp_override(window=w.window()):
        w.install()
    prepare()
    w.show_tab("RENDER")
    yield 1.0
    for part in (
        add_gem_from_the_menu,
        search,
        render_and_escape,
        look_at_the_rendered_view,
        compare,
        stop_the_gem_report,
        look_at_the_curves,
        click_on_a_line_of_the_report,
        leave,
    ):
        yield from part()
        w.write()
    RESULT["blocks"] = {name: w.blocks(w.FOLDER / f"{name}.png", box) for name, box in STRUCTURES.items()}


w.run(steps())
