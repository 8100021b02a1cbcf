# SPDX-License-Identifier: GPL-3.0-or-later
"""Media as artists set them: presets, density by noise and grid, volume objects, worlds, clouded gems, and what is refused.

Boxes of 2 m stand before an even white sky and are seen straight through, so that a pixel is exp(-optical depth); 192 pixels of
32 paths know the mean to about 0.006.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import stage  # noqa: E402

pytestmark = pytest.mark.usefixtures("opal")

CORNERS = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def before_the_sky(*colour):
    scene = stage.scene(passes=4, samples=8)
    stage.world(colour or (1, 1, 1))
    stage.camera((0, 0, 5), type="ORTHO", ortho_scale=0.8)
    return scene


def absorbing(extinction=0.5, **settings):
    material = bpy.data.materials.new("Medium")
    material.opal.kind = "MEDIUM"
    medium = material.opal.medium
    medium.extinction, medium.albedo = extinction, (0, 0, 0)
    for name, value in settings.items():
        setattr(medium, name, value)
    return material


def mean(folder):
    return stage.render(folder)[..., :3].mean(axis=(0, 1))


def said(text):
    return any(text in sentence for sentence in stage.problems())


def write_grid(path, values, name="density"):
    """A grid of 2 m about the origin in an OpenVDB file, by Blender's own openvdb."""
    bpy.utils.expose_bundled_modules()
    openvdb = pytest.importorskip("openvdb")
    grid = openvdb.FloatGrid()
    grid.copyFromArray(np.asarray(values, np.float32))
    grid.name = name
    grid.transform = openvdb.createLinearTransform(2 / (len(values) - 1))
    grid.transform.postTranslate((-1, -1, -1))
    openvdb.write(str(path), grids=[grid])


def cloud(folder, values, name="density"):
    """A volume object with one grid."""
    write_grid(folder / "cloud.vdb", values, name)
    volume = bpy.data.volumes.new("Cloud")
    volume.filepath = str(folder / "cloud.vdb")
    return stage.link("Cloud", volume)


def test_a_homogeneous_box(tmp_path):
    before_the_sky()
    stage.mesh("Box", CORNERS, FACES, material=absorbing(0.5))
    assert mean(tmp_path) == pytest.approx(math.exp(-1), abs=0.025)


def test_extinction_by_colour(tmp_path):
    """Blue is taken, red passes."""
    before_the_sky()
    stage.mesh("Box", CORNERS, FACES, material=absorbing(0.8, extinction_color=(0.1, 0.4, 1.0)))
    red, green, blue = mean(tmp_path)
    assert red > green > blue and red == pytest.approx(math.exp(-0.16), abs=0.06)


def test_even_noise_is_half_as_dense(tmp_path):
    before_the_sky()
    stage.mesh("Box", CORNERS, FACES, material=absorbing(1.0, density="NOISE", noise_contrast=0.0))
    assert mean(tmp_path) == pytest.approx(math.exp(-1), abs=0.025)


def test_noise_makes_clouds(tmp_path):
    scene = before_the_sky()
    scene.opal.passes = 8
    material = absorbing(1.0, density="NOISE", noise_contrast=8.0, noise_scale=0.5)
    stage.mesh("Box", CORNERS, FACES, material=material)
    assert stage.render(tmp_path)[..., 1].std() > 0.05


def test_every_preset_has_its_source_and_its_numbers():
    presets = stage.addon("media_presets").PRESETS
    medium = bpy.data.materials.new("Preset").opal.medium
    for name, row in presets.items():
        medium.preset = name
        assert row.source and medium.extinction == pytest.approx(max(row.extinction), rel=1e-5), name
        assert all(0 <= a <= 1 for a in medium.albedo) and max(medium.extinction_color) == pytest.approx(1), name
    assert {"HAZE", "FOG", "SMOKE", "DUST", "MILK", "MARBLE", "ORANGE_JUICE", "SEAWATER"} <= set(presets)


