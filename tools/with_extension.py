# SPDX-License-Identifier: GPL-3.0-or-later
"""Run a script inside bpy with the built zip installed into a scratch profile and enabled.

    python tools/with_extension.py SCRIPT [ARGUMENTS]

The profile (build/profile) is made anew each time, so the script sees what an artist sees after installing the zip.
"""

import os
import runpy
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def main() -> None:
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    profile = ROOT / "build" / "profile"
    shutil.rmtree(profile, ignore_errors=True)
    profile.mkdir(parents=True)
    os.environ["BLENDER_USER_RESOURCES"] = str(profile)  # read when bpy is imported

    import bpy

    zips = sorted((ROOT / "dist").glob("opal-*.zip"))
    if not zips:
        raise SystemExit("dist/ holds no zip: run `make zip`.")
    bpy.ops.extensions.package_install_files(filepath=str(zips[-1]), repo="user_default", enable_on_install=True)
    sys.argv = sys.argv[1:]
    runpy.run_path(sys.argv[0], run_name="__main__")


if __name__ == "__main__":
    main()
