# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of the transport tests: boxes, spheres, and cameras that look along an axis."""

import math

import numpy as np
from opal_kernels.descriptions import CameraType
from opal_kernels.render import Render

IDENTITY = [np.eye(4)]


def placed(x=0.0, y=0.0, z=0.0):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def looking_down(height):
    """A camera or lamp at this height; its -Z is the world's."""
    return placed(z=height)[:3]


def looking_up(height):
    return (placed(z=height) @ np.diag([1.0, -1.0, -1.0, 1.0]))[:3]


def box(low, high):
    """Corners and outward triangles of a box."""
    corners = np.array([[(low, high)[i >> a & 1][a] for a in range(3)] for i in range(8)], float)
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def square(half, z=0.0):
    return [(-half, -half, z), (half, -half, z), (half, half, z), (-half, half, z)], [(0, 1, 2), (0, 2, 3)]


def sphere(radius, rings=32, segments=64):
    """Corners, outward triangles and smooth corner normals of a sphere about the origin."""
    polar = np.pi * np.arange(1, rings) / rings
    turn = 2 * np.pi * np.arange(segments) / segments
    p, a = np.meshgrid(polar, turn, indexing="ij")
    body = np.stack([np.sin(p) * np.cos(a), np.sin(p) * np.sin(a), np.cos(p)], -1).reshape(-1, 3)
    corners = np.vstack([body, [[0, 0, 1], [0, 0, -1]]])
    top, bottom = len(body), len(body) + 1
    faces = []
    for j in range(segments):
        k = (j + 1) % segments
        last = (rings - 2) * segments
        faces += [(top, j, k), (bottom, last + k, last + j)]
        for i in range(rings - 2):
            r, s = i * segments, (i + 1) * segments
            faces += [(r + j, s + j, s + k), (r + j, s + k, r + k)]
    return radius * corners, faces, corners[np.array(faces)]


def area(corners, faces):
    a, b, c = (np.asarray(corners)[np.array(faces)[:, i]] for i in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


def orthographic(half, transform):
    return {"type": CameraType.ORTHOGRAPHIC, "transform": transform, "window": (-half, half, -half, half)}


def perspective(angle, transform):
    h = math.tan(0.5 * angle)
    return {"transform": transform, "window": (-h, h, -h, h)}


def picture(scene, passes, size=16, **settings):
    """(size, size, 3) float64 of a committed scene."""
    with Render(scene, width=size, height=size, **settings) as render:
        return render.run(passes).film("COMBINED")[..., :3].astype(np.float64)
