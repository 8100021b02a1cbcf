# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a script of this folder in a Blender as a distribution ships it, and gives back what the script wrote down."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BLENDER = ROOT.parent / "shared" / "tools" / "real-blender"
SCREENSHOTS = ROOT / "build" / "screenshots"


def drive(profile: Path, folder: Path, *arguments: str, script: str = "drive.py"):
    """Runs a script of this folder in the real Blender; (its result, everything it printed)."""
    if not BLENDER.exists():
        pytest.skip("no real Blender on this machine: shared/tools/real-blender is absent")
    zips = sorted((ROOT / "dist").glob("opal-*.zip"))
    if not zips:
        pytest.skip("dist/ holds no zip: run `make test`")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "result.json").unlink(missing_ok=True)
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(profile)}
    environment.pop("PYTHONPATH", None)
    run = subprocess.run(
        [str(BLENDER), *arguments, "--python", str(HERE / script), "--", str(zips[-1]), str(folder)],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    printed = run.stdout + run.stderr
    result = folder / "result.json"
    assert result.exists(), f"no result; exit {run.returncode}\n{printed[-4000:]}"
    found = json.loads(result.read_text())
    assert "error" not in found, f"{found.get('error')}\n{printed[-4000:]}"
    assert run.returncode == 0, f"exit {run.returncode}\n{printed[-4000:]}"
    return found, printed
