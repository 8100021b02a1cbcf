# SPDX-License-Identifier: GPL-3.0-or-later
"""The tracer's camera: where its rays go, and that points connect back to where they came from."""

import ctypes
import math
from ctypes import c_int64

import numpy as np
import pytest
from light_probe import _call, _floats, _input, looking, numbers
from opal_kernels import camera
from opal_kernels.binding.structures import CameraStruct
from opal_kernels.descriptions import Camera, CameraType

PINHOLE = Camera(window=(-0.4, 0.4, -0.3, 0.3), clip_start=0.1, clip_end=100.0)
LENS = Camera(
    window=(-0.4, 0.4, -0.3, 0.3),
    clip_start=0.1,
    clip_end=100.0,
    aperture_radius=0.2,
    focus_distance=3.0,
)
BLADES = Camera(
    window=(-0.5, 0.3, -0.1, 0.5), clip_start=0.1, clip_end=100.0, aperture_radius=0.2, focus_distance=3.0, blades=5,
    blade_rotation=0.3, aperture_ratio=2.0, transform=looking((1, 2, -0.5), (3, 4, 5)),
)  # fmt: skip
ORTHO = Camera(type=CameraType.ORTHOGRAPHIC, window=(-4, 4, -3, 3), clip_start=0.1, clip_end=100.0)
ORTHO_LENS = Camera(
    type=CameraType.ORTHOGRAPHIC,
    window=(-4, 4, -3, 3),
    clip_start=0.1,
    clip_end=100.0,
    aperture_radius=0.5,
    focus_distance=3.0,
)
MOVING = Camera(
    window=(-0.4, 0.4, -0.3, 0.3), clip_start=0.1, clip_end=100.0, transform_start=looking((0, 1, 0), (0, 0, 0)),
    transform=looking((0.1, 1, 0.1), (0.4, 0, 0)), transform_end=looking((0.2, 1, 0.1), (1, 0, 0)),
)  # fmt: skip
ALL = {
    "pinhole": PINHOLE,
    "lens": LENS,
    "blades": BLADES,
    "ortho": ORTHO,
    "ortho lens": ORTHO_LENS,
    "moving": MOVING,
}


def struct_of(description):
    struct = CameraStruct()
    for name in (
        "type",
        "blades",
        "clip_start",
        "clip_end",
        "aperture_radius",
        "focus_distance",
        "blade_rotation",
        "aperture_ratio",
    ):
        setattr(struct, name, getattr(description, name))
    struct.window[:] = [float(x) for x in description.window]
    struct.transform[:] = np.asarray(description.transform, np.float32).reshape(-1)[:12].tolist()
    for name in ("transform_start", "transform_end"):
        end = getattr(description, name)
        end = description.transform if end is None else end
        getattr(struct, name)[:] = np.asarray(end, np.float32).reshape(-1)[:12].tolist()
    return struct


def rays(description, film, lens=(0.5, 0.5), time=0.0):
    film = _input(film, 2)
    n = len(film)
    lens = np.ascontiguousarray(np.broadcast_to(np.asarray(lens, np.float32), (n, 2)))
    time = np.ascontiguousarray(np.broadcast_to(np.asarray(time, np.float32), (n,)))
    origin, direction, span = (
        np.zeros((n, 3), np.float32),
        np.zeros((n, 3), np.float32),
        np.zeros((n, 2), np.float32),
    )
    struct = struct_of(description)
    _call(
        "opal_test_camera_rays", ctypes.byref(struct), c_int64(n), _floats(film), _floats(lens), _floats(time),
        _floats(origin), _floats(direction), _floats(span),
    )  # fmt: skip
    return origin, direction, span


