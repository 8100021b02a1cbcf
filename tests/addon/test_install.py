# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip comes and goes cleanly: nothing of it before enabling, nothing after disabling, no file after uninstalling."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

pytest.importorskip("bpy")

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PACKAGE = "bl_ext.user_default.opal"
MARK = "RESULT "
REGISTERED = ("classes", "engines", "properties", "handlers", "menus", "panels", "addons")


@pytest.fixture(scope="module")
def cycle(tmp_path_factory):
    """What Blender held before and after each step, from a process with an empty profile."""
    zips = sorted((ROOT / "dist").glob("opal-*.zip"))
    if not zips:
        pytest.skip("dist/ holds no zip: run `make test`")
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(tmp_path_factory.mktemp("profile"))}
    environment.pop("PYTHONPATH", None)
    run = subprocess.run(
        [sys.executable, str(HERE / "install_cycle.py"), str(zips[-1])],
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    lines = [line for line in run.stdout.splitlines() if line.startswith(MARK)]
    assert run.returncode == 0 and lines, f"exit {run.returncode}\n{run.stdout[-3000:]}\n{run.stderr[-3000:]}"
    assert "Traceback" not in run.stdout + run.stderr, run.stdout + run.stderr
    return json.loads(lines[-1][len(MARK) :])


def _added(cycle, step, what):
    return sorted(set(cycle[step][what]) - set(cycle["before"][what]))


def test_the_zip_holds_no_compiled_python():
    zips = sorted((ROOT / "dist").glob("opal-*.zip"))
    if not zips:
        pytest.skip("dist/ holds no zip: run `make test`")
    names = zipfile.ZipFile(zips[-1]).namelist()
    assert "__init__.py" in names and [name for name in names if name.endswith(".pyc")] == []


def test_the_profile_was_empty(cycle):
    assert cycle["before"]["files"] == []
    assert PACKAGE not in cycle["before"]["addons"]


def test_installing_alone_registers_nothing(cycle):
    assert cycle["installed"]["files"]
    assert {what: _added(cycle, "installed", what) for what in REGISTERED} == {what: [] for what in REGISTERED}


def test_enabling_brings_engine_properties_and_menu_entries(cycle):
    assert _added(cycle, "enabled", "engines") == ["OPAL"]
    assert {"Scene.opal", "Material.opal", "ViewLayer.opal"} <= set(_added(cycle, "enabled", "properties"))
    assert len(_added(cycle, "enabled", "menus")) >= 2
    assert "RENDER_PT_color_management" in _added(cycle, "enabled", "panels")
    assert _added(cycle, "enabled", "addons") == [PACKAGE]


def test_enabling_does_not_load_the_kernels(cycle):
    assert "opal_kernels.binding" not in cycle["enabled"]["modules"], cycle["enabled"]["modules"]
    assert [m for m in cycle["enabled"]["modules"] if m.startswith("opal_kernels.optics")] == []


def test_enabling_loads_no_numpy(cycle):
    """It costs more than all the rest: what computes is loaded when it is first needed."""
    assert cycle["enabled"]["arrays"] == []


@pytest.mark.parametrize("what", REGISTERED)
def test_disabling_leaves_nothing(cycle, what):
    assert _added(cycle, "disabled", what) == []
    assert set(cycle["before"][what]) <= set(cycle["disabled"][what]), "and takes nothing of Blender's along"


@pytest.mark.parametrize("what", REGISTERED)
def test_enabling_a_second_time_brings_the_same(cycle, what):
    assert cycle["enabled again"][what] == cycle["enabled"][what]


@pytest.mark.parametrize("what", (*REGISTERED, "files"))
def test_uninstalling_leaves_nothing(cycle, what):
    assert _added(cycle, "uninstalled", what) == []
