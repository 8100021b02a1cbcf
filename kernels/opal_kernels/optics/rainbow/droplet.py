# SPDX-License-Identifier: GPL-3.0-or-later
"""A wavefront traced through a drop that need not be round: the fifth theory, for flattened drops and twinned bows.

After Sadeghi et al., "Physically-Based Simulation of Rainbows", ACM TOG 31(1) (2012): a plane wave is a grid of rays over the shadow of a
drop of its real shape (`drop_shapes`), each with complex amplitudes in both polarisations and its path (`wavefront`). What reaches one
place of the sky is found wherever on the drop it entered. Of the four families of rays,

- reflection outside (R) and transmission (TT) are the power of the patches between neighbouring rays (`patches`);
- the primary (TRT) and the secondary (TRRT) are, where the wavefront folds simply, the two rays' waves continued through the caustic
  by the uniform approximation (`caustic_fold`), which that paper's blur by a table stands for;
- and in large flat drops, where folds meet or the rays of one bow come from more than one place, the patches' waves, summed, with that blur.

Families add as power: fringes between them are finer than the sun's disc and differ from size to size. Higher orders are those of a
sphere; of these the fifth, whose bow stands in the dark band, is a traced fold as well. The light that passes through is scaled so
that what one place of the sky shows integrates to 1, as the tracer's tables want it.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from opal_kernels.optics.rainbow import Cancelled, background, caustic_fold, drop_shapes, geometric, patches, wavefront
from opal_kernels.optics.rainbow.drop_shapes import SPHERE, Surface
from opal_kernels.optics.rainbow.folded_bow import Fold, sum_of_sizes

_ROWS, _COLUMNS, _COLUMNS_ROUND = 193, 12, 3
_PATCH_ROWS, _PATCH_COLUMNS, _PATCH_INDEX_STEP = 257, 48, 0.01
_INDEX_STEP = 0.01  # of the traces between which flattened drops are interpolated: caustics to 0.01 degrees (0.005 for drops of 1 mm)
_FLATTEST = 0.93  # height over width under which the folds of a drop are not told apart
_SKY_ROWS, _SKY_COLUMNS = 257, 24
_SKY_INDEX_STEP, _SKY_DIAMETER_STEP = 0.02, 0.25  # mm; what is no bow changes slowly with both
_DIAMETER_STEP = 0.1  # mm, between the drops whose folds are traced; caustics between them are right to 0.01 degrees
_CLOCK_STEP = np.pi / 12  # between the places of the sky for which folds are made; cubic between them, to 0.003 degrees
_PATCH_RATIO = 1.1  # of the diameters whose patches are traced
_FEW = 3e-4  # share of the light under which drops of one such diameter are left out
_LARGEST_MM = drop_shapes.DIAMETERS_MM[-1]  # all larger drops have its shape
_TRACING = threading.Lock()


@dataclass(frozen=True)
class Shape:
    """How far from round, where the sun stands, and which place of the bow is looked at.

    flattening : 0 for spheres, 1 for the shape of a falling drop; between, and up to 2, in proportion.
    sun_elevation_rad : height of the sun, -0.1 to pi/2.
    clock_rad : 0 at the top of the bow, pi/2 at its feet.
    """

    flattening: float = 0.0
    sun_elevation_rad: float = 0.0
    clock_rad: float = 0.0

    def __post_init__(self) -> None:
        if not 0 <= self.flattening <= 2:
            raise ValueError(f"the flattening must lie between 0 and 2, not {self.flattening:g}")
        if not -0.1 <= self.sun_elevation_rad <= np.pi / 2:
            raise ValueError("the sun must stand between the horizon and the zenith")
        if not np.isfinite(self.clock_rad):
            raise ValueError("the place on the bow must be a finite angle")

    def surface(self, diameter_mm: float) -> Surface:
        """Return the surface of a drop of this equal-volume diameter."""
        return drop_shapes.falling(float(min(diameter_mm, _LARGEST_MM)), self.flattening)


@lru_cache(maxsize=96)
def _harmonics(surface: Surface, n: float, sun_elevation: float, orders: tuple[int, ...]) -> dict[int, caustic_fold.Harmonics]:
    columns = _COLUMNS_ROUND if surface == SPHERE else _COLUMNS
    waves = wavefront.trace(surface, n, sun_elevation, orders, _ROWS, columns, focal_lines=False)
    return {k: caustic_fold.Harmonics(wave) for k, wave in waves.items()}


def fold(n: float, k: int, surface: Surface, sun_elevation: float, clock: float) -> Fold | None:
    """Return the bow of one order at one place of the sky; None where there is no single clean caustic."""
    with _TRACING:  # wavelengths share folds: the first to want one makes it
        return _fold(n, k, surface, sun_elevation, clock)


@lru_cache(maxsize=2048)
def _fold(n: float, k: int, surface: Surface, sun_elevation: float, clock: float) -> Fold | None:
    if not 1 < n < k + 1 or surface.ratio < _FLATTEST:
        return None
    incidence = float(geometric.caustic_incidence(n, k))
    rays = caustic_fold.Meridian.of(
        _harmonics(surface, n, sun_elevation, background.BOWS if k in background.BOWS else (k,))[k], clock, incidence
    )
    return None if rays is None else caustic_fold.of_meridian(rays, n, k)


def _clock_nodes(clock: float) -> tuple[list[float], list[float]]:
    """Return four neighbouring places of the sky that others share, and the weights of the cubic through them."""
    t = abs((clock + np.pi) % (2 * np.pi) - np.pi) / _CLOCK_STEP
    first = int(np.floor(t)) - 1
    t -= first
    weights = [-(t - 1) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2, -t * (t - 1) * (t - 3) / 2, t * (t - 1) * (t - 2) / 6]
    # The sky is its own mirror image about the vertical plane, at the top and at the bottom.
    nodes = [abs((i * _CLOCK_STEP + np.pi) % (2 * np.pi) - np.pi) for i in range(first, first + 4)]
    return [round(node, 9) for node in nodes], weights


@lru_cache(maxsize=512)
def _fold_between_clocks(n: float, k: int, surface: Surface, sun_elevation: float, clock: float) -> Fold | None:
    """As `fold`, by a cubic through those of four neighbouring places of the sky, which other places share."""
    if surface == SPHERE:
        return _fold(n, k, SPHERE, 0.0, 0.0)
    nodes, weights = _clock_nodes(clock)
    folds = [_fold(n, k, surface, sun_elevation, node) for node in nodes]
    if any(f is None or f.side != folds[0].side for f in folds):
        return _fold(n, k, surface, sun_elevation, clock)
    return Fold.combined(folds, weights, sum(w * f.angle for w, f in zip(weights, folds, strict=True)))


def fold_near(n: float, k: int, surface: Surface, sun_elevation: float, clock: float) -> Fold | None:
    """As `fold`, for flattened drops between traces of neighbouring indices, so that all wavelengths share three of them.

    The distance of the caustic from a sphere's is what is interpolated.
    """
    if not 1 < n < k + 1:
        return None
    step = int(np.floor(n / _INDEX_STEP))
    nodes = (step * _INDEX_STEP, (step + 1) * _INDEX_STEP)
    with _TRACING:
        pair = [_fold_between_clocks(node, k, surface, sun_elevation, clock) for node in nodes]
    if pair[0] is None or pair[1] is None or pair[0].side != pair[1].side:
        return None
    t = n / _INDEX_STEP - step
    shifts = [one.angle - _sphere_caustic(node, k) for one, node in zip(pair, nodes, strict=True)]
    return Fold.combined(pair, (1 - t, t), (1 - t) * shifts[0] + t * shifts[1] + _sphere_caustic(n, k))


def _sphere_caustic(n: float, k: int) -> float:
    return float(geometric.fold(geometric.caustic_deviation(n, k)))


@lru_cache(maxsize=128)
def _patches(
    surface: Surface, n: float, sun_elevation: float, orders: tuple[int, ...], rows: int, columns: int
) -> dict[int, patches.Patches]:
    waves = wavefront.trace(surface, n, sun_elevation, orders, rows, columns)
    return {k: patches.Patches(wave) for k, wave in waves.items()}


@lru_cache(maxsize=96)
def _patched_bow(n: float, k: int, surface: Surface, sun_elevation: float, clock: float) -> patches.Bow:
    return patches.Bow(_patches(surface, n, sun_elevation, background.BOWS, _PATCH_ROWS, _PATCH_COLUMNS)[k], clock)


def patched_bows(n: float, k: int, surface: Surface, sun_elevation: float, clock: float) -> list[tuple[patches.Bow, float, float]]:
    """Return a bow as the sum of patches, from the traces of the two indices next to it, which wavelengths share: each with its weight and by
    how much its angles differ."""
    step = max(int(np.floor(n / _PATCH_INDEX_STEP)), round(1 / _PATCH_INDEX_STEP) + 1)
    t = max(n / _PATCH_INDEX_STEP - step, 0.0)
    found = []
    for i, weight in ((step, 1 - t), (step + 1, t)):
        node = i * _PATCH_INDEX_STEP
        shift = _sphere_caustic(n, k) - _sphere_caustic(node, k) if 1 < min(n, node) and max(n, node) < k + 1 else 0.0
        with _TRACING:
            found.append((_patched_bow(node, k, surface, sun_elevation, clock), weight, shift))
    return found


@lru_cache(maxsize=256)
def _sky_node(n: float, diameter_mm: float, flattening: float, sun_elevation: float, clock: float) -> np.ndarray:
    traced = _patches(drop_shapes.falling(diameter_mm, flattening), n, sun_elevation, (-1, 0), _SKY_ROWS, _SKY_COLUMNS)
    return np.array([traced[k].means(clock, background.EDGES) for k in (-1, 0)])


def _sky(n: float, shape: Shape, radii_um: np.ndarray, share: np.ndarray) -> dict[int, np.ndarray]:
    """Return what drops reflect outside and let through at one place of the sky, by order, (2, 3600) each."""
    diameters = np.minimum(2e-3 * radii_um, _LARGEST_MM) / _SKY_DIAMETER_STEP
    below = np.floor(diameters).astype(int)
    weights = np.bincount(below, share * (1 - diameters + below), below.max() + 2)
    weights += np.bincount(below + 1, share * (diameters - below), below.max() + 2)
    step = max(int(np.floor(n / _SKY_INDEX_STEP)), round(1 / _SKY_INDEX_STEP) + 1)
    t = max(n / _SKY_INDEX_STEP - step, 0.0)
    total = np.zeros((2, 2, background.CENTRES.size))
    with _TRACING:
        for i in np.flatnonzero(weights):
            for node, part in ((step, 1 - t), (step + 1, t)):
                place = (_SKY_DIAMETER_STEP * float(i), shape.flattening, shape.sun_elevation_rad)
                for clock, cubic in zip(*_clock_nodes(shape.clock_rad), strict=True):
                    total += weights[i] * part * cubic * _sky_node(node * _SKY_INDEX_STEP, *place, clock)
    return {-1: np.maximum(total[0], 0), 0: np.maximum(total[1], 0)}  # a cubic may pass a little below 0


def forget() -> None:
    """Let go of traced wavefronts, up to 200 MB of them, once a table is done."""
    with _TRACING:
        for cache in (_harmonics, _fold, _fold_between_clocks, _patches, _patched_bow, _sky_node):
            cache.cache_clear()


class Drop:
    """Drops of one index and several sizes, each with the shape that its size has."""

    def __init__(self, n: float, shape: Shape, nm: float, stopping: threading.Event | None = None) -> None:
        self._n, self._shape, self._nm = n, shape, nm
        self._stopping = stopping
        self._densities = background.orders(n)

    def _bows(self, angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
        total = np.zeros((2, len(angles_rad)))
        for k in background.BOWS:
            if not 1 < self._n < k + 1:
                total += background.at(angles_rad, self._densities[k])
            elif self._shape.flattening == 0:
                total += self._round(k, angles_rad, sizes, share)
            else:
                total += self._flat(k, angles_rad, sizes, share)
        if 1 < self._n < background.QUINARY + 1:
            return total + self._round(background.QUINARY, angles_rad, sizes, share)
        return total + background.at(angles_rad, self._densities[background.QUINARY])

    def _round(self, k: int, angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
        self._look()
        one = fold(self._n, k, SPHERE, 0.0, 0.0)
        if one is None:
            return background.at(angles_rad, self._densities[k])
        return sum_of_sizes([one], np.zeros(sizes.size), np.full(sizes.size, one.angle), sizes, share, angles_rad)

    def _flat(self, k: int, angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
        """One bow of drops that are not round: folds of a few diameters stand for all between them, patches where there are none."""
        total = np.zeros((2, len(angles_rad)))
        diameters = sizes * self._nm * 1e-6 / np.pi  # mm
        below = np.floor(diameters / _DIAMETER_STEP).astype(int)
        nodes = {}
        for i in np.union1d(below, below + 1).tolist():
            self._look()
            nodes[i] = fold_near(self._n, k, self._shape.surface(i * _DIAMETER_STEP), self._shape.sun_elevation_rad, self._shape.clock_rad)
        sides = {i: 0.0 if one is None else one.side for i, one in nodes.items()}
        for side in (-1.0, 1.0):
            known = np.array([sides[i] == sides[i + 1] == side for i in below.tolist()])
            if not known.any():
                continue
            kept = sorted({j for i in below[known].tolist() for j in (i, i + 1)})
            place = np.searchsorted(kept, below[known]) + diameters[known] / _DIAMETER_STEP - below[known]
            caustics = np.interp(place, np.arange(len(kept)), [nodes[i].angle for i in kept])
            total += sum_of_sizes([nodes[i] for i in kept], place, caustics, sizes[known], share[known], angles_rad)
        rest = np.array([not sides[i] == sides[i + 1] != 0 for i in below.tolist()])
        return total + self._summed(k, angles_rad, diameters[rest], share[rest]) if rest.any() else total

    def _summed(self, k: int, angles_rad: np.ndarray, diameters_mm: np.ndarray, share: np.ndarray) -> np.ndarray:
        """One bow from patches, of diameters `_PATCH_RATIO` apart that share what lies between them."""
        place = np.log(diameters_mm) / np.log(_PATCH_RATIO)
        below = np.floor(place).astype(int)
        weights: dict[int, float] = {}
        for i, t, part in zip(below.tolist(), (place - below).tolist(), share.tolist(), strict=True):
            weights[i], weights[i + 1] = weights.get(i, 0.0) + (1 - t) * part, weights.get(i + 1, 0.0) + t * part
        total = np.zeros((2, len(angles_rad)))
        for i, part in weights.items():
            self._look()
            if part < _FEW:
                continue
            diameter = _PATCH_RATIO**i
            place = (self._shape.surface(round(diameter, 6)), self._shape.sun_elevation_rad, self._shape.clock_rad)
            for summed, weight, shift in patched_bows(self._n, k, *place):
                total += part * weight * summed.intensity(angles_rad, np.pi * diameter / (self._nm * 1e-6), shift)
        return total

    def _look(self) -> None:
        """Whether nobody waits for the table any more."""
        if self._stopping is not None and self._stopping.is_set():
            raise Cancelled("the table was cancelled")

    def scattered(self, angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
        """Return (2, n_angles), 1/sr per unit of light on the drops: bows and background, no diffraction lobe; integral 1.

        `sizes` are size parameters, `share` their part of the drops' cross-section (sum 1).
        """
        densities = self._densities
        if self._shape.flattening > 0:
            densities = densities | _sky(self._n, self._shape, sizes * self._nm / (2000 * np.pi), share)
        angles = np.asarray(angles_rad, float)
        seen = self._bows(angles, sizes, share)
        if _all_round(angles):
            sine = np.sin(angles)  # as a rule of trapezoids over these angles counts it
            bows = np.array([np.interp(background.CENTRES, angles, row * sine) for row in seen]) / np.sin(background.CENTRES)
        else:
            bows = self._bows(background.CENTRES, sizes, share)
        bows = bows + background.edge(background.CENTRES, sizes, share)
        seen = seen + background.edge(angles, sizes, share)
        # A flat drop may turn more light to one place of the sky than a round one has: then all is scaled down.
        others = sum(density for k, density in densities.items() if k not in background.WAVES and k != 0)
        excess = np.maximum(((others + bows) * background.SOLID_ANGLES).sum(axis=1, keepdims=True), 1.0)
        densities = {k: density / excess for k, density in densities.items()}
        rest = background.closed(densities, bows / excess, background.WAVES)
        return background.at(angles, rest) + seen / excess


def _all_round(angles: np.ndarray) -> bool:
    """Whether what is seen at these angles says what all directions get: from 0 to pi in small steps, smallest where bows are."""
    steps = np.diff(angles)
    if not (angles.size > 2 and angles[0] == 0 and angles[-1] > np.pi - 1e-6 and (steps > 0).all()):
        return False
    return bool(steps.max() < np.radians(0.3) and steps[angles[1:] > np.radians(60.1)].max() < np.radians(0.06))