def connect(description, points, lens=(0.5, 0.5), time=0.0):
    points = _input(points, 3)
    n = len(points)
    lens = np.ascontiguousarray(np.broadcast_to(np.asarray(lens, np.float32), (n, 2)))
    time = np.ascontiguousarray(np.broadcast_to(np.asarray(time, np.float32), (n,)))
    film, importance, distance = (
        np.zeros((n, 2), np.float32),
        np.zeros(n, np.float32),
        np.zeros(n, np.float32),
    )
    direction = np.zeros((n, 3), np.float32)
    struct = struct_of(description)
    _call(
        "opal_test_camera_connect", ctypes.byref(struct), c_int64(n), _floats(points), _floats(lens), _floats(time),
        _floats(film), _floats(importance), _floats(distance), _floats(direction),
    )  # fmt: skip
    return film, importance, distance, direction


def test_pinhole_rays_pass_through_the_window():
    origin, direction, span = rays(PINHOLE, [[0, 0], [1, 1], [0.5, 0.5], [0.75, 0.5]])
    assert np.abs(origin).max() == 0
    through = direction / -direction[:, 2:]
    assert through[:, :2] == pytest.approx(np.array([[-0.4, -0.3], [0.4, 0.3], [0, 0], [0.2, 0]]), abs=1e-6)
    # Clipping is by planes.
    assert -direction[:, 2] * span[:, 0] == pytest.approx(np.full(4, 0.1), rel=1e-5)
    assert -direction[:, 2] * span[:, 1] == pytest.approx(np.full(4, 100.0), rel=1e-5)


def test_orthographic_rays_are_parallel_and_start_at_the_near_plane():
    origin, direction, span = rays(ORTHO, [[0, 0], [1, 1], [0.5, 0.25]])
    assert direction == pytest.approx(np.tile([0, 0, -1], (3, 1)))
    assert origin == pytest.approx(np.array([[-4, -3, -0.1], [4, 3, -0.1], [0, -1.5, -0.1]]), abs=1e-5)
    assert span == pytest.approx(np.tile([0, 99.9], (3, 1)), rel=1e-5)


@pytest.mark.parametrize("description", [LENS, ORTHO_LENS, BLADES])
def test_every_point_of_the_lens_sees_the_same_point_of_the_plane_in_focus(description):
    film = np.tile([0.8, 0.3], (200, 1))
    origin, direction, _ = rays(description, film, numbers(200, 2))
    axis = -np.asarray(description.transform, float).reshape(-1, 4)[:3, 2]
    position = np.asarray(description.transform, float).reshape(-1, 4)[:3, 3]
    depth = (origin - position) @ axis
    at = origin + direction * ((description.focus_distance - depth) / (direction @ axis))[:, None]
    assert np.ptp(at, axis=0).max() < 2e-5
    assert np.ptp(origin, axis=0).max() > 0.05


def test_aperture_is_a_regular_polygon_filled_evenly():
    u = numbers(20_000, 2)
    pentagon = Camera(aperture_radius=1.0, focus_distance=1e6, blades=5)
    p = rays(pentagon, np.full((20_000, 2), 0.5), u)[0][:, :2]
    radius = np.linalg.norm(p, axis=1)
    inner = np.cos(np.pi / 5)
    assert radius.max() <= 1 + 1e-5
    # Second moment of a regular n-gon of circumradius 1: (2 + cos(2 pi / n)) / 6.
    assert np.mean(radius**2) == pytest.approx((2 + np.cos(2 * np.pi / 5)) / 6, rel=2e-3)
    assert np.mean(radius < 0.5 * inner) == pytest.approx(np.pi * (0.5 * inner) ** 2 / (2.5 * np.sin(2 * np.pi / 5)), rel=2e-2)
    assert np.abs(p.mean(axis=0)).max() < 5e-3


def test_round_aperture_and_its_ratio():
    u = numbers(20_000, 2)
    squeezed = Camera(aperture_radius=1.0, focus_distance=1e6, aperture_ratio=2.0)
    p = rays(squeezed, np.full((20_000, 2), 0.5), u)[0]
    assert np.mean(p[:, 0] ** 2) == pytest.approx(0.25 / 4, rel=5e-3)
    assert np.mean(p[:, 1] ** 2) == pytest.approx(0.25, rel=5e-3)


