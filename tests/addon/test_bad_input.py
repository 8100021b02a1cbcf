# SPDX-License-Identifier: GPL-3.0-or-later
"""Input that is broken or absurd ends in a picture or in one sentence, never in a crash or a hang."""

import threading

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def refused(match):
    return pytest.raises(RuntimeError, match=match)


def test_a_scene_without_camera_is_refused_by_name():
    stage.scene()
    stage.plane()
    with refused("no camera|No camera|Cannot render, no camera"):
        bpy.ops.render.render()


def test_a_scene_without_objects_or_lights_is_black(tmp_path):
    stage.scene()
    stage.camera()
    picture = stage.render(tmp_path)
    assert not picture[..., :3].any()


def test_a_scene_without_light_is_black(tmp_path):
    stage.scene()
    stage.camera()
    stage.plane(size=20, material=stage.matte())
    assert not stage.render(tmp_path)[..., :3].any()


def test_vertices_that_are_not_numbers_lose_their_faces_and_are_reported(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    obj = stage.mesh(
        "Broken",
        [(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0), (0, 0, 50)],
        [(0, 1, 2, 3), (0, 1, 4)],
        material=stage.glowing(),
    )
    obj.data.vertices[4].co = (float("nan"), 0, 0)
    assert stage.render(tmp_path)[..., :3].mean() == pytest.approx(1, rel=0.05)
    assert any("Broken" in entry and "1 triangles" in entry for entry in stage.problems()), stage.problems()


def test_triangles_without_area_do_no_harm(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    obj = stage.mesh(
        "Thin", [(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [(0, 1, 2, 3), (0, 1, 1), (2, 2, 2)], material=stage.glowing()
    )
    obj.data.polygons[0].use_smooth = True
    picture = stage.render(tmp_path)
    assert np.isfinite(picture).all()
    assert picture[..., :3].mean() == pytest.approx(1, rel=0.05)


def test_a_mesh_of_nothing_renders(tmp_path):
    stage.scene()
    stage.camera()
    stage.link("Empty", bpy.data.meshes.new("Empty"))
    stage.mesh("Points", [(0, 0, 0), (1, 0, 0)], [])
    stage.link("Null", None)
    stage.render(tmp_path)
    assert not stage.problems()


def test_three_million_triangles_render(tmp_path):
    stage.scene(width=4, height=4, passes=1, samples=1)
    stage.camera((0, 0, 5))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=1225, y_subdivisions=1225, size=20)
    bpy.context.object.data.materials.append(stage.glowing())
    assert stage.render(tmp_path)[..., :3].mean() > 0.5


def test_a_missing_image_is_named_and_the_render_goes_on(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    material = stage.glowing("Picture")
    tree = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = bpy.data.images.new("Lost", 4, 4)
    texture.image.source = "FILE"
    texture.image.filepath = str(tmp_path / "nowhere.png")
    texture.image.reload()
    tree.links.new(texture.outputs["Color"], next(n for n in tree.nodes if n.type == "EMISSION").inputs["Color"])
    stage.plane(size=20, material=material)
    picture = stage.render(tmp_path)[..., :3].mean((0, 1))
    assert picture[0] > 0.8 and picture[2] > 0.8 and picture[1] < 0.1, "magenta, as in Cycles"
    assert any("Lost" in entry or "Picture" in entry for entry in stage.problems()), stage.problems()


def test_a_material_without_nodes_shows_its_colour(tmp_path):
    stage.scene(passes=4, samples=8)
    stage.camera((0, 0, 5))
    stage.world()
    material = bpy.data.materials.new("Plain")
    material.use_nodes = False
    material.diffuse_color = (0.2, 0.5, 0.8, 1)
    material.specular_intensity = 0.0
    stage.plane(size=100, material=material)
    picture = stage.render(tmp_path)[..., :3].mean((0, 1))
    if material.use_nodes:  # since Blender 5 every material has nodes: that of a new one, a grey of 0.8
        assert picture == pytest.approx(np.full(3, picture.mean()), rel=0.01)
    else:
        assert picture[0] < picture[1] < picture[2]


def test_a_node_cycle_through_groups_ends(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    group = bpy.data.node_groups.new("Round", "ShaderNodeTree")
    group.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("In", in_out="INPUT", socket_type="NodeSocketColor")
    inside, outside = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    group.links.new(inside.outputs[0], outside.inputs[0])
    material = stage.glowing("Cyclic")
    tree = material.node_tree
    nodes = [tree.nodes.new("ShaderNodeGroup") for _ in range(2)]
    for node in nodes:
        node.node_tree = group
    tree.links.new(nodes[0].outputs[0], nodes[1].inputs[0])
    tree.links.new(nodes[1].outputs[0], nodes[0].inputs[0])
    tree.links.new(nodes[1].outputs[0], next(n for n in tree.nodes if n.type == "EMISSION").inputs["Color"])
    stage.plane(size=20, material=material)
    assert np.isfinite(stage.render(tmp_path)).all()


@pytest.mark.parametrize("scale", [(0, 0, 0), (1, 1, 0), (1e-30, 1e-30, 1e-30)])
def test_objects_scaled_to_nothing_are_left_out_and_named(scale, tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.plane("Squashed", size=20, material=stage.glowing()).scale = scale
    stage.plane("Whole", size=0.1, location=(50, 0, 0), material=stage.glowing("Other"))
    assert np.isfinite(stage.render(tmp_path)).all()
    assert any("Squashed" in entry for entry in stage.problems()), stage.problems()


def test_a_matrix_that_is_not_finite_is_left_out_and_named(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.plane("Lost", material=stage.glowing()).location.x = float("nan")
    assert np.isfinite(stage.render(tmp_path)).all()
    assert any("Lost" in entry for entry in stage.problems()), stage.problems()


def test_an_absurd_resolution_is_refused_with_the_memory_it_takes(monkeypatch):
    """The film's 72 bytes a pixel, Blender's own picture of 16 and a copy that is handed over: 38.7 GB; 42 would hold the film alone."""
    scene = stage.scene(width=20_000, height=20_000)
    stage.camera()
    from opal_kernels import memory

    monkeypatch.setattr(memory, "available_bytes", lambda: 42 * 2**30)
    with refused(r"20000 x 20000 pixels would take 38\.7 GB of memory and 42\.0 GB are free"):
        bpy.ops.render.render()
    assert scene.render.resolution_x == 20_000


def test_a_lamp_that_is_nowhere_is_left_out_and_named(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.plane(size=20, material=stage.matte())
    stage.link("Lost", bpy.data.lights.new("Lost", "POINT")).location.x = float("nan")
    bright = bpy.data.lights.new("Bright", "SUN")
    bright.energy = float("inf")
    stage.link("Bright", bright)
    assert not stage.render(tmp_path)[..., :3].any()
    said = " | ".join(stage.problems())
    assert "Lost: the lamp is left out: its Location is not finite" in said
    assert "Bright: Power: the lamp is left out: its Power is not finite" in said


@pytest.mark.parametrize("what", ["Location", "Rotation", "Shift X", "Depth of Field"])
def test_a_camera_that_is_nowhere_is_refused_once_with_what_is_wrong(what):
    stage.scene()
    camera = stage.camera((0, 0, 5))
    if what == "Location":
        camera.location.y = float("nan")
    elif what == "Rotation":
        camera.rotation_euler.z = float("nan")
    elif what == "Shift X":
        camera.data.shift_x = float("nan")
    else:
        camera.data.dof.use_dof, camera.data.dof.focus_distance = True, float("nan")
    with refused(f"The camera “Camera” cannot be rendered from: its {what} is not finite") as refusal:
        bpy.ops.render.render()
    assert str(refusal.value).count("cannot be rendered") == 1


def test_colours_that_are_no_numbers_count_as_nothing_and_are_named(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.world((0.5, float("nan"), 0.5))
    stage.plane(size=3, material=stage.glowing("Torn", (float("nan"), 0.5, 0.25)))
    picture = stage.render(tmp_path)[..., :3]
    assert picture[6, 8] == pytest.approx([0, 0.5, 0.25], abs=0.06)
    assert picture[0, 0] == pytest.approx([0.5, 0, 0.5], abs=0.06)
    said = " | ".join(stage.problems())
    assert "World: node “Background”: “Color” is not a finite number; 0 is taken for it." in said
    assert "Torn: node “Emission”: “Color” is not a finite number; 0 is taken for it." in said


def test_a_world_of_infinite_strength_is_as_bright_as_can_be_and_is_named(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.world(strength=float("inf"))
    stage.plane(size=3, material=stage.matte())
    picture = stage.render(tmp_path)[..., :3]
    assert np.isfinite(picture).all()
    assert picture.min() > 1e17
    assert any("World" in entry and "“Strength” is too large to calculate with" in entry for entry in stage.problems()), stage.problems()


def test_a_locked_spectral_path_is_a_sentence_and_the_picture_stands(tmp_path):
    scene = stage.scene()
    stage.camera()
    stage.world()
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    scene.opal.use_spectral_output = True
    scene.opal.spectral_path = str(blocked / "spectra.exr")
    assert stage.render(tmp_path)[..., :3].mean() > 0.5
    assert any("cannot be written" in entry for entry in stage.problems()), stage.problems()


@pytest.mark.parametrize("path", ["", "//"])
def test_a_spectral_path_without_a_file_names_the_setting(path, tmp_path):
    scene = stage.scene()
    stage.camera()
    stage.world()
    scene.opal.use_spectral_output, scene.opal.spectral_path = True, path
    assert stage.render(tmp_path)[..., :3].mean() > 0.5
    assert any("Spectral EXR › File names no file" in entry for entry in stage.problems()), stage.problems()


def test_files_beside_one_that_was_never_saved_are_refused(tmp_path, monkeypatch):
    """Blender refuses its own picture there; these came into the folder that it was started from."""
    scene = stage.scene()
    stage.camera()
    monkeypatch.chdir(tmp_path)
    scene.opal.use_spectral_output = scene.opal.use_film_file = True
    (tmp_path / "picture").mkdir()
    stage.render(tmp_path / "picture")
    for path in ("//spectral_####.exr", "//film_####.npz"):
        assert f"Save the file first: “{path}” is relative to it." in stage.problems(), stage.problems()
    assert [entry.name for entry in tmp_path.iterdir()] == ["picture"]


@pytest.mark.skipif(not hasattr(bpy.data, "colorspace"), reason="files have no working space before Blender 5")
def test_a_file_of_another_working_space_is_named(tmp_path):
    stage.scene()
    stage.camera()
    bpy.ops.wm.set_working_color_space(working_space="ACEScg", convert_colors=False)
    try:
        stage.render(tmp_path)
        assert [entry for entry in stage.problems() if entry.startswith("Working Space: the file works in ACEScg")], stage.problems()
    finally:
        bpy.ops.wm.set_working_color_space(working_space="Linear Rec.709", convert_colors=False)
    stage.render(tmp_path)
    assert not stage.problems()


def test_a_locked_output_path_is_an_error_and_no_crash(tmp_path):
    scene = stage.scene()
    stage.camera()
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    scene.render.filepath = str(blocked / "picture.png")
    with refused("."):
        bpy.ops.render.render(write_still=True)


def test_a_gem_of_an_impossible_index_written_by_a_script_still_renders(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.world()
    material = stage.matte("Stone")
    material.opal.kind = "GEM"
    material.opal.gem.species = "CUSTOM"
    material.opal.gem["sellmeier_b"] = (-50.0, 0.0, 0.0)  # past the property's own check
    bpy.ops.mesh.primitive_uv_sphere_add()
    bpy.context.object.data.materials.append(material)
    assert np.isfinite(stage.render(tmp_path)).all()


def test_deleting_what_is_being_rendered_ends_in_a_picture(tmp_path):
    """Objects and materials that go while passes run: the render has read them and needs them no more."""
    scene = stage.scene(width=64, height=48, passes=6, samples=64)
    scene.opal.denoise = False
    stage.camera((0, 0, 5))
    material = stage.glowing()
    plane = stage.plane(size=20, material=material)

    def delete(*_):
        if deleted or not any(thread.name == "Opal pass" for thread in threading.enumerate()):
            return
        deleted.add(plane.name)
        bpy.data.objects.remove(plane)
        bpy.data.materials.remove(material)

    deleted = set()
    bpy.app.handlers.render_stats.append(delete)
    try:
        picture = stage.render(tmp_path)
    finally:
        bpy.app.handlers.render_stats.remove(delete)
    assert np.isfinite(picture).all()
    assert deleted == {"Plane"} and "Plane" not in bpy.data.objects
    assert not stage.render(tmp_path)[..., :3].any()


@pytest.mark.parametrize("what", ["the engine", "the camera", "the world and the view layer"])
def test_switching_while_it_renders_ends_in_the_picture_that_was_asked_for(what, tmp_path):
    scene = stage.scene(width=64, height=48, passes=6, samples=64)
    scene.opal.denoise = False
    camera = stage.camera((0, 0, 5))
    stage.world((0.3, 0.3, 0.3))
    stage.plane(size=20, material=stage.glowing())
    done = []

    def switch(*_):
        if done or not any(thread.name == "Opal pass" for thread in threading.enumerate()):
            return
        done.append(what)
        if what == "the engine":
            scene.render.engine = "CYCLES"
        elif what == "the camera":
            bpy.data.objects.remove(camera)
        else:
            scene.world = None
            scene.view_layers.new("Another")

    bpy.app.handlers.render_stats.append(switch)
    try:
        picture = stage.render(tmp_path)
    finally:
        bpy.app.handlers.render_stats.remove(switch)
    assert done, "it was switched while a pass ran"
    assert picture[..., :3].mean() == pytest.approx(1, rel=0.01)


def test_an_artists_image_and_text_of_the_same_name_are_left_alone():
    """The gem's report, as the chart of the rainbow does, keeps its own beside them, and fills those anew the next time."""
    name = "Gem Report"
    bpy.data.images.new(name, 4, 4)
    bpy.data.texts.new(name).write("mine")
    bpy.ops.opal.add_gem(cut="BRILLIANT", species="DIAMOND")
    for _ in range(2):
        assert bpy.ops.opal.gem_report(size=128, passes=1, tilt_steps=3) == {"FINISHED"}
    assert tuple(bpy.data.images[name].size) == (4, 4) and bpy.data.texts[name].as_string().strip() == "mine"
    assert [i.name for i in bpy.data.images if i.name.startswith(name)] == [name, name + ".001"]
    assert [t.name for t in bpy.data.texts if t.name.startswith(name)] == [name, name + ".001"]
