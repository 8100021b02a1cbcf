# SPDX-License-Identifier: GPL-3.0-or-later
"""A plane wave traced through a drop: a grid of rays over its shadow, each with its path and its field.

After Sadeghi et al., "Physically-Based Simulation of Rainbows", ACM TOG 31(1) (2012), sections 3 and 4. The grid is polar about the
drop's centre: rows from the middle (0) to the edge of the shadow (1), columns round it. Rays enter where a row's direction from the
centre meets the surface, so that all hit and none is searched for. At every boundary the field, a vector in space for either of two incident
polarisations, is taken apart into its components in and across the plane of incidence and multiplied by Fresnel's complex amplitudes,
times the root of the beam's change of power per area (energy is what is followed; the spreading of the wavefront comes last).

The path is that of the phase far away: of the wave to the entry, inside, and back from the exit to the plane through the centre across the ray,
    path = s.x_in + n (lengths) - u.x_out,
in units of the drop's equal-volume radius. Its slope over the direction u is therefore -x_out. A focal line that neighbours cross takes a
quarter of a period (van de Hulst, Light Scattering by Small Particles, 1957, 12.22): `focal` counts them.

Orders k: -1 reflection outside, 0 transmission, 1 the primary (one reflection inside), 2 the secondary, and so on.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opal_kernels.optics import fresnel
from opal_kernels.optics.rainbow.drop_shapes import Surface

_NEWTON_STEPS = 14
_ACCURATE, _ARRIVED = 1e-13, 1e-9


@dataclass(frozen=True)
class Frame:
    """Directions that the sun's height gives: `sun`, the way the light goes, `up` across it in the vertical plane, `side` horizontal."""

    sun: np.ndarray
    up: np.ndarray
    side: np.ndarray

    @classmethod
    def of(cls, elevation_rad: float) -> Frame:
        c, s = np.cos(elevation_rad), np.sin(elevation_rad)
        return cls(np.array([c, 0.0, -s]), np.array([s, 0.0, c]), np.array([0.0, 1.0, 0.0]))


@dataclass(frozen=True)
class Wavefront:
    """One order's rays, (rows, columns); columns start half a step after the upper end of the shadow and go all round.

    `field` has (2 incident polarisations: along `up`, along `side`; 3, rows, columns); `area` is the shadow's per row (unit 1) and
    column (radian); `shadow` all of it; `met` tells which rays have met the surface each
    time, `plain` which of these were nowhere totally reflected, so that their fields are real.
    """

    order: int
    frame: Frame
    entry: np.ndarray
    direction: np.ndarray
    exit: np.ndarray
    path: np.ndarray
    field: np.ndarray
    focal: np.ndarray
    area: np.ndarray
    shadow: float
    met: np.ndarray
    plain: np.ndarray

    @property
    def rows(self) -> np.ndarray:
        """Place of the rows, 0 to 1."""
        return np.linspace(0, 1, self.path.shape[0])

    @property
    def columns(self) -> np.ndarray:
        """Place of the columns, radians from `up` to `side`."""
        count = self.path.shape[1]
        return (np.arange(count) + 0.5) * 2 * np.pi / count


def trace(
    surface: Surface, n: float, elevation_rad: float, orders: tuple[int, ...], rows: int, columns: int, focal_lines: bool = True
) -> dict[int, Wavefront]:
    """Trace a wavefront through a drop of index `n` under a sun of this height; `columns` of the half beside the vertical plane.

    Parameters
    ----------
    surface : Surface
    n : float
        Index of the drop relative to air.
    elevation_rad : float
    orders : tuple of int
        Which to return.
    rows, columns : int
        Rays along the shadow's radius, and round half of it; the other half is its mirror image.
    focal_lines : bool
        Count them; what folds alone asks for needs none.

    Returns
    -------
    dict from order to Wavefront
    """
    frame = Frame.of(elevation_rad)
    point, area, shadow = _entries(surface, frame, rows, columns)
    entry = point
    d = np.broadcast_to(frame.sun[:, None, None], point.shape)
    field = np.empty((2, *point.shape), complex)
    field[0], field[1] = frame.up[:, None, None], frame.side[:, None, None]
    path = (frame.sun[:, None, None] * point).sum(0)
    focal = np.zeros(path.shape, int)
    met = np.ones(path.shape, bool)
    plain = met
    found = {}

    def keep(k: int, u: np.ndarray, at: np.ndarray, amplitude: np.ndarray) -> None:
        beyond = focal + _focal_lines(at, u, np.full(path.shape, np.inf)) if focal_lines else focal
        found[k] = _mirrored(k, frame, entry, u, at, path - (u * at).sum(0), amplitude, beyond, area, shadow, met, plain)

    normal = _normal(surface, point)
    reflected, refracted, d_out, d_in = _boundary(d, normal, n, field)
    if -1 in orders:
        keep(-1, d_out, point, reflected)
    d, field = d_in, refracted
    for k in range(max(orders) + 1):
        start = point
        length, arrived = _across(surface, point, d)
        met = met & arrived
        if focal_lines:
            focal = focal + _focal_lines(start, d, length)
        point = start + length * d
        path = path + n * length
        normal = _normal(surface, point)
        d_reflected, leaving, inside, d_out, total = _inner(d, normal, n, field)
        plain = plain & met & ~total
        if k in orders:
            keep(k, d_out, point, leaving)
        d, field = d_reflected, inside
    return found