@pytest.mark.parametrize("name", ALL)
def test_a_point_on_a_ray_connects_to_the_film_where_the_ray_began(name):
    u = numbers(500, 6)
    film, lens, time = u[:, :2], u[:, 2:4], u[:, 4]
    origin, direction, span = rays(ALL[name], film, lens, time)
    t = span[:, 0] + 0.5 + 10 * u[:, 5]
    seen, importance, distance, back = connect(ALL[name], origin + direction * t[:, None], lens, time)
    assert seen == pytest.approx(film, abs=2e-4)
    assert (importance > 0).all()
    assert back == pytest.approx(-direction, abs=1e-4)
    assert distance == pytest.approx(t - span[:, 0], abs=2e-3)  # to the near plane


@pytest.mark.parametrize("name", ALL)
def test_importance_is_the_share_of_the_frame_that_a_surface_fills(name):
    """A square that faces the axis, of unit radiance: Σ flux x f x importance over its points (f |cos| dA = |cos| dA of
    radiance 1) is the fraction of the film that it covers; rays count it, connections must give the same."""
    description = ALL[name]
    transform = np.asarray(description.transform, float).reshape(-1, 4)[:3]
    half, depth = 0.4, 4.0
    u = numbers(200_000, 5)
    film, lens, time = u[:, :2], u[:, 2:4], u[:, 4]

    def plane(points):
        q = (points - transform[:, 3]) @ transform[:, :3]
        return q[:, 0], q[:, 1], -q[:, 2]

    origin, direction, _ = rays(description, film, lens, time)
    x0, y0, z0 = plane(origin)
    dx, dy, dz = (c for c in plane(direction + transform[:, 3]))
    t = (depth - z0) / dz
    covered = np.mean((np.abs(x0 + dx * t - 0.2) < half) & (np.abs(y0 + dy * t) < half))

    across = np.column_stack(
        [
            (2 * u[:, 0] - 1) * half + 0.2,
            (2 * u[:, 1] - 1) * half,
            np.full(len(u), -depth),
        ]
    )
    points = across @ transform[:, :3].T + transform[:, 3]
    _, importance, _, back = connect(description, points, lens, time)
    cosine = np.abs(back @ transform[:, 2])
    share = np.mean(importance * cosine) * (2 * half) ** 2
    assert covered > 0.005
    assert share == pytest.approx(covered, rel=0.01)


@pytest.mark.parametrize("point", [(0, 0, 1), (0, 0, -0.05), (0, 0, -200), (5, 0, -1), (np.nan, 0, -1)])
@pytest.mark.parametrize("description", [PINHOLE, LENS, ORTHO])
def test_points_behind_clipped_or_outside_are_not_seen(point, description):
    assert connect(description, [np.multiply(point, (10, 1, 1))])[1][0] == 0


def test_moving_camera_goes_from_place_to_place_and_keeps_its_shape():
    origin, direction, _ = rays(MOVING, np.full((5, 2), 0.5), time=[0, 0.25, 0.5, 0.75, 1])
    assert origin == pytest.approx(np.array([[0, 0, 0], [0.2, 0, 0], [0.4, 0, 0], [0.7, 0, 0], [1, 0, 0]]), abs=1e-6)
    keys = np.array([[0, 1, 0], [0.1, 1, 0.1] / np.linalg.norm([0.1, 1, 0.1]), [0.2, 1, 0.1] / np.linalg.norm([0.2, 1, 0.1])])
    assert direction[[0, 2, 4]] == pytest.approx(keys, abs=1e-6)
    _, corner, _ = rays(MOVING, [[0, 0], [1, 0]], time=[0.25, 0.25])
    assert np.dot(corner[0], corner[1]) == pytest.approx((1 - 0.16 + 0.09) / (1 + 0.16 + 0.09), abs=1e-5)