def test_a_volume_object_with_a_grid(tmp_path):
    before_the_sky()
    obj = cloud(tmp_path, np.full((9, 9, 9), 0.5))
    obj.data.materials.append(absorbing(1.0, density="GRID"))
    # 2 m of density one half, and one voxel of 0.25 m at either end over which it falls to nothing.
    assert mean(tmp_path) == pytest.approx(math.exp(-1 - 0.125), abs=0.025)


def test_a_volume_object_moves_and_grows_with_its_object(tmp_path):
    before_the_sky()
    obj = cloud(tmp_path, np.full((9, 9, 9), 0.5))
    obj.data.materials.append(absorbing(1.0, density="GRID"))
    obj.scale = (1, 1, 0.5)
    obj.location = (0.1, 0, 1)
    obj.data.render.space = "WORLD"
    assert mean(tmp_path) == pytest.approx(math.exp(-0.5 - 0.0625), abs=0.025)
    obj.data.render.space = "OBJECT"  # as dense as in object space, by the mean scale
    assert mean(tmp_path) == pytest.approx(math.exp((-0.5 - 0.0625) / math.sqrt(0.75)), abs=0.025)


def test_copies_of_a_volume_object_are_as_dense_as_their_own_scale_says(tmp_path):
    """Two of one datablock side by side, of scale 1 and 0.4: as opaque, where the render space is Object."""
    before_the_sky()
    obj = cloud(tmp_path, np.full((9, 9, 9), 0.5))
    obj.data.materials.append(absorbing(1.0, density="GRID"))
    small = stage.link("Small", obj.data, (2, 0, 0))
    small.scale = (0.4, 0.4, 0.4)
    for space, depth in (("OBJECT", 1.125), ("WORLD", 0.4 * 1.125)):
        obj.data.render.space = space
        bpy.context.scene.camera.location.x = 0
        assert mean(tmp_path) == pytest.approx(math.exp(-1.125), abs=0.025), space
        bpy.context.scene.camera.location.x, bpy.context.scene.camera.data.ortho_scale = 2, 0.3
        assert mean(tmp_path) == pytest.approx(math.exp(-depth), abs=0.025), space


def test_a_sequence_shows_each_frame_its_own_file(tmp_path):
    scene = before_the_sky()
    densities = 0.2, 0.5, 0.8
    for number, density in enumerate(densities, 1):
        write_grid(tmp_path / f"cloud_{number:04d}.vdb", np.full((9, 9, 9), density))
    volume = bpy.data.volumes.new("Cloud")
    volume.filepath = str(tmp_path / "cloud_0001.vdb")
    volume.is_sequence, volume.frame_start, volume.frame_duration = True, 11, len(densities)
    volume.materials.append(absorbing(1.0, density="GRID"))
    stage.link("Cloud", volume)

    def seen(frame):
        scene.frame_set(frame)
        return mean(tmp_path)

    for frame, density in zip((11, 12, 13), densities, strict=True):
        assert seen(frame) == pytest.approx(math.exp(-2.25 * density), abs=0.025), f"frame {frame}: {stage.problems()}"
    volume.frame_offset = 1
    assert seen(11) == pytest.approx(math.exp(-2.25 * densities[1]), abs=0.025)
    volume.frame_offset, volume.sequence_mode = 0, "CLIP"
    assert seen(20) == pytest.approx(1.0, abs=0.025), "before and after a clipped sequence there is nothing"
    volume.sequence_mode = "REPEAT"
    assert seen(15) == pytest.approx(math.exp(-2.25 * densities[1]), abs=0.025)


