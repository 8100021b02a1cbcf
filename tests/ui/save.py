# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the zip for good and saves two files for a farm: one that can be rendered, one that is too large for any memory.

blender --background --python tests/ui/save.py -- ZIP FOLDER
"""

from __future__ import annotations

import sys
import traceback
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parent))
import window as w  # noqa: E402


def main() -> None:
    w.FOLDER.mkdir(parents=True, exist_ok=True)
    try:
        w.install()
        bpy.ops.wm.save_userpref()
        scene = bpy.context.scene
        scene.render.engine = "CYCLES"  # the command names the engine
        scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = 2, 4, 1000
        scene.render.image_settings.file_format = "PNG"
        scene.render.filepath = str(w.FOLDER / "frame_####")
        for name, size in (("scene", 64), ("too_large", 60_000)):
            scene.render.resolution_x = scene.render.resolution_y = size
            scene.render.resolution_percentage = 100
            bpy.ops.wm.save_as_mainfile(filepath=str(w.FOLDER / f"{name}.blend"))
    except Exception:
        w.RESULT["error"] = traceback.format_exc()
    w.write()


main()
