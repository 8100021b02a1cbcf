# SPDX-License-Identifier: GPL-3.0-or-later
"""A wavefront on the collecting sphere: patches between neighbouring rays, and the sum of the waves that reach a direction.

After Sadeghi et al., "Physically-Based Simulation of Rainbows", ACM TOG 31(1) (2012), section 4.1. Four neighbouring rays span a quad far away;
it is halved into triangles, so that one that the wavefront's fold runs through is not averaged over both its sides. The light that fell
on a patch's part of the shadow leaves into its solid angle: the amplitude is the root of their quotient. Field and path are interpolated apart,
the path to third order, as its slope over the direction is known (the ray's lever arm, see `wavefront`). Each focal line passed takes a quarter
period. All patches that hold a direction add as waves, for each polarisation that comes in; the two add as intensities.

At a caustic rays have no wave. There the intensity is blurred by a Gaussian of 0.75 Airy units for the primary and twice that for the secondary,
which is what that paper's table II (0.70 degrees at 0.1 mm to 0.15 at 1 mm radius) says of 550 nm, with the unit's x^(-2/3) for other wavelengths.
Fringes narrower than the steps between directions are left out and not drawn at random (`_RESOLVED`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from opal_kernels.optics.rainbow.wavefront import Wavefront, cross

STEP = np.radians(0.05)
_ANGLES = np.linspace(0, np.pi, 3601)
_EDGES = np.concatenate([[0.0], _ANGLES[1:] - STEP / 2, [np.pi]])
_AIRY_UNIT, _AIRY_SIZE = np.radians(0.888), 1142.4  # of the primary at 0.1 mm radius, 550 nm
_BLUR = {1: 0.75, 2: 1.5}  # Airy units of the primary
_NEAR, _FAR = 1.0, 2.5  # sigmas from the caustic between which the blur gives way to the waves themselves
_RESOLVED = 0.5 * STEP


@lru_cache(maxsize=8)
def _triangles(rows: int, columns: int) -> np.ndarray:
    """Rays (3, n) at the corners of a grid's halved quads; columns close round."""
    ray = np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
    a, b = ray[:-1], ray[1:]
    right_a, right_b = np.roll(a, -1, axis=1), np.roll(b, -1, axis=1)
    return np.concatenate([np.stack(three).reshape(3, -1) for three in ((a, b, right_b), (a, right_b, right_a))], axis=1)


