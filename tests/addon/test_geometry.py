# SPDX-License-Identifier: GPL-3.0-or-later
"""What the evaluated depsgraph yields as meshes reaches the tracer where it is, as it is, and fast."""

import time

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402
from mathutils import Matrix  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")


def collected():
    return stage.addon("translate.instances").collect(bpy.context.evaluated_depsgraph_get())


def read(obj, **needs):
    meshes = stage.addon("translate.meshes")
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return meshes.read_mesh(evaluated.data, meshes.MeshNeeds(**needs))


def normals_seen(tmp_path):
    """The Normal pass of a render of the current scene."""
    bpy.context.view_layer.use_pass_normal = True
    return stage.render_passes(tmp_path)["Normal"]


def coverage(tmp_path):
    """The share of the frame that is covered, film transparent."""
    bpy.context.scene.render.film_transparent = True
    return float((stage.render(tmp_path)[..., 3] > 0.5).mean())


def test_modifiers_are_applied():
    obj = stage.plane()
    obj.modifiers.new("Array", "ARRAY").count = 5
    assert len(read(obj).triangles) == 10


def test_triangles_name_the_right_corners_of_any_polygon():
    points = [(np.cos(a), np.sin(a), 0) for a in np.linspace(0, 2 * np.pi, 7, endpoint=False)]
    arrays = read(stage.mesh("Heptagon", points, [range(7)]))
    corners = arrays.positions[arrays.triangles]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert len(areas) == 5
    assert areas.sum() == pytest.approx(3.5 * np.sin(2 * np.pi / 7), rel=1e-6)


def test_flat_faces_bring_no_normals_smooth_ones_bring_the_vertices():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
    ball = bpy.context.object
    assert read(ball).corner_normals is None
    ball.data.shade_smooth()
    arrays = read(ball)
    outward = arrays.positions[arrays.triangles]
    outward = outward / np.linalg.norm(outward, axis=2, keepdims=True)
    normals = arrays.corner_normals.reshape(-1, 3, 3)
    assert (normals * outward).sum(axis=2).min() > 0.99


def test_custom_normals_are_kept():
    obj = stage.plane()
    wanted = np.array((0.6, 0.0, 0.8))
    obj.data.normals_split_custom_set([tuple(wanted)] * 4)
    np.testing.assert_allclose(read(obj).corner_normals.reshape(-1, 3), np.tile(wanted, (6, 1)), atol=1e-3)


def test_uv_maps_and_colours_arrive_per_corner_vertex_and_face():
    obj = stage.plane()
    data = obj.data
    data.uv_layers.new(name="Map").uv.foreach_set("vector", [0, 0, 1, 0, 1, 1, 0, 1])
    data.attributes.new("Shade", "FLOAT_COLOR", "POINT").data.foreach_set("color", np.arange(16, dtype=np.float32))
    data.attributes.new("Heat", "FLOAT", "FACE").data.foreach_set("value", [7.0])
    arrays = read(obj, attributes={"": 0, "Shade": 1, "Heat": 2, "Missing": 3})
    found = {number: (domain, values) for number, domain, values in arrays.attributes}
    assert set(found) == {0, 1, 2}
    assert [found[i][0] for i in range(3)] == [0, 1, 2]
    corners = arrays.positions[arrays.triangles].reshape(-1, 3)
    np.testing.assert_allclose(found[0][1], corners[:, :2] / 2 + 0.5, atol=1e-6)
    np.testing.assert_allclose(found[1][1].reshape(-1), np.arange(16))
    np.testing.assert_allclose(found[2][1], [[7.0], [7.0]])


def test_a_colour_attribute_without_a_name_is_the_one_that_renders(tmp_path):
    stage.scene(samples=16)
    stage.camera((0, 0, 5))
    material = stage.glowing()
    tree = material.node_tree
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    tree.links.new(tree.nodes.new("ShaderNodeVertexColor").outputs["Color"], emission.inputs["Color"])
    card = stage.plane(size=20, material=material)
    for name, color in (("Other", (1, 1, 1, 1)), ("Mine", (0.1, 0.7, 0.3, 1))):
        for value in card.data.color_attributes.new(name, "FLOAT_COLOR", "POINT").data:
            value.color = color
    card.data.color_attributes.render_color_index = card.data.color_attributes.find("Mine")
    assert stage.render(tmp_path)[..., :3].mean(axis=(0, 1)) == pytest.approx((0.1, 0.7, 0.3), abs=0.02)
    assert not stage.problems()


def test_generated_coordinates_run_from_0_to_1_over_the_mesh():
    obj = stage.mesh("Box", [(x, y, z) for x in (-1, 3) for y in (0, 2) for z in (5, 6)], [(0, 1, 3, 2), (4, 6, 7, 5)])
    generated = read(obj, generated=True).generated
    assert sorted(map(tuple, generated.round(5).tolist())) == [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]