def _entries(surface: Surface, frame: Frame, rows: int, columns: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Return where rays enter (3, rows, columns), the shadow's area per row and radian there, and all of it."""
    angle = (np.arange(columns) + 0.5) * np.pi / columns
    outward = np.cos(angle) * frame.up[:, None] + np.sin(angle) * frame.side[:, None]
    # On the section through the centre towards (cos q outward - sin q sun) the surface stands r cos q off the axis, most where it ends the shadow.
    q = np.zeros(columns)
    for _ in range(80):
        r, slope = surface.radius(np.cos(q) * outward[2] - np.sin(q) * frame.sun[2])
        q = 0.5 * q + 0.5 * np.arctan(slope / r * (-np.sin(q) * outward[2] - np.cos(q) * frame.sun[2]))
    span = np.pi / 2 - q
    q = np.pi / 2 - np.linspace(0, 1, rows)[:, None] * span
    cos_q, sin_q = np.cos(q), np.sin(q)
    towards = cos_q * outward[:, None, :] - sin_q * frame.sun[:, None, None]
    r, slope = surface.radius(towards[2])
    rho = r * cos_q
    rate = -span * (slope * (-sin_q * outward[2] - cos_q * frame.sun[2]) * cos_q - r * sin_q)
    area = np.clip(rho * rate, 0, None)
    edge = np.r_[0.5, np.ones(rows - 2), 0.5] / (rows - 1)
    return r * towards, area, float(2 * (edge[:, None] * area).sum() * np.pi / columns)


def _normal(surface: Surface, point: np.ndarray) -> np.ndarray:
    """Outward unit normals: the gradient of |p| - r(z/|p|)."""
    distance = np.sqrt((point * point).sum(0))
    c = point[2] / distance
    slope = surface.radius(c)[1] / distance
    normal = point * ((1 + slope * c) / distance)
    normal[2] -= slope
    return normal / np.sqrt((normal * normal).sum(0))


def _across(surface: Surface, point: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how far it is through the drop, by Newton's steps from what a spheroid would have, and who arrived."""
    w = np.array([1.0, 1.0, surface.ratio**-2])[:, None, None]
    length = -2 * (w * point * d).sum(0) / (w * d * d).sum(0)
    along = (point * d).sum(0)
    start2 = (point * point).sum(0)
    for _ in range(_NEWTON_STEPS):
        distance = np.sqrt(np.maximum(start2 + length * (2 * along + length), 1e-12))
        c = (point[2] + length * d[2]) / distance
        r, slope = surface.radius(np.clip(c, -1, 1))
        outward = (along + length) / distance
        step = (distance - r) / np.maximum(outward - slope * (d[2] - c * outward) / distance, 0.05)
        length = np.clip(length - np.clip(step, -0.5, 0.5), 1e-6, 6)
        if np.abs(step).max() < _ACCURATE:
            break
    return length, np.abs(step) < _ARRIVED


def _frame_of_incidence(d: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Unit vectors across the plane of incidence; any across the ray where it meets the surface head on."""
    s = cross(d, normal)
    size = np.sqrt((s * s).sum(0))
    if (size < 1e-9).any():
        other = cross(d, np.array([0.36, 0.48, 0.8])[:, None, None])
        s = np.where(size < 1e-9, other, s)
        size = np.sqrt((s * s).sum(0))
    return s / size


def _turned(field: np.ndarray, s: np.ndarray, before: np.ndarray, after: np.ndarray, a_s: np.ndarray, a_p: np.ndarray) -> np.ndarray:
    """Components across (s) and in (d x s) the plane of incidence, multiplied and set up again about the new direction."""
    p_before, p_after = cross(before, s), cross(after, s)
    return ((field * s).sum(1) * a_s)[:, None] * s + ((field * p_before).sum(1) * a_p)[:, None] * p_after


def _boundary(d: np.ndarray, normal: np.ndarray, n: float, field: np.ndarray):
    """From outside: reflected and refracted field and both directions."""
    cos_i = np.clip(-(d * normal).sum(0), 0, 1)
    r_s, r_p = fresnel.amplitudes(cos_i, n)
    inward = d / n + normal * (cos_i / n - np.sqrt(1 - (1 - cos_i**2) / n**2))
    outward = d + 2 * normal * cos_i
    s = _frame_of_incidence(d, normal)
    t_s, t_p = (np.sqrt(np.clip(1 - np.abs(r) ** 2, 0, None)) for r in (r_s, r_p))
    return _turned(field, s, d, outward, r_s, r_p), _turned(field, s, d, inward, t_s, t_p), outward, inward


def _inner(d: np.ndarray, normal: np.ndarray, n: float, field: np.ndarray):
    """From inside: direction reflected, field leaving, field reflected, direction leaving, and what is totally reflected."""
    cos_i = np.clip((d * normal).sum(0), 0, 1)
    r_s, r_p = fresnel.amplitudes(cos_i, 1 / n)
    sin2_out = n * n * (1 - cos_i**2)
    back = d - 2 * normal * cos_i
    leaving = d * n + normal * (np.sqrt(np.clip(1 - sin2_out, 0, None)) - n * cos_i)
    leaving = leaving / np.sqrt((leaving * leaving).sum(0))
    s = _frame_of_incidence(d, normal)
    t_s, t_p = (np.sqrt(np.clip(1 - np.abs(r) ** 2, 0, None)) for r in (r_s, r_p))
    return back, _turned(field, s, d, leaving, t_s, t_p), _turned(field, s, d, back, r_s, r_p), leaving, sin2_out > 1 + 1e-9


def _focal_lines(point: np.ndarray, d: np.ndarray, length: np.ndarray) -> np.ndarray:
    """How often neighbouring rays cross on the way: zeros of the cross-section d.(dx_1 + l dd_1) x (dx_2 + l dd_2), a quadratic in l."""

    def along(f: np.ndarray) -> np.ndarray:
        return np.gradient(f, axis=1)

    def round_(f: np.ndarray) -> np.ndarray:
        mirror = np.array([1.0, -1.0, 1.0])[:, None, None]
        whole = np.concatenate([mirror * f[:, :, :1], f, mirror * f[:, :, -1:]], axis=2)
        return whole[:, :, 2:] - whole[:, :, :-2]

    x1, x2, d1, d2 = along(point), round_(point), along(d), round_(d)

    def det(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return (d * cross(a, b)).sum(0)

    c0, c1, c2 = det(x1, x2), det(x1, d2) + det(d1, x2), det(d1, d2)
    root = np.sqrt(np.clip(c1 * c1 - 4 * c0 * c2, 0, None))
    q = -0.5 * (c1 + np.copysign(root, c1))
    with np.errstate(divide="ignore", invalid="ignore"):
        zeros = np.array([q / c2, c0 / q])
    return (((zeros > 0) & (zeros < length)).sum(0) * (c1 * c1 > 4 * c0 * c2)).astype(int)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Vector products of vectors (3, ...)."""
    return np.stack(np.broadcast_arrays(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def _mirrored(k: int, frame: Frame, entry, u, at, path, field, focal, area, shadow: float, met, plain) -> Wavefront:
    """The whole circle from its half: y is the axis that turns round, and so does the field across it."""

    def whole(f: np.ndarray, sign) -> np.ndarray:
        return np.concatenate([f, (sign * f)[..., ::-1]], axis=-1)

    vector = np.array([1.0, -1.0, 1.0])[:, None, None]
    both = np.array([1.0, -1.0])[:, None, None, None] * vector
    return Wavefront(
        k,
        frame,
        whole(entry, vector),
        whole(u, vector),
        whole(at, vector),
        whole(path, 1),
        whole(field, both),
        whole(focal, 1),
        whole(area, 1),
        shadow,
        np.concatenate([met, met[:, ::-1]], axis=1),
        np.concatenate([plain, plain[:, ::-1]], axis=1),
    )