class Patches:
    """Triangles of one order; `power` is each one's share of the light on the drop, mean over what comes in.

    Rays are kept in single precision but for their paths, so that many drops fit into memory.
    """

    def __init__(self, wave: Wavefront) -> None:
        self.order, self.frame = wave.order, wave.frame
        self.corners = _triangles(*wave.path.shape)
        direction, entry = wave.direction.reshape(3, -1), wave.entry.reshape(3, -1)
        p, q, r = (entry[:, corner] for corner in self.corners)
        area = 0.5 * np.abs(_dot(wave.frame.sun[:, None], cross(q - p, r - p)))
        u, v, w = (direction[:, corner] for corner in self.corners)
        triple = np.abs(_dot(u, cross(v, w)))
        solid = 2 * np.arctan2(triple, 1 + _dot(u, v) + _dot(v, w) + _dot(w, u))
        self._density = (area / area.sum() / np.maximum(solid, 1e-14)).astype(np.float32)
        intensity = (np.abs(wave.field) ** 2).sum((0, 1)).reshape(-1) / 2
        self.power = (area / area.sum() * intensity[self.corners].mean(axis=0)).astype(np.float32)
        self._direction, self._exit = direction.astype(np.float32), wave.exit.reshape(3, -1).astype(np.float32)
        self._field = wave.field.reshape(6, -1).astype(np.complex64)
        self._path, self._focal = wave.path.reshape(-1), wave.focal.reshape(-1).astype(np.int8)

    def centres(self) -> np.ndarray:
        """Scattering angle of each patch's middle, radians."""
        middle = self._direction[:, self.corners].mean(axis=1)
        along = _dot(self.frame.sun[:, None], middle)
        return np.arctan2(np.sqrt(np.maximum(_dot(middle, middle) - along**2, 0)), along)

    def hits(self, clock_rad: float, angles_rad: np.ndarray) -> Hits:
        """Find every patch that holds a direction: scattering angles, ascending, of one clock angle."""
        place, across = self._place(clock_rad)
        cut, corners, low, high = self._cut(place, across)
        start, stop = (np.searchsorted(angles_rad, end, "left") for end in (low, high))
        count = stop - start
        which = np.repeat(np.arange(cut.size), count)
        target = np.arange(which.size) - np.repeat(np.cumsum(count) - count, count) + np.repeat(start, count)
        return self._at(target, np.asarray(angles_rad)[target], corners[:, which], self._density[cut[which]], place, across)

    def means(self, clock_rad: float, edges_rad: np.ndarray) -> np.ndarray:
        """Return (2, n_bins): the intensity of rays along one clock angle, mean over each bin of scattering angles; no crowded patch is missed."""
        place, across = self._place(clock_rad)
        cut, corners, low, high = self._cut(place, across)
        field = self._field.reshape(2, 3, -1)[..., corners].mean(axis=-2)
        middle = 0.5 * (low + high)
        plane = cross(across, np.cos(middle) * self.frame.sun[:, None] - np.sin(middle) * place[:, None])
        parts = np.array([(np.abs((field * axis).sum(axis=1)) ** 2).sum(axis=0) for axis in (across[:, None], plane)])
        parts = parts * self._density[cut]
        # Light up to an angle is a sum of ramps, one a patch; its differences are the bins'.
        result = np.zeros((2, edges_rad.size - 1))
        first, last = (np.clip(np.searchsorted(edges_rad, end, "right") - 1, 0, edges_rad.size - 2) for end in (low, high))
        for step in range(int((last - first).max(initial=0)) + 1):
            bins = first + step
            within = np.flatnonzero(bins <= last)
            bins = bins[within]
            overlap = np.clip(np.minimum(high[within], edges_rad[bins + 1]) - np.maximum(low[within], edges_rad[bins]), 0, None)
            for row, part in zip(result, parts, strict=True):
                row += np.bincount(bins, part[within] * overlap, row.size)
        return result / np.diff(edges_rad)

    def _place(self, clock_rad: float) -> tuple[np.ndarray, np.ndarray]:
        place = np.cos(clock_rad) * self.frame.up + np.sin(clock_rad) * self.frame.side
        return place, np.cross(self.frame.sun, place)

    def _cut(self, place: np.ndarray, across: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return which patches one clock angle cuts, their corners, and the scattering angles where it enters and leaves them."""
        side = _dot(across, self._direction)[self.corners]
        cut = np.flatnonzero((side.min(axis=0) < 0) & (side.max(axis=0) > 0))
        corners, side = self.corners[:, cut], side[:, cut].astype(float)
        # The corner alone on its side of the half plane; the two edges from it are crossed.
        lone = np.argmax(np.sign(side) == -np.sign(np.sign(side).sum(axis=0)), axis=0)
        order = (lone + np.arange(3)[:, None]) % 3
        turned, side = np.take_along_axis(corners, order, 0), np.take_along_axis(side, order, 0)
        first = self._direction[:, turned[0]]
        ends = []
        for other in (1, 2):
            crossing = first * side[other] - self._direction[:, turned[other]] * side[0]
            crossing = crossing * np.sign(side[other] - side[0])
            ends.append(np.arctan2(-_dot(place, crossing), _dot(self.frame.sun, crossing)))
        ends = np.array(ends)
        ends += 2 * np.pi * ((np.abs(ends[0] - ends[1]) > np.pi) & (ends < 0))  # about the point opposite the sun
        return cut, corners, ends.min(axis=0), ends.max(axis=0)

    def _at(self, target, theta, corners, density, place: np.ndarray, across: np.ndarray) -> Hits:
        sun = self.frame.sun
        w = np.cos(theta) * sun[:, None] - np.sin(theta) * place[:, None]
        u = self._direction[:, corners].astype(float)
        share = np.array([_dot(w, cross(u[:, (i + 1) % 3], u[:, (i + 2) % 3])) for i in range(3)])
        total = share.sum(axis=0)
        share = share / np.where(np.abs(total) < 1e-30, 1e-30, total)
        exit_, path = self._exit[:, corners].astype(float), self._path[corners]
        arm = (share * exit_).sum(axis=1)
        path = (share * (path - 0.5 * ((exit_ + arm[:, None]) * (w[:, None] - u)).sum(axis=0))).sum(axis=0)
        field = (share * self._field[:, corners]).sum(axis=1).reshape(2, 3, -1)
        quarter = np.rint(self._focal[corners].mean(axis=0))
        plane = cross(across, w)
        amplitude = np.array([(field * across[:, None]).sum(1), (field * plane).sum(1)]) * np.sqrt(density) * (-1j) ** quarter
        lever = -_dot(arm, -np.sin(theta) * sun[:, None] - np.cos(theta) * place[:, None])
        return Hits(target, amplitude, path, lever)


@dataclass(frozen=True)
class Hits:
    """Waves that reach directions: which one (h,), amplitude (2 out: across the plane of scattering, in it; 2 in; h), path, its slope."""

    target: np.ndarray
    amplitude: np.ndarray
    path: np.ndarray
    lever: np.ndarray

    def rays(self, count: int) -> np.ndarray:
        """Return (2, count): intensities of rays that add as power, 1/sr per unit of light on the drop."""
        power = (np.abs(self.amplitude) ** 2).sum(axis=1)
        return np.array([np.bincount(self.target, row, count) for row in power])

    def field(self, x: float, count: int) -> np.ndarray:
        """Return (2 out, 2 in, count): the waves' complex sum at size parameter x."""
        waves = self.amplitude * np.exp(1j * x * self.path)
        sums = [np.bincount(self.target, row.real, count) + 1j * np.bincount(self.target, row.imag, count) for row in waves.reshape(4, -1)]
        return np.array(sums).reshape(2, 2, count)

    def sheets(self, count: int) -> np.ndarray:
        """How many waves reach each direction."""
        return np.bincount(self.target, minlength=count)

    def width(self, count: int) -> np.ndarray:
        """Standard deviation of the waves' lever arms in each direction: x times twice this turns two waves' phase over an angle."""
        weight = (np.abs(self.amplitude) ** 2).sum(axis=(0, 1))
        total = np.maximum(np.bincount(self.target, weight, count), 1e-300)
        mean = np.bincount(self.target, weight * self.lever, count) / total
        return np.sqrt(np.bincount(self.target, weight * (self.lever - mean[self.target]) ** 2, count) / total)


def together(*hits: Hits) -> Hits:
    """Return several orders' waves as one."""
    return Hits(
        np.concatenate([h.target for h in hits]),
        np.concatenate([h.amplitude for h in hits], axis=-1),
        np.concatenate([h.path for h in hits]),
        np.concatenate([h.lever for h in hits]),
    )


class Bow:
    """A bow whose caustic is no single fold, at one place of the sky: its waves, summed, and blurred where rays crowd."""

    def __init__(self, patches: Patches, clock_rad: float) -> None:
        self._order = patches.order
        self._hits = patches.hits(clock_rad, _ANGLES)
        count = _ANGLES.size
        self._means, self._rays, self._width = patches.means(clock_rad, _EDGES), self._hits.rays(count), self._hits.width(count)
        sheets = self._hits.sheets(count)
        edges = np.flatnonzero(np.abs(np.diff(sheets)) >= 2)  # two rays more or less: a fold
        self._distance = np.full(count, np.pi)
        if edges.size:
            middle = _ANGLES[edges] + 0.5 * STEP
            after = np.clip(np.searchsorted(middle, _ANGLES), 0, middle.size - 1)
            self._distance = np.minimum(np.abs(_ANGLES - middle[after]), np.abs(_ANGLES - middle[np.maximum(after - 1, 0)]))

    def intensity(self, angles_rad: np.ndarray, x: float, shift: float = 0.0) -> np.ndarray:
        """Return (2, n_angles), d sigma/d Omega over the light on the drop, the whole bow `shift` towards larger angles."""
        waves = (np.abs(self._hits.field(x, _ANGLES.size)) ** 2).sum(axis=1)
        fringes = (waves - self._rays) * np.exp(-2 * (x * _RESOLVED * self._width) ** 2)
        sigma = blur(self._order, x)
        t = np.clip((self._distance / sigma - _NEAR) / (_FAR - _NEAR), 0, 1)
        sharp = t * t * (3 - 2 * t)
        waves = np.maximum(sharp * (self._means + fringes), 0) + _blurred((1 - sharp) * self._means, sigma)
        at = np.asarray(angles_rad, float) - shift
        return np.array([np.interp(at, _ANGLES, row) for row in waves])


def blur(order: int, x: float) -> float:
    """Return the standard deviation (radians) of the blur at a bow's caustic, order 1 or 2, size parameter x."""
    return _BLUR[order] * _AIRY_UNIT * (x / _AIRY_SIZE) ** (-2 / 3)


def _blurred(values: np.ndarray, sigma: float) -> np.ndarray:
    """Rows over `_ANGLES` under a Gaussian of the scattering angle; light (sin theta a unit) is kept."""
    reach = int(np.ceil(4 * sigma / STEP))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) * STEP / sigma) ** 2)
    kernel /= kernel.sum()
    weight = np.maximum(np.sin(_ANGLES), 0.5 * STEP)
    return np.array([np.convolve(row * weight, kernel, "same") for row in values]) / np.maximum(np.convolve(weight, kernel, "same"), 1e-9)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