def test_a_volume_that_nodes_generate(tmp_path):
    before_the_sky()
    group = bpy.data.node_groups.new("Fog", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    cube, material, output = (group.nodes.new(n) for n in ("GeometryNodeVolumeCube", "GeometryNodeSetMaterial", "NodeGroupOutput"))
    cube.inputs["Density"].default_value = 0.5
    material.inputs["Material"].default_value = absorbing(1.0, density="GRID")
    group.links.new(cube.outputs[0], material.inputs[0])
    group.links.new(material.outputs[0], output.inputs[0])
    obj = stage.link("Generated", bpy.data.volumes.new("Generated"))
    obj.modifiers.new("Nodes", "NODES").node_group = group
    pytest.importorskip("openvdb")
    assert mean(tmp_path) == pytest.approx(math.exp(-1), abs=0.08), stage.problems()


def test_a_missing_grid_is_named_and_is_nothing(tmp_path):
    before_the_sky()
    obj = cloud(tmp_path, np.ones((9, 9, 9)))
    obj.data.materials.append(absorbing(1.0, density="GRID", grid="smog"))
    assert mean(tmp_path) == pytest.approx(1, abs=0.01)
    assert said("“smog”"), stage.problems()


def test_a_missing_file_is_nothing_and_is_said(tmp_path):
    before_the_sky()
    volume = bpy.data.volumes.new("Gone")
    volume.filepath = str(tmp_path / "gone.vdb")
    stage.link("Gone", volume)
    assert mean(tmp_path) == pytest.approx(1, abs=0.01)
    assert said("Gone"), stage.problems()


def test_voxels_that_are_no_densities_are_counted(tmp_path):
    values = np.full((9, 9, 9), 0.5)
    values[3, 3, 3], values[1, 1, 1], values[2, 2, 2] = np.inf, -1.0, -2.0
    before_the_sky()
    obj = cloud(tmp_path, values)
    obj.data.materials.append(absorbing(1.0, density="GRID"))
    assert np.isfinite(mean(tmp_path)).all()
    assert said("1 voxels are not finite") and said("2 voxels are negative"), stage.problems()


def test_a_grid_beyond_memory_is_refused_with_its_size(tmp_path, monkeypatch):
    from opal_kernels import memory

    monkeypatch.setattr(memory, "available_bytes", lambda: 5000)
    before_the_sky()
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 4
    obj = cloud(tmp_path, np.ones((9, 9, 9)))
    obj.data.materials.append(absorbing(1.0, density="GRID"))
    monkeypatch.setattr(memory, "film_bytes", lambda *_: 0)
    assert mean(tmp_path) == pytest.approx(1, abs=0.01)
    assert said("9 x 9 x 9 voxels"), stage.problems()


def test_an_open_mesh_is_a_surface_and_is_said(tmp_path):
    before_the_sky()
    stage.mesh("Box", CORNERS, FACES[:-1], material=absorbing(5.0))
    stage.render(tmp_path)
    assert said("Box: Medium: the mesh is open"), stage.problems()


def test_a_body_turned_inside_out_is_turned_back_and_said(tmp_path):
    """Of two boxes in one mesh the one that is looked through is inside out; then media by nodes, then both boxes."""
    before_the_sky()
    apart = [(x + 4, y, z) for x, y, z in CORNERS]
    inward = [face[::-1] for face in FACES]
    nodes = stage.node_material("Nodes", "VolumeAbsorption", Color=(0, 0, 0, 1), Density=0.5)
    tree = nodes.node_tree
    shader, output = (next(n for n in tree.nodes if n.type == kind) for kind in ("VOLUME_ABSORPTION", "OUTPUT_MATERIAL"))
    tree.links.new(shader.outputs[0], output.inputs["Volume"])
    tree.links.remove(output.inputs["Surface"].links[0])
    for material, other, sentence in (
        (absorbing(0.5), FACES, "Boxes: the normals of 1 of the mesh's 2 media are flipped"),
        (nodes, inward, "Boxes: the normals of 2 of the mesh's 2 media are flipped"),
    ):
        faces = inward + [tuple(corner + 8 for corner in face) for face in other]
        obj = stage.mesh("Boxes", CORNERS + apart, faces, material=material)
        assert mean(tmp_path) == pytest.approx(math.exp(-1), abs=0.025), material.name
        assert said(sentence), stage.problems()
        bpy.data.objects.remove(obj)
    stage.mesh("Fine", CORNERS, FACES, material=nodes)
    assert mean(tmp_path) == pytest.approx(math.exp(-1), abs=0.025)
    assert not stage.problems()


@pytest.mark.parametrize(
    "where, name, sentence",
    [
        ("volume", "", "Cloud: Grid: no grid is named"),
        ("mesh", "density", "Box: Grid: there are no grids in what is neither"),
        ("world", "density", "World: Grid: there are no grids in what is neither"),
    ],
)
def test_a_density_by_grid_without_grids_says_so(tmp_path, where, name, sentence):
    scene = before_the_sky()
    material = absorbing(1.0, density="GRID", grid=name)
    if where == "volume":
        cloud(tmp_path, np.ones((9, 9, 9))).data.materials.append(material)
    elif where == "mesh":
        stage.mesh("Box", CORNERS, FACES, material=material)
    else:
        scene.world.opal.kind, scene.world.opal.scale_height = "MEDIUM", 0.0
        scene.world.opal.medium.density = "GRID"
    assert mean(tmp_path) == pytest.approx(1, abs=0.01)
    assert said(sentence), stage.problems()


def test_no_extinction_is_clear(tmp_path):
    before_the_sky()
    stage.mesh("Box", CORNERS, FACES, material=absorbing(0.0))
    assert mean(tmp_path) == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize("density", ["HOMOGENEOUS", "NOISE"])
def test_albedo_one_without_light_ends_and_is_black(tmp_path, density):
    stage.scene(passes=1, samples=2)
    stage.camera((0, 0, 0))
    material = absorbing(50.0, density=density)
    material.opal.medium.albedo = (1, 1, 1)
    stage.mesh("Box", CORNERS, FACES, material=material)
    assert not stage.render(tmp_path)[..., :3].any()


def test_a_clouded_gem_is_darker_than_a_clear_one(tmp_path):
    before_the_sky()
    means = []
    for clouded in (False, True):
        material = bpy.data.materials.new("Opal")
        material.opal.kind = "GEM"
        material.opal.use_medium = clouded
        material.opal.medium.extinction, material.opal.medium.albedo = 1.0, (0, 0, 0)
        obj = stage.mesh("Stone", CORNERS, FACES, material=material)
        means.append(mean(tmp_path)[1])
        bpy.data.objects.remove(obj)
    assert means[1] < 0.4 * means[0], means


def test_haze_of_the_world_thins_with_height(tmp_path):
    scene = before_the_sky()
    world = scene.world.opal
    world.kind, world.scale_height = "MEDIUM", 50.0
    world.medium.extinction, world.medium.albedo = 0.02, (0, 0, 0)
    bpy.context.scene.camera.rotation_euler = (math.pi, 0, 0)  # straight up, from 5 m
    assert mean(tmp_path) == pytest.approx(math.exp(-0.02 * 50 * math.exp(-0.1)), abs=0.025)
    assert not stage.problems()


def test_haze_chosen_for_a_world_lets_half_of_the_sky_through_from_overhead(tmp_path):
    scene = before_the_sky()
    scene.world.opal.kind = "MEDIUM"
    scene.world.opal.medium.albedo = (0, 0, 0)
    bpy.context.scene.camera.rotation_euler = (math.pi, 0, 0)
    assert mean(tmp_path) == pytest.approx(math.exp(-0.5), abs=0.025)
    assert not stage.problems()


def test_a_worlds_own_numbers_stay_when_haze_is_chosen():
    world = stage.world().opal
    world.scale_height, world.medium.extinction = 20.0, 0.03
    world.kind = "MEDIUM"
    assert (world.scale_height, world.medium.extinction) == pytest.approx((20.0, 0.03))


def test_fog_without_end_says_that_it_hides_the_sky(tmp_path):
    scene = before_the_sky()
    scene.world.opal.kind, scene.world.opal.scale_height = "MEDIUM", 0.0
    scene.world.opal.medium.extinction = 0.1
    stage.link("Sun", bpy.data.lights.new("Sun", "SUN"))
    assert mean(tmp_path) == pytest.approx(0, abs=1e-6)
    assert said("scale height"), stage.problems()


def test_a_blackbody_glows_in_its_colour(tmp_path):
    stage.scene(passes=2, samples=8)
    stage.camera((0, 0, 5), type="ORTHO", ortho_scale=0.8)
    material = absorbing(0.0, emission_strength=0.5, emission_source="BLACKBODY", emission_temperature=3000.0)
    stage.mesh("Box", CORNERS, FACES, material=material)
    from opal_kernels.optics import colour

    assert mean(tmp_path) == pytest.approx(colour.blackbody_rec709(3000.0), rel=0.02)
