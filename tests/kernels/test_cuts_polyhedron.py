# SPDX-License-Identifier: GPL-3.0-or-later
"""Half-space intersection against solids whose volumes are in the books."""

import itertools
import math

import numpy as np
import pytest
from opal_kernels.cuts import intersect_half_spaces

SIGNS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
AXES = np.concatenate((np.eye(3), -np.eye(3)))
GOLDEN = (1.0 + math.sqrt(5.0)) / 2.0


def dodecahedron() -> tuple[np.ndarray, np.ndarray]:
    """The regular dodecahedron of inradius 1: its face normals are an icosahedron's corners."""
    corners = [np.roll((0.0, a, b * GOLDEN), turn) for a in (-1, 1) for b in (-1, 1) for turn in range(3)]
    return np.array(corners), np.ones(12)


@pytest.mark.parametrize(
    ("normals", "distances", "corners", "faces", "volume"),
    [
        (AXES, np.full(6, 0.5), 8, 6, 1.0),
        # |x| + |y| + |z| <= 1: four planes meet in each corner.
        (SIGNS, np.full(8, 1.0 / math.sqrt(3.0)), 6, 8, 4.0 / 3.0),
        # Edge a of inradius 1 from r = a·φ²/(2√(3 − φ)), volume (15 + 7√5)/4·a³.
        (*dodecahedron(), 20, 12, (15 + 7 * math.sqrt(5)) / 4 * (2 * math.sqrt(3 - GOLDEN) / GOLDEN**2) ** 3),
        # Cuboctahedron of edge √2: 5√2/3·a³; cube and octahedron planes meet four at a corner.
        (np.concatenate((AXES, SIGNS)), np.r_[np.ones(6), np.full(8, 2 / math.sqrt(3))], 12, 14, 5 * math.sqrt(2) / 3 * math.sqrt(2) ** 3),
    ],
    ids=["cube", "octahedron", "dodecahedron", "cuboctahedron"],
)
def test_solids_of_the_books_have_their_corners_faces_and_volume(normals, distances, corners, faces, volume):
    solid = intersect_half_spaces(normals, distances)
    assert (len(solid.vertices), len(solid.faces)) == (corners, faces)
    assert solid.is_watertight()
    assert solid.euler_characteristic() == 2
    assert solid.volume() == pytest.approx(volume, rel=1e-12)


def test_order_and_repetition_of_planes_change_nothing():
    normals, distances = dodecahedron()
    order = np.random.default_rng(1).permutation(np.tile(np.arange(12), 3))
    solid = intersect_half_spaces(normals[order], distances[order])
    assert len(solid.faces) == 12
    assert solid.volume() == pytest.approx(intersect_half_spaces(normals, distances).volume(), rel=1e-12)


def test_a_plane_that_only_touches_leaves_no_face():
    solid = intersect_half_spaces(np.vstack((AXES, SIGNS[-1:])), np.r_[np.full(6, 0.5), 0.5 * math.sqrt(3.0)])
    assert len(solid.faces) == 6
    assert 6 not in solid.planes


def test_each_face_lies_in_the_plane_it_names():
    normals, distances = dodecahedron()
    normals = normals / np.linalg.norm(normals, axis=1)[:, None]
    solid = intersect_half_spaces(normals, distances)
    for face, plane, vector in zip(solid.faces, solid.planes, solid.area_vectors(), strict=True):
        assert np.allclose(solid.vertices[list(face)] @ normals[plane], distances[plane], atol=1e-14)
        assert np.allclose(vector / np.linalg.norm(vector), normals[plane], atol=1e-14)


def test_random_tangent_planes_of_a_sphere_make_a_simple_polyhedron():
    """Generic planes meet three at a corner, so V = 2F − 4; the solid holds the sphere."""
    normals = np.random.default_rng(2).normal(size=(300, 3))
    solid = intersect_half_spaces(normals, np.ones(300))
    assert len(solid.faces) == 300
    assert len(solid.vertices) == 2 * 300 - 4
    assert solid.is_watertight()
    assert solid.planarity_error() < 1e-12
    assert 4 / 3 * math.pi < solid.volume() < 4 / 3 * math.pi * 1.1


@pytest.mark.parametrize(
    ("normals", "distances", "sentence"),
    [
        (AXES[:5], np.ones(5), "open"),
        (np.vstack((AXES, AXES[:1])), np.r_[np.ones(6), -2.0], "leaves nothing"),
        (np.vstack((AXES, np.zeros((1, 3)))), np.ones(7), "not zero"),
        (AXES, np.r_[np.ones(5), np.nan], "finite"),
        (AXES, np.zeros(6), "enclose nothing"),
        (AXES, np.ones(5), "6 normals but 5 distances"),
    ],
)
def test_planes_that_make_no_stone_are_refused_with_a_sentence(normals, distances, sentence):
    with pytest.raises(ValueError, match=sentence):
        intersect_half_spaces(normals, distances)
