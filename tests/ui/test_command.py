# SPDX-License-Identifier: GPL-3.0-or-later
"""What a farm calls: `blender -b scene.blend -E OPAL -f 1`, its picture, its exit codes."""

from __future__ import annotations

import os
import subprocess

import pytest
from real_blender import BLENDER, drive


@pytest.fixture(scope="module")
def farm(tmp_path_factory):
    scratch = tmp_path_factory.mktemp("farm")
    drive(scratch, "--background", script="save.py")
    return scratch


def render(farm, name):
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(farm / "profile")}
    environment.pop("PYTHONPATH", None)
    command = [str(BLENDER), "-b", str(farm / "result" / f"{name}.blend"), "-E", "OPAL", "-f", "1"]
    return subprocess.run(command, cwd=farm, env=environment, capture_output=True, text=True, timeout=120)


def test_the_command_renders_a_saved_file_by_the_engine_it_names(farm):
    run = render(farm, "scene")
    assert run.returncode == 0, run.stdout[-2000:] + run.stderr[-2000:]
    assert "Pass 2 of 2" in run.stdout
    assert (farm / "result" / "frame_0001.png").stat().st_size > 500


def test_a_picture_that_no_memory_holds_ends_the_command_with_one_sentence(farm):
    run = render(farm, "too_large")
    assert run.returncode == 1, run.stdout[-2000:] + run.stderr[-2000:]
    said = [line for line in (run.stdout + run.stderr).splitlines() if "60000" in line.replace(",", "").replace(" ", "") and "GB" in line]
    assert said, run.stdout[-2000:] + run.stderr[-2000:]
    assert "Traceback" not in run.stdout + run.stderr
