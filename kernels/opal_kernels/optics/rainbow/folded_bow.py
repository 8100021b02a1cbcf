# SPDX-License-Identifier: GPL-3.0-or-later
"""One folded wavefront as smooth curves, and the light of many sizes of drops from a few of them.

A fold (`caustic_fold`) is described per unit of radius by functions of delta, the angle from its caustic into the bright side. They depend so
smoothly on a drop's index, its size's shape and the place of the sky that a fold between others is their mean (`Fold.combined`): what jumps
with a size, the fringes, comes in with the size parameter only when intensities are asked for. `sum_of_sizes` does this for any number of
sizes at once, so that no arc of a single one remains in a bow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opal_kernels.optics.rainbow import _bow_binding
from opal_kernels.optics.rainbow.airy_function import table_of_squares

DARK, DARK_POINTS = np.radians(6), 40
POINTS, SINGLE_POINTS = 499, 160
_SHORT = 0.3  # how much finer than even the first steps of the curves are
_SHADOW_UNITS = 7.0  # Airy units into the dark beyond which Ai^2 is under 1e-11
_LARGEST_SHADOW = np.radians(25)


def places() -> np.ndarray:
    """Square roots of delta over the last one's, (POINTS,): closer together near the caustic."""
    s = np.linspace(0, 1, POINTS + 1)[1:]
    return s * (_SHORT + (1 - _SHORT) * s)


@dataclass(frozen=True)
class Fold:
    """One bow of one drop.

    `angle` is the caustic's scattering angle, `side` +1 where the bright side has larger ones. `curves` (5, DARK_POINTS + POINTS) are |B1 + B2|^2 in
    both polarisations, |B1 - B2|^2/delta in both, with B = amplitude times delta^(1/4), summed over both incident polarisations (so
    that the mean of the two is what unpolarised light sees), and (3/4 path difference/delta^(3/2))^(2/3), the scale of zeta; their deltas are even steps from -DARK to
    0 and then `places()` squared times `last`. `single` (2, SINGLE_POINTS) is the intensity where one ray alone arrives, evenly over
    `alone`, two deltas.
    """

    angle: float
    side: float
    last: float
    curves: np.ndarray
    alone: tuple[float, float]
    single: np.ndarray

    def intensity(self, angles_rad: np.ndarray, x: float) -> np.ndarray:
        """Return (2, n_angles), d sigma/d Omega over the light on the drop, of one size parameter."""
        return sum_of_sizes([self], np.zeros(1), np.array([self.angle]), np.array([x], float), np.ones(1), angles_rad)

    @staticmethod
    def combined(folds: Sequence[Fold], weights: Sequence[float], angle: float) -> Fold:
        """Return the weighted mean (weights sum to 1) of folds of one side, its caustic at `angle`."""
        pairs = list(zip(weights, folds, strict=True))
        return Fold(
            angle,
            folds[0].side,
            max(sum(w * f.last for w, f in pairs), min(f.last for f in folds)),
            sum(w * f.curves for w, f in pairs),
            (sum(w * f.alone[0] for w, f in pairs), sum(w * f.alone[1] for w, f in pairs)),
            sum(w * f.single for w, f in pairs),
        )


def sum_of_sizes(
    folds: Sequence[Fold], place: np.ndarray, angle: np.ndarray, x: np.ndarray, share: np.ndarray, angles_rad: np.ndarray
) -> np.ndarray:
    """Return (2, n_angles): the intensities of drops of many sizes, each by its share.

    Parameters
    ----------
    folds : sequence of Fold
        Of some sizes, ascending; of one side.
    place : array (n_sizes,)
        Where each size lies among them: 1.25 is a quarter of the way from the second to the third.
    angle : array (n_sizes,)
        Caustics, radians.
    x, share : array (n_sizes,)
        Size parameters and weights.
    angles_rad : array (n_angles,)
    """
    curves = np.stack([f.curves for f in folds])
    shadow = np.minimum(_SHADOW_UNITS / (curves[:, 4].min() * np.asarray(x, float) ** (2 / 3)), _LARGEST_SHADOW)
    return _bow_binding.bow_sum(
        folds[0].side,
        (DARK_POINTS, POINTS, DARK, _SHORT),
        curves,
        np.array([(f.last, *f.alone) for f in folds]),
        np.stack([f.single for f in folds]),
        table_of_squares(),
        np.array([place, angle, x, share, shadow], float),
        angles_rad,
    )