def test_turning_camera_turns_evenly():
    """By 150° about a slanted axis from opening to middle, which it does in halves; and no further in what is left."""
    axis = np.array([0.3, 0.9, 0.1]) / np.linalg.norm([0.3, 0.9, 0.1])
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    turn = lambda angle: np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k  # noqa: E731  (Rodrigues)
    placed = lambda angle: np.column_stack([turn(angle), [0, 0, 0]])  # noqa: E731
    angle = math.radians(150)
    camera = Camera(window=PINHOLE.window, transform_start=placed(0), transform=placed(angle), transform_end=placed(angle))
    film = [[0.5, 0.5], [0.1, 0.2], [0.9, 0.6]]
    before = rays(camera, film)[1]
    for time, part in ((0.125, 0.25), (0.25, 0.5), (0.5, 1.0), (0.8, 1.0)):
        assert rays(camera, film, time=time)[1] == pytest.approx(before @ turn(part * angle).T, abs=2e-6)


# ---- The arithmetic of lenses ----


def test_window_of_a_lens_spans_its_sensor_over_the_longer_side():
    assert camera.window(1920, 1080, lens=50, sensor_width=36) == pytest.approx((-0.36, 0.36, -0.2025, 0.2025))
    assert camera.window(1080, 1920, lens=50, sensor_width=36) == pytest.approx((-0.2025, 0.2025, -0.36, 0.36))
    vertical = camera.window(1920, 1080, lens=50, sensor_width=36, sensor_height=24, sensor_fit="VERTICAL")
    assert vertical == pytest.approx((-0.24 * 16 / 9, 0.24 * 16 / 9, -0.24, 0.24))
    horizontal = camera.window(1080, 1920, lens=50, sensor_width=36, sensor_fit="HORIZONTAL")
    assert horizontal == pytest.approx((-0.36, 0.36, -0.64, 0.64))


def test_shift_moves_the_window_by_fractions_of_the_fitted_side():
    assert camera.window(200, 100, lens=36, sensor_width=36, shift=(0.1, -0.2)) == pytest.approx((-0.4, 0.6, -0.45, 0.05))


def test_orthographic_scale_is_the_longer_side():
    assert camera.window(200, 100, ortho_scale=6.0) == pytest.approx((-3, 3, -1.5, 1.5))
    assert camera.window(100, 200, ortho_scale=6.0, shift=(0.5, 0)) == pytest.approx((1.5, 4.5, -3, 3))


def test_wide_pixels_widen_the_frame():
    wide = camera.window(100, 100, pixel_aspect=(2.0, 1.0), lens=36, sensor_width=36)
    assert wide == pytest.approx((-0.5, 0.5, -0.25, 0.25))


@pytest.mark.parametrize("bad", [{"lens": 0.0}, {"ortho_scale": 0.0}, {"ortho_scale": float("nan")}])
def test_an_empty_field_of_view_is_refused(bad):
    with pytest.raises(ValueError, match="field of view"):
        camera.window(100, 100, **bad)


def test_scale_of_a_camera_object_is_ignored():
    turned = looking((1, 2, 3), (4, 5, 6))
    assert camera.rigid(turned * np.array([2, 3, 0.5, 1])) == pytest.approx(turned)
    assert camera.rigid(np.zeros((4, 4)))[:, :3] == pytest.approx(np.eye(3))


def test_aperture_of_a_lens_is_half_its_focal_length_over_the_f_number():
    assert camera.aperture_radius(2.8, 50.0) == pytest.approx(0.05 / 5.6)
    assert camera.aperture_radius(0.5) == 1.0


def test_focus_on_a_point_is_measured_along_the_axis():
    assert camera.depth_along_axis(looking((1, 0, 0), (1, 1, 1)), (5, 9, -3)) == pytest.approx(4.0)


@pytest.mark.parametrize(
    ("border", "expected"),
    [
        ((0.25, 0.75, 0.5, 1.0), (25, 40, 75, 80)),
        ((-1, 2, -1, 2), (0, 0, 100, 80)),
        ((0.5, 0.5, 1, 1), (50, 79, 51, 80)),
    ],
)
def test_border_in_pixels_stays_in_the_frame_and_is_never_empty(border, expected):
    assert camera.border_region(100, 80, border) == expected
