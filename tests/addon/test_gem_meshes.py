# SPDX-License-Identifier: GPL-3.0-or-later
"""Gems whose meshes are wrong: the report names the object, and the picture is sane."""

import bpy
import numpy as np
import pytest
import stage

FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def cube(h, center=(0, 0, 0)):
    return [tuple(np.add(center, corner)) for corner in ((x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h))]


def stone_in_a_furnace(material_index=1.5):
    scene = stage.scene(12, 12, passes=4, samples=16)
    material = bpy.data.materials.new("Glass")
    material.opal.kind = "GEM"
    gem = material.opal.gem
    gem.dispersion, gem.cauchy_b, gem.cauchy_c = "CAUCHY", material_index, 0.0
    obj = stage.mesh("Stone", cube(0.5), FACES, material=material)
    obj.rotation_euler = (0.4, 0.3, 0)
    stage.world()
    stage.camera((0, 0, 3), type="ORTHO", ortho_scale=0.8)
    return scene, obj


def about(name):
    return [line for line in stage.problems() if line.startswith(f"{name}:")]


def test_a_good_gem_is_not_spoken_of(opal, tmp_path):
    stone_in_a_furnace()
    image = stage.render(tmp_path)[..., :3]
    assert about("Stone") == [] and image.mean() == pytest.approx(1.0, abs=0.005)


def test_flipped_normals_are_named_and_make_no_difference(opal, tmp_path):
    _, obj = stone_in_a_furnace()
    material = obj.data.materials[0].opal.gem
    material.absorption_color, material.absorption_depth = (0.3, 0.5, 0.8), 0.7
    right = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    obj.data.flip_normals()
    flipped = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    assert any("normals are flipped" in line for line in about("Stone"))
    assert flipped == pytest.approx(right, rel=0.01)


def test_what_shares_a_flipped_mesh_has_it_turned_where_it_is_a_gem(opal, tmp_path):
    """Slots may be objects': whichever was read first, a matte one among them, said for all which faces are turned."""
    obj = tinted_stone()
    stone = stage.link("Second", obj.data)
    stone.rotation_euler = obj.rotation_euler
    obj.location = (9, 0, 0)
    obj.material_slots[0].link, obj.material_slots[0].material = "OBJECT", stage.matte()
    right = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    obj.data.flip_normals()
    flipped = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    assert any("normals are flipped" in line for line in about("Second"))
    assert flipped == pytest.approx(right, rel=0.01)


def test_some_flipped_faces_are_named(opal, tmp_path):
    _, obj = stone_in_a_furnace()
    obj.data.polygons[2].flip()
    obj.data.update()
    image = stage.render(tmp_path)
    assert any("recalculate" in line for line in about("Stone"))
    assert image.max() < 3


def test_an_open_gem_is_named_and_is_neither_black_nor_burnt(opal, tmp_path):
    _, obj = stone_in_a_furnace()
    corners = [v.co.copy() for v in obj.data.vertices]
    faces = [tuple(p.vertices) for p in obj.data.polygons][:-1]
    material = obj.data.materials[0]
    obj.data = bpy.data.meshes.new("Open")
    obj.data.from_pydata(corners, [], faces)
    obj.data.materials.append(material)
    image = stage.render(tmp_path)[..., :3]
    assert any("open at 4 edges" in line for line in about("Stone"))
    assert 0.4 < image.mean() < 1.6


def joined(obj, *others):
    """Makes one mesh of a stone and of others: (corners, faces, material or None for the stone's own)."""
    corners, faces, slots = (
        [tuple(v.co) for v in obj.data.vertices],
        [tuple(p.vertices) for p in obj.data.polygons],
        [0] * len(obj.data.polygons),
    )
    materials = [obj.data.materials[0]]
    for more, polygons, material in others:
        if material is not None and material not in materials:
            materials.append(material)
        faces += [tuple(len(corners) + i for i in polygon) for polygon in polygons]
        slots += [materials.index(material or materials[0])] * len(polygons)
        corners += more
    obj.data = bpy.data.meshes.new("Joined")
    obj.data.from_pydata(corners, [], faces)
    for material in materials:
        obj.data.materials.append(material)
    obj.data.polygons.foreach_set("material_index", slots)
    obj.data.update()


def tinted_stone():
    _, obj = stone_in_a_furnace()
    gem = obj.data.materials[0].opal.gem
    gem.absorption_color, gem.absorption_depth = (0.3, 0.5, 0.8), 0.7
    return obj


RING = (cube(0.2, (3, 0, 0)), FACES)
STONE = (cube(0.2, (0.9, 0, 0)), FACES)
SHEET = ([(5, 0, 0), (6, 0, 0), (6, 1, 0), (5, 1, 0)], [(0, 1, 2, 3)])
BUBBLE = (cube(0.25), [face[::-1] for face in FACES])


@pytest.mark.parametrize(
    "others, sentence",
    [
        (lambda: [(*RING, stage.matte())], "the gem's normals are flipped"),
        (lambda: [(*STONE, None)], "the normals of 1 of the mesh's 2 gems are flipped"),
        (lambda: [(*SHEET, stage.matte())], "the gem's normals are flipped"),
        (lambda: [([], [], stage.matte())], "the gem's normals are flipped"),
    ],
    ids=["with its ring", "with another stone", "with an open surface", "with a slot that nothing uses"],
)
def test_a_flipped_gem_is_mended_whatever_else_its_mesh_holds(others, sentence, opal, tmp_path):
    obj = tinted_stone()
    more = others()
    alone = obj.data
    joined(obj, *more)
    right = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    assert about("Stone") == []
    obj.data = alone
    obj.data.flip_normals()
    joined(obj, *more)
    flipped = stage.render(tmp_path)[..., :3].mean(axis=(0, 1))
    assert [line for line in about("Stone")] == [
        f"Stone: {sentence}, {'its faces look' if 'gem' in sentence[:8] else 'their faces look'} inwards; they are taken as looking outwards"
    ]
    assert flipped == pytest.approx(right, rel=0.01)


def test_a_cavity_looks_into_its_gem_and_nothing_is_said_of_it(opal, tmp_path):
    """A bubble as faces that look inwards leaves less of the stone to absorb than the whole one, and turning it would not."""
    obj = tinted_stone()
    whole = stage.render(tmp_path)[..., :3].mean()
    joined(obj, (*BUBBLE, None))
    hollow = stage.render(tmp_path)[..., :3].mean()
    assert about("Stone") == [] and hollow > 1.02 * whole
    obj.data.flip_normals()
    assert stage.render(tmp_path)[..., :3].mean() == pytest.approx(hollow, rel=0.01)
    assert about("Stone") == [
        "Stone: the normals of 1 of the mesh's 2 gems are flipped, their faces look inwards; they are taken as looking outwards"
    ]


def test_a_stone_closed_by_its_foil_is_closed(opal, tmp_path):
    obj = tinted_stone()
    obj.data.materials.append(stage.matte())
    obj.data.polygons[0].material_index = 1
    stage.render(tmp_path)
    assert about("Stone") == []
