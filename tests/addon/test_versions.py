# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of other versions of Opal open as they were meant."""

import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def saved_and_opened(path):
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=str(path))


def test_a_saved_file_says_its_layout(tmp_path):
    stage.scene()
    saved_and_opened(tmp_path / "new.blend")
    assert bpy.context.scene["opal_layout"] == stage.addon("versions").current()


def test_a_file_from_before_twins_gets_them(tmp_path):
    stage.scene()
    stone = bpy.data.materials.new("Stone")
    stone.use_fake_user = True
    stone.opal["kind"] = 1  # as an older version left it: set, and no twin made
    versions = stage.addon("versions")
    bpy.app.handlers.save_pre.remove(versions._on_save)
    try:
        saved_and_opened(tmp_path / "old.blend")
    finally:
        if versions._on_save not in bpy.app.handlers.save_pre:
            bpy.app.handlers.save_pre.append(versions._on_save)
    stone = bpy.data.materials["Stone"]
    assert stone.opal.kind == "GEM"
    assert any(node.bl_idname == "ShaderNodeBsdfGlass" for node in stone.node_tree.nodes)
    assert bpy.context.scene["opal_layout"] == versions.current()


def test_every_step_runs_once_and_in_order(tmp_path, monkeypatch):
    versions = stage.addon("versions")
    ran = []
    monkeypatch.setattr(versions, "_STEPS", [lambda scenes: ran.append(1), lambda scenes: ran.append(2)])
    stage.scene()["opal_layout"] = 1
    versions.migrate()
    versions.migrate()
    assert ran == [2]


def test_a_file_of_a_newer_version_opens_and_says_so():
    scene = stage.scene()
    scene["opal_layout"] = 1000
    assert "newer version" in stage.addon("versions").migrate()
    assert scene["opal_layout"] == 1000
