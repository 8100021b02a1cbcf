# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference of settings is made from the properties, and the committed one is what they make now."""

import sys
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

pytestmark = pytest.mark.usefixtures("opal")

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def reference(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    import make_settings_reference

    yield make_settings_reference
    sys.modules.pop("make_settings_reference", None)


def test_every_group_of_settings_has_its_table(reference):
    page = reference.text()
    for path in (
        "scene.opal",
        "material.opal.gem",
        "material.opal.medium",
        "material.opal.rainbow",
        "world.opal",
        "light.opal",
        "camera.opal",
    ):
        assert f"`{path}`" in page
    for name in ("`photons_carry`", "`species`", "`extinction`", "`polarizer`", "`opal.compare_cycles`"):
        assert name in page


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="the committed page is made by Blender 5")
def test_the_committed_reference_is_current(reference):
    """Fails where a setting was changed and `python tools/with_extension.py tools/make_settings_reference.py` was not run."""
    assert reference.FILE.read_text(encoding="utf-8") == reference.text()
