# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal in a Blender as a distribution ships it, with windows: another Python and NumPy than bpy's, perhaps no denoiser.

Pictures go to build/screenshots, to be looked at.
"""

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


@pytest.fixture(scope="module")
def background(tmp_path_factory):
    return drive(tmp_path_factory.mktemp("profile"), SCREENSHOTS / "background", "--background")


@pytest.fixture(scope="module")
def windowed(tmp_path_factory):
    return drive(tmp_path_factory.mktemp("profile"), SCREENSHOTS / "window")


def test_the_zip_renders_the_first_scene_without_a_window(background):
    found, printed = background
    assert found["enabled"] and "OK" in printed.splitlines()
    assert (found["render"]["width"], found["render"]["height"]) == (64, 64)
    assert 0.05 < found["render"]["mean"] < 0.95, found
    assert found["render"]["spread"] > 0.02, f"a flat picture: {found}"


def test_a_render_started_from_the_interface_ends_and_is_shown(windowed):
    found, _ = windowed
    assert found["render_end"] == ["complete"]
    assert found["render"]["spread"] > 0.02, f"a flat picture: {found}"


def test_the_rendered_view_shows_the_scene(windowed):
    found, _ = windowed
    assert found["viewport"]["mean"] > 0.05 and found["viewport"]["spread"] > 0.02, found


def test_disabled_while_a_view_renders_it_leaves_nothing(windowed):
    found, _ = windowed
    assert found["left_behind"] == []
    assert found["engine_after"] != "OPAL"


@pytest.mark.parametrize("how", ["background", "windowed"])
def test_nothing_went_wrong_on_the_way(how, request):
    _, printed = request.getfixturevalue(how)
    assert "Traceback" not in printed, printed[-4000:]
