# SPDX-License-Identifier: GPL-3.0-or-later
"""Drives a real Blender from inside: installs the zip, renders, and in a window looks at the result as an artist would.

    blender [--background] --python tests/ui/drive.py -- ZIP FOLDER

Writes its pictures and `result.json` into FOLDER. Any exception is written there too, and Blender quits either way.
"""

from __future__ import annotations

import sys
import time
import traceback
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import window as w  # noqa: E402

FOLDER, RESULT = w.FOLDER, w.RESULT


def prepare(width: int, height: int) -> None:
    """Blender's own first scene, in Opal, small and short."""
    scene = bpy.context.scene
    scene.render.engine = "OPAL"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = 4, 4, 10_000
    scene.render.image_settings.file_format = "PNG"


def in_background() -> None:
    w.install()
    prepare(64, 64)
    bpy.context.scene.render.filepath = str(FOLDER / "background.png")
    bpy.ops.render.render(write_still=True)
    RESULT["render"] = w.tones(FOLDER / "background.png")
    print("OK", flush=True)


def in_a_window():
    """Steps; each yields the seconds to leave to Blender before the next."""
    yield 1.0
    with bpy.context.temp_override(window=w.window()):
        w.install()
    prepare(480, 270)
    w.show_tab("RENDER")
    yield 0.5
    finished = []
    bpy.app.handlers.render_complete.append(lambda *_: finished.append("complete"))
    bpy.app.handlers.render_cancel.append(lambda *_: finished.append("cancelled"))
    area = w.area("VIEW_3D")
    with bpy.context.temp_override(window=w.window(), area=area):
        bpy.ops.render.render("INVOKE_DEFAULT")
    until = time.monotonic() + 60
    while not finished and time.monotonic() < until:
        yield 0.25
    RESULT["render_end"] = finished[:1]
    w.show_tab("RENDER")
    yield 1.0
    RESULT["render"] = w.tones(w.screenshot("render"), (0.1, 0.3, 0.7, 0.85))

    area.type = "VIEW_3D"
    space = area.spaces.active
    space.shading.type = "RENDERED"
    bpy.context.scene.opal.samples_per_pass = 1
    for lines in ("floor", "axis_x", "axis_y", "cursor", "extras", "outline_selected"):  # the engine's own words stay
        setattr(space.overlay, f"show_{lines}", False)
    w.show_tab("MATERIAL")
    yield 6.0
    RESULT["viewport"] = w.tones(w.screenshot("viewport"), (0.2, 0.35, 0.6, 0.8))

    # The harder way out: disabled while a view is still rendering with it.
    bpy.context.scene.opal.passes = 10_000
    yield 2.0
    with bpy.context.temp_override(window=w.window()):
        bpy.ops.preferences.addon_disable(module=w.PACKAGE)
    yield 2.0
    RESULT["left_behind"] = [name for name in dir(bpy.types) if name.startswith(("OPAL", "Opal"))]
    engines = [e for e in bpy.types.RenderEngine.__subclasses__() if getattr(e, "bl_idname", "") == "OPAL"]
    RESULT["left_behind"] += ["the engine" for e in engines if getattr(e, "is_registered", False)]
    RESULT["left_behind"] += ["Scene.opal"] if "opal" in bpy.types.Scene.bl_rna.properties else []
    RESULT["engine_after"] = bpy.context.scene.render.engine
    w.screenshot("disabled")


def main() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    if not bpy.app.background:
        w.run(in_a_window())
        return
    try:
        in_background()
    except Exception:
        RESULT["error"] = traceback.format_exc()
    w.write()


main()
