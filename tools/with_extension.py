# SPDX-License-Identifier: GPL-3.0-or-later
"""Run a script inside bpy with the built zip installed into a scratch profile and enabled.

    python tools/with_extension.py SCRIPT [ARGUMENTS]

The profile is a temporary folder of this run's own, so the script sees what an artist sees after installing the zip, and runs beside
each other do not share one.
"""

import os
import runpy
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def main() -> None:
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    with tempfile.TemporaryDirectory(prefix="opal-profile-", ignore_cleanup_errors=True) as profile:
        os.environ["BLENDER_USER_RESOURCES"] = profile  # read when bpy is imported
        run()


def run() -> None:
    import bpy

    zips = sorted((ROOT / "dist").glob("opal-*.zip"))
    if not zips:
        raise SystemExit("dist/ holds no zip: run `make zip`.")
    bpy.ops.extensions.package_install_files(filepath=str(zips[-1]), repo="user_default", enable_on_install=True)
    sys.argv = sys.argv[1:]
    runpy.run_path(sys.argv[0], run_name="__main__")


if __name__ == "__main__":
    main()
