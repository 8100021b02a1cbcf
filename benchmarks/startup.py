# SPDX-License-Identifier: GPL-3.0-or-later
"""What starting costs: importing the kernels, and enabling the extension.

Each time in a fresh process; medians. A first start after installation has to compile every module it loads (cold); later ones
find Python's bytecode beside them (warm), which is what every start of Blender costs from then on. Blender has NumPy loaded in the
`bpy` wheel; the extension itself loads none while it is enabled, which is said by `numpy`.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

IMPORT = "import numpy, time; t = time.perf_counter(); import opal_kernels, opal_kernels.binding, opal_kernels.scene, opal_kernels.render"
INSTALL = """
import bpy, sys, time
t = time.perf_counter()
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.extensions.package_install_files(filepath=sys.argv[1], repo="user_default", enable_on_install=False)
"""
ENABLE = """
import bpy, addon_utils, sys, time
name = "bl_ext.user_default.opal"
t = time.perf_counter(); addon_utils.enable(name)
assert hasattr(bpy.types.Scene, "opal"), "the extension did not enable"
assert not any(hasattr(m, "np") for n, m in list(sys.modules.items()) if n.startswith(name)), "enabling loads NumPy"
"""


def _seconds(code: str, *arguments: str, profile: str = "", bytecode: bool = True) -> float:
    """Seconds since the code's `t`, in a process of its own; `bytecode` says whether Python may keep what it compiles."""
    code += "\nprint('SECONDS', time.perf_counter() - t)\nsys.stdout.flush()\nimport os; os._exit(0)"
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"} | {"BLENDER_USER_RESOURCES": profile}
    if not bytecode:
        environment["PYTHONDONTWRITEBYTECODE"] = "1"
    run = [sys.executable, "-c", "import sys\n" + code, *arguments]
    out = subprocess.run(run, capture_output=True, text=True, check=True, env=environment).stdout
    return float(next(line for line in reversed(out.splitlines()) if line.startswith("SECONDS")).split()[1])


def measure(repeats: int = 5) -> list[dict]:
    """Records with seconds and the target; enabling is left out where no zip is built."""
    records = [{"what": "import the kernels", "seconds": median(_seconds(IMPORT) for _ in range(repeats)), "target": 0.1}]
    zips = sorted((Path(__file__).resolve().parent.parent / "dist").glob("opal-*.zip"))
    if zips:
        with tempfile.TemporaryDirectory(prefix="opal-startup-") as profile:
            _seconds(INSTALL, str(zips[-1]), profile=profile, bytecode=False)
            cold = [_seconds(ENABLE, profile=profile, bytecode=False) for _ in range(repeats)]
            _seconds(ENABLE, profile=profile)
            warm = [_seconds(ENABLE, profile=profile) for _ in range(repeats)]
        records.append({"what": "enable the extension", "seconds": median(warm), "target": 0.05})
        records.append({"what": "the same, first time (compiles)", "seconds": median(cold), "target": None})
    return records


def report(records: list[dict]) -> None:
    print("\nstart")
    for r in records:
        target = f" (target {1e3 * r['target']:.0f} ms)" if r["target"] else ""
        print(f"  {r['what']:32s} {1e3 * r['seconds']:7.1f} ms{target}")


if __name__ == "__main__":
    report(measure())
