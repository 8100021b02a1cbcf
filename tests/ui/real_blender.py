# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a script of this folder in a Blender as a distribution ships it, and gives back what the script wrote down.

That Blender lives in a root folder of its own, into which the tool mounts the current folder. A checkout that was deleted and
made again leaves a dead mount at its own path, on which nothing can be mounted any more; so everything the Blender needs is laid
into a temporary folder, under /tmp, which is always shown, and what it wrote is copied back.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BLENDER = ROOT.parent / "shared" / "tools" / "real-blender"
SCREENSHOTS = ROOT / "build" / "screenshots"


def drive(scratch: Path, *arguments: str, script: str = "drive.py", keep: Path | None = None):
    """Runs a script of this folder in the real Blender; (its result, everything it printed). What it wrote is kept in `keep`."""
    if not BLENDER.exists():
        pytest.skip("no real Blender on this machine: shared/tools/real-blender is absent")
    zips = sorted((ROOT / "dist").glob("opal-*.zip"))
    if not zips:
        pytest.skip("dist/ holds no zip: run `make test`")
    folder, scripts = scratch / "result", scratch / "scripts"
    folder.mkdir()
    shutil.copytree(HERE, scripts, ignore=shutil.ignore_patterns("__pycache__"))
    package = shutil.copy(zips[-1], scratch)
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(scratch / "profile")}
    environment.pop("PYTHONPATH", None)
    run = subprocess.run(
        [str(BLENDER), *arguments, "--python", str(scripts / script), "--", str(package), str(folder)],
        cwd=scratch,
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    printed = run.stdout + run.stderr
    if keep is not None:
        shutil.rmtree(keep, ignore_errors=True)
        shutil.copytree(folder, keep)
    result = folder / "result.json"
    assert result.exists(), f"no result; exit {run.returncode}\n{printed[-4000:]}"
    found = json.loads(result.read_text())
    assert "error" not in found, f"{found.get('error')}\n{printed[-4000:]}"
    assert run.returncode == 0, f"exit {run.returncode}\n{printed[-4000:]}"
    return found, printed
