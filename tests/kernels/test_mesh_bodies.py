# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of a mesh: cubes that are joined, split, sunk into each other and turned inside out are told apart."""

import numpy as np
import pytest
from opal_kernels.mesh_bodies import NO_GEM, bodies_of, parts, turned_inwards

CUBE = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
FACES = np.array([t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))])


def mesh(*cubes, gems=None):
    """Bodies of cubes (centre, half a side, whether it is turned inside out), joined to one mesh."""
    positions = np.concatenate([np.add(centre, half * CUBE) for centre, half, _ in cubes])
    triangles = np.concatenate([8 * i + (FACES[:, ::-1] if turned else FACES) for i, (_, _, turned) in enumerate(cubes)])
    kinds = np.repeat([0] * len(cubes) if gems is None else gems, 12)
    return described(positions, triangles, kinds)


def described(positions, triangles, kinds):
    _, place = np.unique(positions, axis=0, return_inverse=True)
    return bodies_of(triangles, place.reshape(-1)[triangles], positions, kinds)


def turned(bodies):
    return turned_inwards(bodies, bodies.gem != NO_GEM).tolist()


def test_each_body_has_its_volume():
    bodies = mesh(((0, 0, 0), 1, False), ((9, 0, 0), 0.5, True))
    assert bodies.volume == pytest.approx([8.0, -1.0]) and bodies.open_edges.tolist() == [0, 0] and not bodies.mixed.any()
    assert turned(bodies) == [False, True]


def test_stones_that_touch_in_a_face_stay_two():
    assert turned(mesh(((0, 0, 0), 1, False), ((2, 0, 0), 1, True))) == [False, True]


def test_a_cavity_stays_and_a_stone_in_another_gem_or_turned_with_its_cavity_does_not():
    inner, outer = ((0.2, 0.1, 0), 0.3), ((0, 0, 0), 1)
    assert turned(mesh((*outer, False), (*inner, True))) == [False, False]
    assert turned(mesh((*outer, True), (*inner, False))) == [True, True]
    assert turned(mesh((*outer, False), (*inner, True), gems=[0, 1])) == [False, True]
    assert turned(mesh((*outer, False), (*inner, True), gems=[NO_GEM, 1])) == [False, True]


def test_boxes_alone_do_not_say_what_lies_within():
    """A small stone in the notch of an L lies within its box and not within it."""
    corners = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)]
    positions = np.array([(x, y, z) for z in (0, 4) for x, y in corners], float)
    cap = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    sides = [t for i in range(6) for j in ((i + 1) % 6,) for t in ((i, j, j + 6), (i, j + 6, i + 6))]
    triangles = np.array([t[::-1] for t in cap] + [tuple(c + 6 for c in t) for t in cap] + sides)
    positions = np.concatenate([positions, np.add((2.5, 2.5, 2), 0.5 * CUBE)])
    bodies = described(positions, np.concatenate([triangles, 12 + FACES[:, ::-1]]), np.zeros(len(triangles) + 12, int))
    assert bodies.volume == pytest.approx([28.0, -1.0])
    assert turned(bodies) == [False, True]


def test_facets_that_are_split_close_the_surface_and_holes_are_counted():
    split = CUBE[FACES].reshape(-1, 3)
    bodies = described(split, np.arange(36).reshape(12, 3), np.zeros(12, int))
    assert bodies.volume == pytest.approx([8.0]) and bodies.open_edges.tolist() == [0]
    assert described(CUBE, FACES[:-2], np.zeros(10, int)).open_edges.tolist() == [4]
    assert described(CUBE, np.concatenate([FACES[:10], FACES[10:, ::-1]]), np.zeros(12, int)).mixed.tolist() == [True]


def test_a_long_strip_is_one_part_in_few_rounds():
    """A strip whose corners are numbered at random, and a thousand triangles apart."""
    order = np.random.default_rng(3).permutation(200_000)
    strip = order[np.arange(199_998)[:, None] + np.arange(3)]
    apart = 200_000 + np.arange(3000).reshape(-1, 3)
    labels = parts(np.concatenate([strip, apart]))
    assert len(np.unique(labels)) == 1001 and len(np.unique(labels[: len(strip)])) == 1
