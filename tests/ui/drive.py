# SPDX-License-Identifier: GPL-3.0-or-later
"""Drives a real Blender from inside: installs the zip, renders, and in a window looks at the result as an artist would.

    blender [--background] --python tests/ui/drive.py -- ZIP FOLDER

Writes its pictures and `result.json` into FOLDER. Any exception is written there too, and Blender quits either way.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
import traceback
from pathlib import Path

import bpy

PACKAGE = "bl_ext.user_default.opal"
ZIP, FOLDER = sys.argv[-2], Path(sys.argv[-1])
RESULT: dict[str, object] = {"blender": bpy.app.version_string, "python": sys.version.split()[0]}


def install() -> None:
    bpy.ops.extensions.package_install_files(filepath=ZIP, repo="user_default", enable_on_install=True)
    RESULT["enabled"] = PACKAGE in bpy.context.preferences.addons


def prepare(width: int, height: int) -> None:
    """Blender's own first scene, in Opal, small and short."""
    scene = bpy.context.scene
    scene.render.engine = "OPAL"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = 4, 4, 10_000
    scene.render.image_settings.file_format = "PNG"


def tones(path: Path, box: tuple[float, float, float, float] = (0, 0, 1, 1)) -> dict[str, float]:
    """Mean and spread of the display values of a picture's part (left, bottom, right, top as fractions)."""
    import numpy as np

    image = bpy.data.images.load(str(path), check_existing=False)
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    left, bottom, right, top = box
    part = pixels.reshape(height, width, 4)[int(bottom * height) : int(top * height), int(left * width) : int(right * width), :3]
    return {"width": width, "height": height, "mean": float(part.mean()), "spread": float(part.std())}


def write() -> None:
    (FOLDER / "result.json").write_text(json.dumps(RESULT, indent=1))


def in_background() -> None:
    install()
    prepare(64, 64)
    bpy.context.scene.render.filepath = str(FOLDER / "background.png")
    bpy.ops.render.render(write_still=True)
    RESULT["render"] = tones(FOLDER / "background.png")
    print("OK", flush=True)


def _window():
    return bpy.context.window_manager.windows[0]


def _area(kind: str):
    return max((a for a in _window().screen.areas if a.type == kind), key=lambda a: a.width * a.height)


def _show_tab(context: str) -> None:
    area = _area("PROPERTIES")
    area.spaces.active.context = context
    area.tag_redraw()


def _screenshot(name: str) -> Path:
    """The screen as the display holds it: under software OpenGL Blender's own screenshot reads an empty front buffer."""
    path = FOLDER / f"{name}.png"
    subprocess.run(["import", "-window", "root", str(path)], check=True)
    return path


def in_a_window():
    """Steps; each yields the seconds to leave to Blender before the next."""
    yield 1.0
    with bpy.context.temp_override(window=_window()):
        install()
    prepare(480, 270)
    _show_tab("RENDER")
    yield 0.5
    finished = []
    bpy.app.handlers.render_complete.append(lambda *_: finished.append("complete"))
    bpy.app.handlers.render_cancel.append(lambda *_: finished.append("cancelled"))
    area = _area("VIEW_3D")
    with bpy.context.temp_override(window=_window(), area=area):
        bpy.ops.render.render("INVOKE_DEFAULT")
    until = time.monotonic() + 60
    while not finished and time.monotonic() < until:
        yield 0.25
    RESULT["render_end"] = finished[:1]
    _show_tab("RENDER")
    yield 1.0
    RESULT["render"] = tones(_screenshot("render"), (0.1, 0.3, 0.7, 0.85))

    area.type = "VIEW_3D"
    space = area.spaces.active
    space.shading.type = "RENDERED"
    bpy.context.scene.opal.samples_per_pass = 1
    for lines in ("floor", "axis_x", "axis_y", "cursor", "extras", "outline_selected"):  # the engine's own words stay
        setattr(space.overlay, f"show_{lines}", False)
    _show_tab("MATERIAL")
    yield 20.0
    RESULT["viewport"] = tones(_screenshot("viewport"), (0.2, 0.35, 0.6, 0.8))

    # The harder way out: disabled while a view is still rendering with it.
    bpy.context.scene.opal.passes = 10_000
    yield 2.0
    with bpy.context.temp_override(window=_window()):
        bpy.ops.preferences.addon_disable(module=PACKAGE)
    yield 2.0
    RESULT["left_behind"] = [name for name in dir(bpy.types) if name.startswith(("OPAL", "Opal"))]
    engines = [e for e in bpy.types.RenderEngine.__subclasses__() if getattr(e, "bl_idname", "") == "OPAL"]
    RESULT["left_behind"] += ["the engine" for e in engines if getattr(e, "is_registered", False)]
    RESULT["left_behind"] += ["Scene.opal"] if "opal" in bpy.types.Scene.bl_rna.properties else []
    RESULT["engine_after"] = bpy.context.scene.render.engine
    _screenshot("disabled")


def _stepper(steps):
    def step():
        try:
            return next(steps)
        except StopIteration:
            pass
        except Exception:
            RESULT["error"] = traceback.format_exc()
        write()
        bpy.ops.wm.quit_blender()
        return None

    return step


def main() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    if bpy.app.background:
        try:
            in_background()
        except Exception:
            RESULT["error"] = traceback.format_exc()
        write()
        return
    view = bpy.context.preferences.view
    view.show_splash = False
    view.render_display_type = "AREA"  # no window manager here to raise a second window
    bpy.context.preferences.view.use_save_prompt = False
    bpy.app.timers.register(_stepper(in_a_window()), first_interval=1.0)


main()
