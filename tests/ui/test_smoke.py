# SPDX-License-Identifier: GPL-3.0-or-later
"""A fire that Blender has simulated and baked, rendered straight from its domain."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BLENDER = ROOT.parent / "shared" / "tools" / "real-blender"


@pytest.fixture(scope="module")
def smoke(tmp_path_factory):
    if not BLENDER.exists():
        pytest.skip("no real Blender on this machine: shared/tools/real-blender is absent")
    zips = sorted((ROOT / "dist").glob("opal-*.zip"))
    if not zips:
        pytest.skip("dist/ holds no zip: run `make test`")
    folder = tmp_path_factory.mktemp("smoke")
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(tmp_path_factory.mktemp("profile"))}
    environment.pop("PYTHONPATH", None)
    script = ["--background", "--factory-startup", "--python", str(HERE / "smoke.py"), "--", str(zips[-1]), str(folder)]
    run = subprocess.run([str(BLENDER), *script], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300)
    printed = run.stdout + run.stderr
    assert (folder / "result.json").exists(), f"no result; exit {run.returncode}\n{printed[-4000:]}"
    found = json.loads((folder / "result.json").read_text())
    assert "error" not in found, f"{found.get('error')}\n{printed[-4000:]}"
    return found


def test_the_simulation_made_smoke(smoke):
    assert smoke["darkest"] < 0.1, smoke
    assert max(smoke["cells"]) <= 24 and min(smoke["cells"]) < 24, "the domain has adapted to what it holds"


def test_smoke_takes_light_away_as_its_cells_say(smoke):
    """The sky through an absorbing domain: the mean over 4,096 pixels of 64 paths knows the transmittance to about 0.1 %; cells
    taken as blocks instead of trilinear differ by what is left of 2 %."""
    assert smoke["absorbing_mean"] == pytest.approx(smoke["expected_mean"], rel=0.02), smoke
    assert smoke["correlation"] > 0.97, smoke


def test_fire_glows_red_before_blue(smoke):
    red, green, blue = smoke["glow"]
    assert red > 1.5 * green > 3 * blue > 0, smoke
