# SPDX-License-Identifier: GPL-3.0-or-later
"""What a drop does besides its two bows: reflection outside, light passed through, higher orders, and the diffraction lobe.

The fifth order's bow stands at 51 degrees, beside the secondary, and shines into the dark band, where it is half as bright as the
reflection outside. Rays pile its light up at its edge; theories with waves therefore treat it as they treat the two bows (`WAVES`).

The ray theories and Airy's add this to their bows, so that the dark band and the sky stand right beside them. Densities are per
unit of light on the drop (integral 1 over all orders for each polarisation), tabulated on `EDGES` and linear between centres.

Rays alone leave the dark band too dark, by a fifth at 100 um radius. What is missing falls as x^(-2/3) (measured from 70 to 400 um
radius), the law of waves that graze a drop: they enter at the critical angle, run on inside by nearly total reflections and leave on all
sides (Nussenzveig, Diffraction Effects in Semiclassical Scattering, 1992, chapter 14). `edge` adds them, evenly over the angle, in
an amount taken from Lorenz-Mie theory at 150 and 400 um; it is right on the mean and not in its detail, as its sources say.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from opal_kernels.optics.rainbow import geometric

BOWS = (1, 2)
QUINARY = 5
WAVES = (*BOWS, QUINARY)
HIGHEST_ORDER = 7
EDGES = np.linspace(0, np.pi, 3601)  # 0.05 degrees
CENTRES = (EDGES[1:] + EDGES[:-1]) / 2
SOLID_ANGLES = 2 * np.pi * (np.cos(EDGES[:-1]) - np.cos(EDGES[1:]))
_EDGE, _EDGE_FROM, _EDGE_TO = 0.25, np.radians(60), np.radians(141)  # a share of Q_ext's 2 x^(-2/3)
_RAYS = {-1: 2000, 0: 2000, 1: 8000, 2: 8000}


def order_density(n: float, k: int) -> np.ndarray:
    """Return the density (2, 3600) of one order at `CENTRES`, 1/sr per unit of light on the drop."""
    return geometric.energy(n, k, EDGES, _RAYS.get(k, 3000)) / SOLID_ANGLES


@lru_cache(maxsize=64)
def orders(n: float) -> dict[int, np.ndarray]:
    """Return `order_density` of every order from -1 to `HIGHEST_ORDER`; shared, not to be written to."""
    return {k: order_density(n, k) for k in range(-1, HIGHEST_ORDER + 1)}


def closed(densities: dict[int, np.ndarray], bows: np.ndarray, orders: tuple[int, ...] = BOWS) -> np.ndarray:
    """Return the sum of everything but the bows, with the light that passes through scaled so that all integrates to 1.

    Parameters
    ----------
    densities : dict
        As `orders` returns.
    bows : array (2, 3600)
        What stands for `orders`, same units.
    orders : tuple of int
        Orders that `bows` stands for.

    Returns
    -------
    array (2, 3600)
        Background and bows together integrate to 1 for each polarisation. The correction is a few per cent of the forward light.
    """
    rest = sum(density for k, density in densities.items() if k not in orders and k != 0)
    missing = 1 - ((rest + bows) * SOLID_ANGLES).sum(axis=1, keepdims=True)
    through = densities[0]
    return rest + through * np.clip(missing / (through * SOLID_ANGLES).sum(axis=1, keepdims=True), 0, None)


def at(angles_rad: np.ndarray, density: np.ndarray) -> np.ndarray:
    """Return a density at scattering angles, (2, n)."""
    return np.array([np.interp(angles_rad, CENTRES, row) for row in density])


def edge(angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Return what waves that graze the drops add, (n,), the same in both polarisations, units as the orders.

    From the sides to the primary's edge; in the bright sky inside it they are lost among the rays.
    """
    angles = np.asarray(angles_rad, float)
    amount = _EDGE * float((share * sizes ** (-2 / 3)).sum())
    ramp = np.clip((angles - _EDGE_FROM) / np.radians(10), 0, 1) * np.clip((_EDGE_TO - angles) / np.radians(5), 0, 1)
    return amount * ramp / (np.pi**2 * np.maximum(np.sin(angles), 0.2))


def with_diffraction(angles_rad: np.ndarray, scattered: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Return a phase function: what the drops' rays do and, by as much light again, their diffraction lobes.

    `sizes` are size parameters and `share` their part of the drops' cross-section.
    """
    return (scattered + geometric.diffraction(angles_rad, sizes, share)) / 2