def test_generated_coordinates_ignore_deformation(tmp_path):
    stage.scene(passes=4, samples=8)
    stage.camera((1, 0, 5), type="ORTHO", ortho_scale=0.2)
    material = stage.glowing()
    tree = material.node_tree
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    tree.links.new(coordinates.outputs["Generated"], emission.inputs["Color"])
    moved = stage.plane(material=material).modifiers.new("Move", "DISPLACE")
    moved.direction, moved.strength, moved.mid_level = "X", 1.0, 0.0
    picture = stage.render(tmp_path)[..., :3].mean((0, 1))
    np.testing.assert_allclose(picture, (0.5, 0.5, 0.5), atol=0.05)


def test_tangents_follow_the_uv_map_for_quads_and_for_polygons_of_more_corners():
    points = [(np.cos(a), np.sin(a), 0) for a in np.linspace(0, 2 * np.pi, 6, endpoint=False)]
    for obj in (stage.plane(), stage.mesh("Hexagon", points, [range(6)])):
        layer = obj.data.uv_layers.new(name="Map")
        corners = [obj.data.vertices[loop.vertex_index].co for loop in obj.data.loops]
        layer.uv.foreach_set("vector", [c for co in corners for c in (co.y, -co.x)])  # u runs along +Y
        tangents = read(obj, tangent_uv="Map").corner_tangents.reshape(-1, 4)
        np.testing.assert_allclose(tangents, np.tile((0, 1, 0, 1), (len(tangents), 1)), atol=1e-5)


@pytest.mark.parametrize("kind", ["curve", "text", "metaball", "surface"])
def test_curves_text_metaballs_and_surfaces_are_rendered(kind, tmp_path):
    stage.scene()
    stage.camera((0, 0, 8))
    if kind == "curve":
        bpy.ops.curve.primitive_bezier_circle_add(radius=1.5)
        bpy.context.object.data.bevel_depth = 0.5
    elif kind == "text":
        bpy.ops.object.text_add(location=(-1.5, -0.7, 0))
        bpy.context.object.data.size = 4
    elif kind == "metaball":
        bpy.ops.object.metaball_add(radius=2)
    else:
        bpy.ops.surface.primitive_nurbs_surface_sphere_add(radius=2)
    assert coverage(tmp_path) > 0.02


def test_a_hundred_thousand_instances_are_read_in_seconds():
    side = 316
    ball = stage.plane("Copied", size=0.5)
    points = np.zeros((side * side, 3), np.float32)
    points[:, :2] = np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2)
    cloud = bpy.data.meshes.new("Cloud")
    cloud.vertices.add(len(points))
    cloud.vertices.foreach_set("co", points.reshape(-1))
    parent = stage.link("Cloud", cloud)
    parent.instance_type = "VERTS"
    ball.parent = parent
    depsgraph = bpy.context.evaluated_depsgraph_get()
    begun = time.perf_counter()
    visible = stage.addon("translate.instances").collect(depsgraph)
    seconds = time.perf_counter() - begun
    group = max(visible.groups, key=lambda g: len(g.rows))
    assert len(group.rows) == side * side + 1  # the object that is copied is shown too
    np.testing.assert_allclose(np.sort(group.transforms[1:, 0, 3]), np.sort(points[:, 0]))
    assert len(np.unique(group.object_info[:, 0])) > 0.99 * side * side
    assert seconds < 5, f"{seconds:.1f} s"


def test_a_million_triangles_are_read_in_two_seconds():
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=708, y_subdivisions=708)
    obj = bpy.context.object
    obj.data.shade_smooth()
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    meshes = stage.addon("translate.meshes")
    begun = time.perf_counter()
    arrays = meshes.read_mesh(evaluated, meshes.MeshNeeds({"": 0}))
    seconds = time.perf_counter() - begun
    assert len(arrays.triangles) == 1_002_528 and len(arrays.attributes) == 1
    assert seconds < 2, f"{seconds:.2f} s"


def test_geometry_nodes_instances_stay_instances():
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    grid, cube, scatter, out = (
        tree.nodes.new(name) for name in ("GeometryNodeMeshGrid", "GeometryNodeMeshCube", "GeometryNodeInstanceOnPoints", "NodeGroupOutput")
    )
    grid.inputs["Vertices X"].default_value = grid.inputs["Vertices Y"].default_value = 7
    tree.links.new(grid.outputs["Mesh"], scatter.inputs["Points"])
    tree.links.new(cube.outputs["Mesh"], scatter.inputs["Instance"])
    tree.links.new(scatter.outputs["Instances"], out.inputs[0])
    obj = stage.plane()
    obj.modifiers.new("Scatter", "NODES").node_group = tree
    (group,) = (group for group in collected().groups if len(group.mesh.polygons))
    assert len(group.rows) == 49
    assert len(group.mesh.polygons) == 6


