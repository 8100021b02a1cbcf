# SPDX-License-Identifier: GPL-3.0-or-later
"""A render that came to no picture hands back an empty one: Blender writes files of it all the same, and ended on an OpenEXR of none."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("bpy")

pytestmark = pytest.mark.usefixtures("opal")

HERE = Path(__file__).resolve().parent
MARK = "RESULT "


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """What `render_to_nothing.py` found in the files."""
    script = [str(HERE.parent.parent / "tools" / "with_extension.py"), str(HERE / "render_to_nothing.py")]
    folder = str(tmp_path_factory.mktemp("nothing"))
    run = subprocess.run([sys.executable, *script, folder], capture_output=True, text=True, timeout=120)
    lines = [line for line in run.stdout.splitlines() if line.startswith(MARK)]
    assert run.returncode == 0 and lines, f"exit {run.returncode}\n{run.stdout[-3000:]}\n{run.stderr[-3000:]}"
    return json.loads(lines[-1][len(MARK) :])


@pytest.mark.parametrize(("name", "size"), [("stopped", [16, 12]), ("stopped_border", [8, 12])])
def test_a_render_that_is_stopped_at_once_writes_an_empty_picture(found, name, size):
    assert found[name] == {"size": size, "colour": 0.0, "alpha": 0.0}


def test_each_layer_of_a_render_that_is_stopped_at_once_is_empty(found):
    assert found["layers"]["Second"].pop("Depth") >= 1e10, "Blender's depth of nothing"
    assert found["layers"] == {"ViewLayer": {"Combined": 0.0}, "Second": {"Combined": 0.0}}


@pytest.mark.parametrize(("name", "words"), [("no_camera", "its Shift X is not finite"), ("no_kernels", "Opal's kernels do not load")])
def test_a_render_that_is_refused_leaves_an_empty_picture_that_can_be_saved(found, name, words):
    assert words in found[name].pop("said")
    assert found[name] == {"size": [16, 12], "colour": 0.0, "alpha": 0.0}


def test_what_fails_after_there_is_a_picture_keeps_it(found):
    assert "the film is lost" in found["failed_later"].pop("said")
    assert found["failed_later"] == {"size": [16, 12], "colour": pytest.approx(1.0, rel=0.05), "alpha": 1.0}


def test_the_next_render_knows_nothing_of_it(found):
    assert found["afterwards"] == {"size": [16, 12], "colour": pytest.approx(1.0, rel=0.05), "alpha": 1.0}
