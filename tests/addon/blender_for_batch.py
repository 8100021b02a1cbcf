# SPDX-License-Identifier: GPL-3.0-or-later
"""What `examples/batch.sh` needs of the program `blender`, by bpy: opens a file, runs its expression, renders a frame.

    python blender_for_batch.py -b FILE [-E ENGINE] --python-exit-code CODE --python-expr TEXT [-o PATH -F FORMAT -f FRAME] [-- ...]

Options act in their order, as Blender's do; an exception ends with the code given, an error of the render with 1. OPAL_ZIP names the
extension, which is installed into the caller's profile (BLENDER_USER_RESOURCES) the first time.
"""

import os
import sys
from pathlib import Path

import bpy


def main(options: list[str]) -> int:
    if (Path(os.environ["BLENDER_USER_RESOURCES"]) / "extensions" / "user_default" / "opal").is_dir():
        bpy.ops.preferences.addon_enable(module="bl_ext.user_default.opal")
    else:
        bpy.ops.extensions.package_install_files(filepath=os.environ["OPAL_ZIP"], repo="user_default", enable_on_install=True)
    given = iter(options[: options.index("--")] if "--" in options else options)
    code = 1
    for option in given:
        if option == "-b":
            bpy.ops.wm.open_mainfile(filepath=next(given))
        elif option == "--python-exit-code":
            code = int(next(given))
        elif option == "--python-expr":
            try:
                exec(next(given), {"__name__": "__main__"})
            except Exception as error:
                print(error)
                return code
        elif option == "-E":
            bpy.context.scene.render.engine = next(given)
        elif option == "-o":
            bpy.context.scene.render.filepath = next(given)
        elif option == "-F":
            settings = bpy.context.scene.render.image_settings
            if hasattr(settings, "media_type"):
                settings.media_type = "IMAGE"
            settings.file_format = next(given)
        elif option == "-f":
            bpy.context.scene.frame_set(int(next(given)))
            bpy.ops.render.render(write_still=True)
    return 0


if __name__ == "__main__":
    code = main(sys.argv[1:])
    sys.stdout.flush()
    os._exit(code)
