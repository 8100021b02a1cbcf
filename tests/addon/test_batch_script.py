# SPDX-License-Identifier: GPL-3.0-or-later
"""`examples/batch.sh`: a frame in parts is the frame, and whatever goes wrong is told and counted."""

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import layer_stage
import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent

pytestmark = [
    pytest.mark.usefixtures("opal"),
    pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash to run examples/batch.sh"),
]


def program(folder, text):
    """An executable script; its path."""
    path = folder / "blender"
    path.write_text(text)
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def batch(folder, blender, parts=2, last=1, **variables):
    """Runs the script for frames 1 to `last` of folder/scene.blend; what it says and its exit code."""
    environment = {**os.environ, "BLENDER": str(blender), **variables}
    environment.pop("PYTHONPATH", None)
    command = ["bash", str(ROOT / "examples" / "batch.sh"), str(folder / "scene.blend"), "1", str(last), str(parts), str(folder / "out")]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    return run.stdout + run.stderr, run.returncode


def test_a_frame_in_parts_is_the_frame_and_overwriting_takes_another_number_of_parts(tmp_path):
    scene = layer_stage.build(passes=2, width=12, height=9)
    scene.opal.samples_per_pass, scene.opal.photons_per_pass = 1, 1000
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    whole = stage.render(tmp_path)
    blender = program(tmp_path, f'#!/bin/sh\nexec "{sys.executable}" "{HERE / "blender_for_batch.py"}" "$@"\n')
    zips = sorted((ROOT / "dist").glob("opal-*.zip"))
    variables = {"OPAL_ZIP": str(zips[-1]), "BLENDER_USER_RESOURCES": str(tmp_path / "profile")}
    picture = tmp_path / "out" / "frame_0001.exr"

    said, code = batch(tmp_path, blender, parts=2, **variables)
    assert code == 0, said
    np.testing.assert_array_equal(stage.read_layers(picture)["ViewLayer"]["Combined"], whole)
    made = picture.stat().st_mtime_ns
    assert batch(tmp_path, blender, parts=3, **variables)[1] == 0 and picture.stat().st_mtime_ns == made, "kept as it was"
    said, code = batch(tmp_path, blender, parts=3, OVERWRITE="1", **variables)
    assert code == 0 and picture.stat().st_mtime_ns > made, said
    np.testing.assert_array_equal(stage.read_layers(picture)["ViewLayer"]["Combined"], whole)
    assert not list((tmp_path / "out" / "films").glob("*_of_2_*"))


def test_parts_that_write_no_film_are_not_done(tmp_path):
    (tmp_path / "scene.blend").touch()
    blender = program(tmp_path, "#!/bin/sh\necho The film cannot be written: Read-only folder.\n")
    said, code = batch(tmp_path, blender, last=2)
    assert code == 2, said
    assert said.count("wrote no film: The film cannot be written: Read-only folder.") == 4, said
    assert not list((tmp_path / "out" / "logs").glob("*.done"))


def test_a_program_that_does_not_start_is_told(tmp_path):
    (tmp_path / "scene.blend").touch()
    said, code = batch(tmp_path, tmp_path / "no blender here")
    assert code == 1 and "failed: " in said and "No such file" in said, said


def test_films_that_are_not_merged_are_told(tmp_path):
    """The films are there, but no films: the merge fails, and with it the frame."""
    (tmp_path / "scene.blend").touch()
    blender = program(
        tmp_path,
        '#!/bin/sh\nfor last; do :; done\ncase "$*" in\n*" -f "*) touch "${last}_0001-0001.npz" ;;\n*) echo Error: no film; exit 1 ;;\nesac\n',
    )
    said, code = batch(tmp_path, blender, parts=1)
    assert code == 1 and "not merged: Error: no film" in said, said
