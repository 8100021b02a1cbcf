# SPDX-License-Identifier: GPL-3.0-or-later
"""A wavefront traced through a drop that need not be round: the fifth theory, for flattened drops and twinned bows.

After Sadeghi et al., "Physically-Based Simulation of Rainbows", ACM TOG 31(1) (2012): a plane wave is a grid of rays over the shadow of a
drop of its real shape (`drop_shapes`), each with amplitudes in both polarisations and its path (`wavefront`). Where the wavefront folds
simply, at a clean caustic, its diffraction is that of the uniform approximation (`caustic_fold`), which that paper's blur by a table stands for.

A bow is looked at at one place, its clock angle; the rays that arrive there are found wherever on the drop they entered.
Higher orders are those of a sphere; of these the fifth, whose bow stands in the dark band, is a traced fold as well.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from opal_kernels.optics.rainbow import background, caustic_fold, drop_shapes, geometric, sun, wavefront
from opal_kernels.optics.rainbow.caustic_fold import Fold
from opal_kernels.optics.rainbow.drop_shapes import SPHERE, Surface

_ROWS, _COLUMNS, _COLUMNS_ROUND = 385, 12, 3
_SMEAR = 0.15  # rad
_INDEX_STEP = 0.005  # of the traces between which flattened drops are interpolated
_DIAMETER_DIGITS = 3
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

    def surface(self, radius_um: float) -> Surface:
        """Return the surface of a drop of this radius; sizes that differ by less than a micrometre share one."""
        return drop_shapes.falling(round(2e-3 * radius_um, _DIAMETER_DIGITS), self.flattening)


@lru_cache(maxsize=256)
def _harmonics(surface: Surface, n: float, sun_elevation: float, highest: int) -> dict[int, caustic_fold.Harmonics]:
    orders = background.BOWS if highest in background.BOWS else (highest,)
    columns = _COLUMNS_ROUND if surface == SPHERE else _COLUMNS
    waves = wavefront.trace(surface, n, sun_elevation, orders, _ROWS, columns)
    return {k: caustic_fold.Harmonics(wave) for k, wave in waves.items()}


def fold(n: float, k: int, surface: Surface, sun_elevation: float, clock: float) -> Fold | None:
    """Return the bow of one order at one place of the sky; None where there is no single clean caustic."""
    with _TRACING:  # wavelengths share folds: the first to want one makes it
        return _fold(n, k, surface, sun_elevation, clock)


@lru_cache(maxsize=1024)
def _fold(n: float, k: int, surface: Surface, sun_elevation: float, clock: float) -> Fold | None:
    if not 1 < n < k + 1:
        return None
    incidence = float(geometric.caustic_incidence(n, k))
    rays = caustic_fold.Meridian.of(_harmonics(surface, n, sun_elevation, k)[k], clock, incidence)
    return None if rays is None else caustic_fold.of_meridian(rays, n, k)


def fold_near(n: float, k: int, surface: Surface, sun_elevation: float, clock: float) -> Fold | None:
    """As `fold`, for flattened drops between traces of neighbouring indices, so that all wavelengths share four of them.

    The distance of the caustic from a sphere's is what is interpolated.
    """
    if surface == SPHERE or not 1 < n < k + 1:
        return fold(n, k, surface, sun_elevation, clock)
    step = int(np.floor(n / _INDEX_STEP))
    nodes = (step * _INDEX_STEP, (step + 1) * _INDEX_STEP)
    pair = [fold(node, k, surface, sun_elevation, clock) for node in nodes]
    if pair[0] is None or pair[1] is None or pair[0].side != pair[1].side:
        return fold(n, k, surface, sun_elevation, clock)
    t = n / _INDEX_STEP - step
    shifts = [one.angle - float(geometric.fold(geometric.caustic_deviation(node, k))) for one, node in zip(pair, nodes, strict=True)]
    angle = (1 - t) * shifts[0] + t * shifts[1] + float(geometric.fold(geometric.caustic_deviation(n, k)))
    return pair[0].mixed(pair[1], t, angle)


class Drop:
    """Drops of one index and several sizes, each with the shape that its size has."""

    def __init__(self, n: float, shape: Shape, nm: float) -> None:
        self._n, self._shape, self._nm = n, shape, nm
        self._densities = background.orders(n)

    def _bows(self, angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
        total = np.zeros((2, len(angles_rad)))
        for x, part in zip(sizes, share, strict=True):
            surface = self._shape.surface(x * self._nm / (2000 * np.pi))
            for k in background.BOWS:  # without a single caustic to that side a large flat drop smears its bow over the sky
                bow = fold_near(self._n, k, surface, self._shape.sun_elevation_rad, self._shape.clock_rad)
                total += part * (
                    background.at(angles_rad, sun.smooth(self._densities[k], _SMEAR)) if bow is None else bow.intensity(angles_rad, x)
                )
            quinary = fold(self._n, background.QUINARY, SPHERE, 0.0, 0.0)
            if quinary is not None:
                total += part * quinary.intensity(angles_rad, x)
        if quinary is None:
            total += background.at(angles_rad, self._densities[background.QUINARY])
        return total

    def scattered(self, angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
        """Return (2, n_angles), 1/sr per unit of light on the drops: bows and background, no diffraction lobe; integral 1.

        `sizes` are size parameters, `share` their part of the drops' cross-section (sum 1).
        """
        if self._shape.flattening > 0:  # one place of the bow does not say what all round it sums to: the rays of a sphere do
            bows = sum(self._densities[k] for k in background.WAVES)
        else:
            bows = self._bows(background.CENTRES, sizes, share)
        bows = bows + background.edge(background.CENTRES, sizes, share)
        rest = background.closed(self._densities, bows, background.WAVES)
        grazing = background.edge(angles_rad, sizes, share)
        return background.at(angles_rad, rest) + self._bows(np.asarray(angles_rad, float), sizes, share) + grazing
