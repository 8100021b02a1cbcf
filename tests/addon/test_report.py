# SPDX-License-Identifier: GPL-3.0-or-later
"""The report names what is missing or shown in another way, and a click leads to it, wherever it comes from."""

import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def entries():
    return list(stage.addon("report").of(bpy.context.scene).entries)


def click(owner):
    """Presses the first line about something; returns the names of what is selected then."""
    index = next(i for i, entry in enumerate(entries()) if entry.owner == owner)
    result = bpy.ops.opal.select_reported(index=index)
    assert result == {"FINISHED"}
    return sorted(obj.name for obj in bpy.context.selected_objects)


def toon(name="Cartoon"):
    """A material that Opal shows in another way (Toon) and that has a node it does not read."""
    material = stage.matte(name)
    tree = material.node_tree
    shader = tree.nodes.new("ShaderNodeBsdfToon")
    shader.label = "My toon"
    dirt = tree.nodes.new("ShaderNodeAmbientOcclusion")
    dirt.name = "Dirt"
    tree.links.new(dirt.outputs["Color"], shader.inputs["Color"])
    tree.links.new(shader.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    return material


@pytest.fixture
def rendered(tmp_path):
    def run():
        stage.camera((0, 0, 9))
        stage.render(tmp_path)
        return entries()

    stage.scene(width=4, height=4, passes=1, samples=1)
    return run


def test_lines_name_owner_and_part_and_say_whether_it_is_lost(rendered):
    stage.plane(material=toon())
    lines = {(e.owner, e.part): e for e in rendered()}
    assert lines["Cartoon", "node “My toon”"].lost is False
    assert lines["Cartoon", "node “Dirt”"].lost is True
    assert all(e.kind == "MATERIAL" for e in lines.values())


def test_more_gems_within_each_other_than_a_path_keeps_account_of_are_reported(rendered):
    material = stage.matte("Jelly")
    material.opal.kind = "GEM"
    material.opal.gem.species = "WATER"
    for i in range(34):
        half = 2.0 - 0.01 * i
        corners = [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)]
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        stage.mesh(f"Shell {i}", corners, faces, material=material)
    assert [entry.message for entry in rendered() if "32 gems" in entry.message and entry.lost]


def test_the_list_shows_the_report_and_is_searched(rendered):
    report_list = stage.addon("report_list")
    stage.plane(material=toon())
    rendered()
    assert not report_list.is_current(bpy.context.scene)
    report_list.fill()
    assert report_list.is_current(bpy.context.scene)
    items = bpy.context.window_manager.opal_report
    assert [(i.owner, i.part, i.message, i.lost) for i in items] == [(e.owner, e.part, e.message, e.lost) for e in entries()]


def test_a_click_on_a_material_selects_who_wears_it_and_turns_to_its_slot(rendered):
    material = toon()
    worn = stage.plane(material=stage.matte("Plain"))
    worn.data.materials.append(material)
    worn.data.polygons[0].material_index = 1
    other = stage.plane(material=stage.matte("Other"))
    rendered()
    other.select_set(True)
    assert click("Cartoon") == [worn.name]
    assert bpy.context.view_layer.objects.active == worn and worn.active_material == material


def test_a_click_on_an_object_and_on_a_lamp_selects_it(rendered):
    flat = stage.plane(material=stage.glowing())
    flat.name = "Flat"
    flat.scale = (0, 0, 0)
    lamp = bpy.data.lights.new("Laser data", "POINT")
    stage.link("Laser", lamp, (0, 0, 3))
    lamp.opal.spectrum, lamp.opal.laser_wavelength = "LASER", 400
    bpy.context.scene.opal.wavelengths = (500, 600)
    rendered()
    assert click("Flat") == ["Flat"]
    assert click("Laser") == ["Laser"]


def test_a_click_on_a_missing_image_selects_who_shows_it(rendered, tmp_path):
    material = stage.glowing("Picture")
    tree = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = bpy.data.images.new("Lost", 4, 4)
    texture.image.source, texture.image.filepath = "FILE", str(tmp_path / "nowhere.png")
    texture.image.reload()
    tree.links.new(texture.outputs["Color"], next(n for n in tree.nodes if n.type == "EMISSION").inputs["Color"])
    worn = stage.plane(material=material)
    rendered()
    assert click("Lost") == [worn.name]


def test_what_is_only_seen_as_an_instance_is_found_by_its_instancer(rendered):
    inside = bpy.data.collections.new("Inside")
    bpy.context.view_layer.update()
    mesh = bpy.data.meshes.new("Tile")
    mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0)], [], [(0, 1, 2)])
    mesh.materials.append(toon())
    inside.objects.link(bpy.data.objects.new("Tile", mesh))
    empty = stage.link("Instancer", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", inside
    rendered()
    assert click("Cartoon") == ["Instancer"]


def test_what_is_linked_from_a_library_is_found(rendered, tmp_path):
    path = tmp_path / "library.blend"
    mesh = bpy.data.meshes.new("Tile")
    mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0)], [], [(0, 1, 2)])
    mesh.materials.append(toon("Library paint"))
    tile = bpy.data.objects.new("Tile", mesh)
    bpy.data.libraries.write(str(path), {tile})
    bpy.data.objects.remove(tile)
    bpy.data.meshes.remove(mesh)
    bpy.data.materials.remove(bpy.data.materials["Library paint"])
    own = stage.plane(material=toon("Library paint"))  # a stranger of the same name
    own.name = "Own"
    with bpy.data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.objects = ["Tile"]
    bpy.context.collection.objects.link(wanted.objects[0])
    assert wanted.objects[0].library is not None
    found = [e for e in rendered() if e.owner == "Library paint"]
    selected = set()
    for number, entry in enumerate(entries()):
        if entry in found:
            assert bpy.ops.opal.select_reported(index=number) == {"FINISHED"}
            (obj,) = bpy.context.selected_objects
            selected.add((obj.name, obj.library is not None))
    assert selected == {("Own", False), ("Tile", True)}


def test_what_is_gone_or_hidden_is_said_in_a_sentence(rendered):
    worn = stage.plane(material=toon())
    rendered()
    worn.hide_set(True)
    index = 0
    assert entries()[index].owner == "Cartoon"
    assert bpy.ops.opal.select_reported(index=index) == {"CANCELLED"}
    bpy.data.objects.remove(worn)
    assert bpy.ops.opal.select_reported(index=index) == {"CANCELLED"}
    bpy.data.materials.remove(bpy.data.materials["Cartoon"])
    assert bpy.ops.opal.select_reported(index=index) == {"CANCELLED"}
    with pytest.raises(RuntimeError, match="there is no line 99"):
        bpy.ops.opal.select_reported(index=99)


def test_a_scene_without_a_report_has_nothing_to_select():
    assert not bpy.ops.opal.select_reported.poll()


def test_renaming_does_not_lose_what_a_line_is_about(rendered):
    worn = stage.plane(material=toon())
    rendered()
    bpy.data.materials["Cartoon"].name = "Painted"
    assert click("Cartoon") == [worn.name]
