# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame after frame: values follow their curves, memory stays flat, settings survive the file."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def resident_bytes() -> int:
    with open("/proc/self/statm", encoding="ascii") as numbers:
        return int(numbers.read().split()[1]) * 4096


def test_twenty_frames_leave_memory_flat(tmp_path):
    scene = stage.scene(width=64, height=48, passes=1, samples=1)
    stage.camera((0, 0, 8))
    stage.world()
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=200, y_subdivisions=200, size=6)
    grid = bpy.context.object
    for frame, turn in ((1, 0.0), (20, 3.0)):
        grid.rotation_euler.z = turn
        grid.keyframe_insert("rotation_euler", frame=frame)
    used = []
    for frame in range(1, 21):
        scene.frame_set(frame)
        bpy.ops.render.render()
        used.append(resident_bytes())
    grown = used[-1] - used[4]
    mesh_bytes = 80_000 * 3 * (12 + 4)
    assert grown < 3 * mesh_bytes, f"{grown / 2**20:.1f} MB over 15 frames"


def test_animated_values_reach_the_picture(tmp_path):
    scene = stage.scene()
    stage.camera((0, 0, 5))
    material = stage.glowing()
    strength = next(n for n in material.node_tree.nodes if n.type == "EMISSION").inputs["Strength"]
    for frame, value in ((1, 1.0), (11, 3.0)):
        strength.default_value = value
        strength.keyframe_insert("default_value", frame=frame)
    stage.plane(size=20, material=material)
    for frame, value in ((1, 1.0), (11, 3.0)):
        scene.frame_set(frame)
        assert stage.render(tmp_path)[..., :3].mean() == pytest.approx(value, rel=0.05)


def test_a_keyed_species_is_rendered_at_each_key(tmp_path):
    """Keyframes hold single precision; both species come back by name, and the picture is each one's: red through ruby, white through water."""
    from opal_kernels.optics import species

    scene = stage.scene(8, 8, passes=1, samples=16)
    stage.camera((0, 0, 5), type="ORTHO", ortho_scale=0.5)
    stage.world()
    material = bpy.data.materials.new("Stone")
    material.opal.kind = "GEM"
    h = 0.0025
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-h, h)]
    stage.mesh("Plate", corners, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)], material=material)
    for frame, name in ((1, "RUBY"), (5, "WATER")):
        material.opal.gem.species = name
        material.opal.gem.keyframe_insert("species", frame=frame)
    shares = {}
    for frame, name in ((1, "RUBY"), (4, "RUBY"), (5, "WATER")):
        scene.frame_set(frame)
        assert material.opal.gem.species == name
        red, green, _ = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
        assert stage.problems() == []
        shares[name] = green / red
    assert species.absorption("RUBY", np.array([550.0]))[0] > 100
    assert shares["RUBY"] < 0.5 and shares["WATER"] == pytest.approx(1.0, abs=0.1), shares


def test_a_species_that_this_version_does_not_know_is_rendered_by_its_numbers(tmp_path):
    from opal_kernels import gem as gems

    stage.scene(4, 4, passes=1, samples=1)
    stage.camera((0, 0, 5))
    material = bpy.data.materials.new("Kryptonite")
    material.opal.kind = "GEM"
    gem = material.opal.gem
    gem.species = "RUBY"
    gem["species"] = 12345
    stage.plane(material=material)
    stage.render(tmp_path)
    assert any(line.startswith("Kryptonite: Its species is none that this version of Opal knows") for line in stage.problems())
    assert not [line for line in stage.problems() if "KeyError" in line]
    presets = stage.addon("presets")
    index, absorption = stage.addon("translate.materials").gem_spectra(gem)
    assert index == pytest.approx(gems.index(presets.settings_of(gem))) and absorption.max() > 100
    assert presets.read_out(gem).n_d == pytest.approx(1.768, abs=1e-3) and presets.index_chart(gem) is not None


def test_render_animation_writes_every_frame(tmp_path):
    scene = stage.scene(width=8, height=8, passes=1, samples=1)
    stage.camera()
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = str(tmp_path / "frame_")
    scene.render.image_settings.file_format = "PNG"
    bpy.ops.render.render(animation=True)
    assert sorted(path.name for path in tmp_path.glob("*.png")) == [f"frame_{i:04d}.png" for i in (1, 2, 3)]


def test_saving_and_loading_keeps_every_setting(tmp_path):
    def settings_of(group):
        found = {}
        for prop in group.bl_rna.properties:
            if prop.identifier in {"rna_type", "name"} or prop.is_skip_save:
                continue
            value = getattr(group, prop.identifier)
            if prop.type == "POINTER":
                found[prop.identifier] = settings_of(value)
            elif prop.type == "COLLECTION":
                found[prop.identifier] = [settings_of(item) for item in value]
            else:
                found[prop.identifier] = tuple(value) if getattr(prop, "is_array", False) else value
        return found

    def change(group):
        for prop in group.bl_rna.properties:
            if prop.identifier == "rna_type" or prop.is_readonly or prop.is_hidden:
                continue
            value = getattr(group, prop.identifier)
            if prop.type == "BOOLEAN":
                setattr(group, prop.identifier, not value)
            elif prop.type == "INT":
                setattr(group, prop.identifier, value + 1)
            elif prop.type == "ENUM":
                others = [item.identifier for item in prop.enum_items if item.identifier != value]
                setattr(group, prop.identifier, others[-1] if others else value)
            elif prop.type == "STRING":
                setattr(group, prop.identifier, value + "x")
            elif prop.type == "FLOAT":
                setattr(group, prop.identifier, [x * 0.9 + 0.01 for x in value] if prop.is_array else value * 0.9 + 0.01)

    scene = stage.scene()
    material = bpy.data.materials.new("Stone")
    material.use_fake_user = True
    material.opal.gem.species = "RUBY"
    for made in (bpy.data.lights.new("Lamp", "POINT"), bpy.data.cameras.new("Eye"), bpy.data.worlds.new("Sky")):
        made.use_fake_user = True

    def owners():
        data = bpy.data
        return (
            bpy.context.scene,
            bpy.context.view_layer,
            data.materials["Stone"],
            data.lights["Lamp"],
            data.cameras["Eye"],
            data.worlds["Sky"],
        )

    untouched = [settings_of(owner.opal) for owner in owners()]
    for owner in owners():
        change(owner.opal)
    scene.opal.wavelengths = (400, 700)
    before = [settings_of(owner.opal) for owner in owners()]
    assert all(a != b for a, b in zip(untouched, before, strict=True))
    path = str(tmp_path / "settings.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    scene = bpy.context.scene
    after = [settings_of(owner.opal) for owner in owners()]
    assert scene.render.engine == "OPAL"
    assert after == before
    assert np.isclose(after[0]["wavelengths"], (400, 700)).all()
