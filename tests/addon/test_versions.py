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


def test_a_file_without_anything_of_opal_is_left_without_its_mark(tmp_path):
    """The mark is a custom property that whoever opens the scene's panel sees."""
    stage.scene().render.engine = "CYCLES"
    bpy.data.lights.new("Lamp", "POINT")
    saved_and_opened(tmp_path / "other.blend")
    assert "opal_layout" not in bpy.context.scene
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.use_fake_user, lamp.opal.spectrum = True, "SODIUM"
    saved_and_opened(tmp_path / "lamp.blend")
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


def test_species_of_layout_1_keep_their_names(tmp_path):
    """They were numbers of 31 bits, which keyframes cannot hold; one that nobody chose, and Custom, stay as they are."""
    import zlib

    scene = stage.scene()
    names = ("RUBY", "WATER", "DIAMOND", "CUSTOM")
    for name in (*names, "untouched"):
        stone = bpy.data.materials.new(name)
        stone.use_fake_user = True
        stone.opal.kind = "GEM"
        if name != "untouched":
            stone.opal.gem.species = name
            stone.opal.gem["species"] = 0 if name == "CUSTOM" else zlib.crc32(name.encode()) & 0x7FFFFFFF
    assert bpy.data.materials["RUBY"].opal.gem.species == ""
    scene["opal_layout"] = 1
    versions = stage.addon("versions")
    bpy.app.handlers.save_pre.remove(versions._on_save)
    try:
        saved_and_opened(tmp_path / "layout1.blend")
    finally:
        if versions._on_save not in bpy.app.handlers.save_pre:
            bpy.app.handlers.save_pre.append(versions._on_save)
    assert {m.name: m.opal.gem.species for m in bpy.data.materials if m.opal.kind == "GEM"} == {
        **{name: name for name in names},
        "untouched": "DIAMOND",
    }


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