def test_objects_that_share_a_mesh_share_it_in_the_kernels_too():
    first = stage.plane()
    second = stage.link("Second", first.data, (3, 0, 0))
    (group,) = collected().groups
    assert len(group.rows) == 2
    second.visible_glossy = False
    bpy.context.view_layer.update()
    groups = collected().groups
    assert [g.visibility for g in groups] in ([63, 59], [59, 63])
    assert groups[0].mesh == groups[1].mesh


def test_hidden_objects_and_collections_are_not_rendered(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    stage.plane(size=20).hide_render = True
    assert coverage(tmp_path) == 0


def left_in_edit_mode(obj, factor):
    """Enters edit mode and scales the mesh there, without leaving."""
    import bmesh

    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    edited = bmesh.from_edit_mesh(obj.data)
    for vertex in edited.verts:
        vertex.co *= factor
    bmesh.update_edit_mesh(obj.data)


def test_a_mesh_in_edit_mode_is_rendered_as_edited_and_so_are_all_that_share_it(tmp_path):
    """Objects that share it and instances of it were left out: only who was edited had a mesh."""
    stage.scene(width=36, height=12)
    stage.camera((0, 0, 5), type="ORTHO", ortho_scale=6)
    card = stage.plane(size=4, location=(-2, 0, 0))
    stage.link("Sharing", card.data)
    copied = bpy.data.collections.new("Copied")
    copied.objects.link(card)
    copies = stage.link("Copies", None, (4, 0, 0))
    copies.instance_type, copies.instance_collection = "COLLECTION", copied
    left_in_edit_mode(card, 0.25)
    try:
        assert len({group.mesh.as_pointer() for group in collected().groups}) == 2, "one copy of the mesh an object"
        assert coverage(tmp_path) == pytest.approx(3 / 12, abs=0.02)  # three cards of 1 m in a picture of 6 by 2 m
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


def test_a_holdout_stays_a_hole_where_its_collection_is_also_indirect_only(tmp_path):
    scene = stage.scene()
    stage.camera((0, 0, 5))
    stage.world()
    card = stage.plane(size=20)
    collection = bpy.data.collections.new("Hole")
    scene.collection.children.link(collection)
    scene.collection.objects.unlink(card)
    collection.objects.link(card)
    layer = bpy.context.view_layer.layer_collection.children["Hole"]
    layer.indirect_only = True
    assert stage.render(tmp_path)[..., 3].mean() == pytest.approx(1.0), "only the sky is seen"
    layer.holdout = True
    assert stage.render(tmp_path)[..., 3].max() == 0


@pytest.mark.parametrize(("way", "seen"), [("indirect_only", 1.0), ("holdout", 0.0), ("is_holdout", 0.0)])
def test_what_hides_an_instancer_hides_its_instances(way, seen, tmp_path):
    """Alpha: of the sky behind what is indirect only, none in a hole."""
    scene = stage.scene()
    stage.camera((0, 0, 5))
    stage.world()
    card = stage.plane(size=20, material=stage.glowing(strength=5))
    copied, around = bpy.data.collections.new("Copied"), bpy.data.collections.new("Around")
    scene.collection.objects.unlink(card)
    copied.objects.link(card)
    scene.collection.children.link(around)
    copies = bpy.data.objects.new("Copies", None)
    copies.instance_type, copies.instance_collection = "COLLECTION", copied
    around.objects.link(copies)
    owner = copies if way == "is_holdout" else bpy.context.view_layer.layer_collection.children["Around"]
    setattr(owner, way, True)
    picture = stage.render(tmp_path)
    assert picture[..., 3].mean() == pytest.approx(seen), "alpha"
    assert picture[..., :3].max() < 1.1, "the card itself is not seen"


@pytest.mark.parametrize("left_out, expected", [(None, 0.25), ("use_sky", 0.0), ("use_solid", 1.0)])
def test_the_view_layer_s_filter_leaves_out_what_it_says(left_out, expected, tmp_path):
    stage.scene(samples=16)
    stage.camera((0, 0, 5))
    stage.world()
    stage.plane(size=40, material=stage.matte(color=(0.25,) * 3))
    if left_out:
        setattr(bpy.context.view_layer, left_out, False)
    assert stage.render(tmp_path)[..., :3].mean() == pytest.approx(expected, abs=0.01)


def test_the_view_layer_s_filter_leaves_out_volumes_alone():
    stage.plane()
    stage.link("Cloud", bpy.data.volumes.new("Cloud"))
    bpy.context.view_layer.use_volumes = False
    assert [str(group.name) for group in collected().groups] == ["Plane"]


@pytest.mark.parametrize("ray", ["camera", "diffuse", "shadow"])
def test_ray_visibility_hides_an_object_from_that_kind_of_ray_alone(ray, tmp_path):
    stage.scene(passes=8, samples=8)
    stage.camera((0, 0, 5), clip_start=0.1)
    stage.world()
    stage.plane(size=40, material=stage.matte())
    lid = stage.plane("Lid", size=40, location=(0, 0, 6), material=stage.matte("Black", (0, 0, 0)))
    lit = {"camera": False, "diffuse": True, "shadow": True}
    setattr(lid, f"visible_{ray}", False)
    if ray in ("diffuse", "shadow"):  # both together let the world's light through
        lid.visible_diffuse = lid.visible_shadow = False
    brightness = stage.render(tmp_path)[..., :3].mean()
    assert (brightness > 0.4) == lit[ray], brightness


def test_material_slots_choose_the_material_of_each_face(tmp_path):
    scene = stage.scene()
    stage.camera((0, 0, 5))
    obj = stage.mesh(
        "Two",
        [(-9, -9, 0), (0, -9, 0), (0, 9, 0), (-9, 9, 0), (9, -9, 0), (9, 9, 0)],
        [(0, 1, 2, 3), (1, 4, 5, 2)],
        material=stage.glowing("Red", (1, 0, 0)),
    )
    obj.data.materials.append(stage.glowing("Green", (0, 1, 0)))
    obj.data.polygons[1].material_index = 1
    picture = stage.render(tmp_path)[..., :3]
    left, right = picture[:, : scene.render.resolution_x // 2 - 2], picture[:, scene.render.resolution_x // 2 + 2 :]
    assert left[..., 0].mean() > 0.8 > 20 * abs(left[..., 1].mean())
    assert right[..., 1].mean() > 0.8 > 20 * abs(right[..., 0].mean())


def test_a_face_without_material_shows_what_cycles_shows(tmp_path):
    scene = stage.scene(width=32, height=8, passes=4, samples=16)
    stage.camera((0, -5, 0.7), (1.45, 0, 0))
    stage.plane(size=200)
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy = 3
    stage.link("Sun", sun).rotation_euler = (0.9, 0.3, 0)
    ours = stage.render(tmp_path)[..., :3]
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 64
    scene.cycles.use_denoising = False
    theirs = stage.render(tmp_path)[..., :3]
    np.testing.assert_allclose(ours.mean((1, 2)), theirs.mean((1, 2)), rtol=5e-3)


def test_an_object_linked_slot_wins_over_the_mesh_s_material(tmp_path):
    stage.scene()
    stage.camera((0, 0, 5))
    obj = stage.plane(size=20, material=stage.glowing("Mesh's", (1, 0, 0)))
    obj.material_slots[0].link = "OBJECT"
    obj.material_slots[0].material = stage.glowing("Object's", (0, 0, 1))
    picture = stage.render(tmp_path)[..., :3].mean((0, 1))
    assert picture[2] > 0.8 and abs(picture[0]) < 0.05


def test_negative_scale_mirrors_and_keeps_normals_outward(tmp_path):
    stage.scene(width=24, height=24)
    stage.camera((0, 0, 6))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=2)
    ball = bpy.context.object
    ball.data.shade_smooth()
    before = normals_seen(tmp_path)
    ball.scale = (-1, 1, 1)
    np.testing.assert_allclose(normals_seen(tmp_path), before, atol=0.05)


def test_parented_and_animated_objects_are_where_blender_puts_them():
    scene = bpy.context.scene
    parent, child = stage.plane("Parent"), stage.plane("Child", location=(1, 0, 0))
    child.parent = parent
    parent.keyframe_insert("location", frame=1)
    parent.location = (10, 0, 5)
    parent.rotation_euler.z = np.pi / 2
    parent.keyframe_insert("location", frame=11)
    scene.frame_set(11)
    transforms = np.concatenate([g.transforms for g in collected().groups])
    expected = Matrix.Translation((10, 0, 5)) @ Matrix.Rotation(np.pi / 2, 4, "Z") @ Matrix.Translation((1, 0, 0))
    distances = np.abs(transforms - np.array(expected, np.float32)[:3]).max(axis=(1, 2))
    assert distances.min() < 1e-5


def test_object_random_is_the_hash_that_cycles_shows():
    random = stage.addon("translate.instances").object_random
    values = [random(f"Object.{i:03d}") for i in range(200)]
    assert min(values) >= 0 and max(values) <= 1
    assert np.std(values) == pytest.approx(np.sqrt(1 / 12), rel=0.15)
