# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparison and composite as the interface starts them: what they show while they run, Escape in either engine's part, the pictures.

Part of `keys.py`, whose scene they render.
"""

from __future__ import annotations

import time

import bpy
import numpy as np
import window as w

RESULT = w.RESULT
# What Blender shows at the window's foot: the job's words, or what the mouse would do.
_FOOT = (0.0, 0.0, 0.6, 0.022)


def _settings():
    """What the jobs change for a while."""
    scene, view = bpy.context.scene, bpy.context.preferences.view
    found = {
        f"{owner.bl_rna.identifier}.{name}": getattr(owner, name)
        for owner in (scene.render, scene.render.image_settings, scene.cycles, scene.opal)
        for name in owner.bl_rna.properties.keys()
        if not owner.is_property_readonly(name) and isinstance(getattr(owner, name), str | int | float)
    }
    found |= {f"{material.name} nodes": sorted(material.node_tree.nodes.keys()) for material in bpy.data.materials if material.node_tree}
    found |= {f"{layer.name} use": layer.use for layer in scene.view_layers} | {f"{o.name} hidden": o.hide_render for o in scene.objects}
    found["shading"] = w.area("VIEW_3D").spaces.active.shading.type
    return found | {"display": view.render_display_type, "locked": bpy.context.window_manager.is_interface_locked}


def _pictures():
    return sorted(image.name for image in bpy.data.images if image.get("opal_picture"))


def _texts(name):
    return {image.name: np.array(image.pixels) for image in bpy.data.images if image.name in name}


def _runs(name):
    return any(name in operator.bl_idname.lower() for operator in w.window().modal_operators)


def _invoke(name, **settings):
    view = w.area("VIEW_3D")
    with bpy.context.temp_override(window=w.window(), area=view, region=next(r for r in view.regions if r.type == "WINDOW")):
        return sorted(getattr(bpy.ops.opal, name)("INVOKE_DEFAULT", **settings))


def _stopped(key, name, is_there, **settings):
    """Starts a job, presses Escape when a part of it is under way, and keeps what is different afterwards."""
    before, foot = _settings(), w.pixels(w.screenshot("foot"), _FOOT)
    words = []
    bpy.app.handlers.render_stats.append(lambda text, *_: words.append(f"{bpy.context.scene.render.engine} {text}"))
    found = RESULT[key] = {"begun": _invoke(name, **settings)}
    yield from w.until(lambda: any(is_there(text) for text in words), 60, f"{name} to render")
    yield 0.7
    picture = w.screenshot(key)
    foot_now = w.pixels(picture, _FOOT)
    found["view"] = w.tones(picture, w.box_of(w.area("VIEW_3D")))
    found["foot_changed"] = float(np.abs(foot_now - foot).max())
    found["ran"] = _runs(name)
    try:
        bpy.ops.opal.render_layers()
        found["other"] = "was begun"
    except RuntimeError as error:
        found["other"] = str(error)
    w.point_at(w.area("VIEW_3D"), 0.5, 0.5)
    yield 0.2
    w.press("x")  # would ask to delete what is selected
    yield 0.2
    w.press("Return")
    yield 0.2
    w.press("Escape")
    begun = time.monotonic()
    while _runs(name) and time.monotonic() < begun + 20:
        yield 0.02
    found["escape_seconds"] = time.monotonic() - begun
    yield 0.5
    after = _settings()
    found["changed"] = sorted(key for key in before.keys() | after.keys() if before.get(key) != after.get(key))
    found["pictures"] = _pictures()
    found["foot_changed_back"] = float(np.abs(w.pixels(w.screenshot(f"{key}_after"), _FOOT) - foot_now).max())
    bpy.app.handlers.render_stats.pop()


def run():
    """Stopped in Opal's part, stopped in Cycles' part, undone, and run to the end by either way."""
    scene = bpy.context.scene
    scene.cycles.device = "CPU"
    scene.opal.passes, scene.render.resolution_percentage = 10_000, 25
    yield from _stopped("stopped_opal", "compare_cycles", lambda text: "OPAL" in text and "Pass" in text)
    scene.opal.passes = 2
    w.area("VIEW_3D").spaces.active.shading.type = "RENDERED"
    yield 0.5
    yield from _stopped("stopped_cycles", "composite", lambda text: "CYCLES" in text and "Sample" in text, samples=1_000_000)

    w.area("VIEW_3D").spaces.active.shading.type = "SOLID"
    scene.opal.passes = 10_000
    with bpy.context.temp_override(window=w.window()):
        bpy.ops.ed.undo_push(message="before the job")
    before = _settings()
    _invoke("composite")
    yield from w.until(lambda: bpy.app.is_job_running("RENDER"), 20, "the composite to render")
    yield 0.3
    with bpy.context.temp_override(window=w.window()):
        bpy.ops.ed.undo_push(message="in the midst")
        bpy.ops.ed.undo()
    yield from w.until(lambda: not _runs("composite"), 20, "the composite to end by undo")
    after = _settings()
    RESULT["undone"] = {"changed": sorted(key for key in before if before[key] != after.get(key)), "pictures": _pictures()}

    bpy.context.scene.opal.passes = 2
    with bpy.context.temp_override(window=w.window(), area=w.area("VIEW_3D")):
        RESULT["compare"] = sorted(bpy.ops.opal.compare_cycles())
    names = _pictures()
    waited = _texts(names)
    for name in names:
        bpy.data.images.remove(bpy.data.images[name])
    yield 0.5
    bpy.ops.ed.undo_push(message="before the comparison")
    before = _settings()
    _invoke("compare_cycles")
    yield from w.until(lambda: not _runs("compare_cycles"), 40, "the comparison to end")
    after = _settings()
    stepwise = _texts(names)
    RESULT["finished"] = {
        "pictures": names,
        "stepwise": sorted(stepwise),
        "apart": {
            name: float(np.abs(stepwise[name] - waited[name]).max()) for name in stepwise if stepwise[name].shape == waited[name].shape
        },
        "changed": sorted(key for key in before if before[key] != after.get(key)),
    }


def undo():
    """One step back: the comparison has made its own."""
    with bpy.context.temp_override(window=w.window()):
        bpy.ops.ed.undo()
    RESULT["finished"]["undone"] = _pictures()
