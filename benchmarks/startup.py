# SPDX-License-Identifier: GPL-3.0-or-later
"""What starting costs: importing the kernels, and enabling the extension. Each time in a fresh process; medians."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from statistics import median

IMPORT = "import numpy, time; t = time.perf_counter(); import opal_kernels, opal_kernels.binding, opal_kernels.scene, opal_kernels.render"
ENABLE = """
import os, sys, tempfile, time
os.environ["BLENDER_USER_RESOURCES"] = tempfile.mkdtemp()
import bpy, numpy, addon_utils
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.extensions.package_install_files(filepath=sys.argv[1], repo="user_default", enable_on_install=False)
name = "bl_ext.user_default.opal"
t = time.perf_counter(); addon_utils.enable(name)
assert hasattr(bpy.types.Scene, "opal"), "the extension did not enable"
"""


def _seconds(code: str, *arguments: str) -> float:
    code += "\nprint('SECONDS', time.perf_counter() - t)"
    out = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True).stdout
    return float(next(line for line in reversed(out.splitlines()) if line.startswith("SECONDS")).split()[1])


def measure(repeats: int = 5) -> list[dict]:
    """Records with seconds and the target; enabling is left out where no zip is built."""
    records = [{"what": "import the kernels", "seconds": median(_seconds(IMPORT) for _ in range(repeats)), "target": 0.1}]
    zips = sorted((Path(__file__).resolve().parent.parent / "dist").glob("opal-*.zip"))
    if zips:
        records.append(
            {"what": "enable the extension", "seconds": median(_seconds(ENABLE, str(zips[-1])) for _ in range(repeats)), "target": 0.05}
        )
    return records


def report(records: list[dict]) -> None:
    print("\nstart")
    for r in records:
        print(f"  {r['what']:22s} {1e3 * r['seconds']:7.1f} ms (target {1e3 * r['target']:.0f} ms)")
