# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of a gem report, from the eye's rays through the stone.

The observer looks straight down, far away. A white hemisphere lights the stone from above the horizon, but for a cone about the observer,
whose head is in the way; below the horizon it is dark. Brightness is then the share of the stone's face that shows the hemisphere, by
weight of its rays. Shares add up to one: light returned, head, leakage, absorbed.

Sources: the angular division is that of the ASET instrument of the American Gem Society Laboratories (head: 30 degrees full); light return
and fire as sums over the eye's exit rays follow Hemphill, Reinitz, Johnson and Shigley, Gems & Gemology 34 (1998) 158 and Reinitz et al.,
Gems & Gemology 37 (2001) 174; fish-eye and nail-head after Tolkowsky, Diamond Design (1919), and trade usage.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..optics.dispersion import LINE_B, LINE_D, LINE_G
from .stone import FacetedStone
from .stone_rays import Exits, StoneRays

HEAD_ANGLE = math.radians(15.0)
"""Half of the cone that the observer's head takes, radians."""

# A fish-eye is seen when the girdle's image covers this share of the table; a nail-head when the head darkens this much of its middle.
FISH_EYE, NAIL_HEAD = 0.01, 0.5
# Facets inside by which the girdle's image under the table is looked for; beyond, it is broken up.
_FISH_EYE_FACETS = 3
# Wavelengths (nm) and weights by which a coloured stone's shares are averaged: Gauss and Hermite's rule of three for the luminance of
# white light, whose distribution has its mean at 557 nm and a deviation of 41 nm. A clear stone's shares are those of the D line.
_LUMINANCE = ((485.3, 1 / 6), (556.8, 2 / 3), (628.5, 1 / 6))
# The middle of the table, in table radii.
_MIDDLE = 0.5

Progress = Callable[[float], bool]


class Cancelled(Exception):
    """The person stopped the report."""


@dataclass(frozen=True)
class Shares:
    """Where the eye's rays end; the four add up to 1.

    Attributes
    ----------
    light_return : float
        Shows the bright hemisphere: brightness, as a share of white.
    head : float
        Shows the observer's head.
    leakage : float
        Goes out below the horizon: the window through which one sees what the stone lies on.
    absorbed : float
        Stays in the stone.
    """

    light_return: float
    head: float
    leakage: float
    absorbed: float


@dataclass(frozen=True)
class Report:
    """A stone's numbers.

    Attributes
    ----------
    face_up : Shares
        Of white light, face-up.
    glare : float
        The part of `face_up.light_return` that is a reflection off the outside.
    fire : float
        Mean angle in degrees between where the B and the G line leave by the same facets, by weight of the light returned.
    fish_eye : float
        Share of the table that shows the girdle after one reflection or two.
    nail_head : float
        Share of the light in the middle of the table that the head takes away.
    tilts : ndarray
        Degrees by which the stone is tilted.
    tilt_curve : tuple of Shares
        At those tilts.
    """

    face_up: Shares
    glare: float
    fire: float
    fish_eye: float
    nail_head: float
    tilts: np.ndarray
    tilt_curve: tuple[Shares, ...]

    @property
    def has_fish_eye(self) -> bool:
        return self.fish_eye > FISH_EYE

    @property
    def has_nail_head(self) -> bool:
        return self.nail_head > NAIL_HEAD


def _eye_rays(towards: np.ndarray, side: int) -> tuple[np.ndarray, np.ndarray]:
    """Parallel rays on a square grid over a disc of radius 1 across `towards`; and their places on it, (rays, 2)."""
    across = np.array([1.0, 0.0, 0.0])
    up = np.cross(-np.asarray(towards), across)
    at = (np.arange(side) + 0.5) / side * 2 - 1
    places = np.stack(np.meshgrid(at, at), axis=-1).reshape(-1, 2)
    places = places[(places**2).sum(axis=1) <= 1]
    return places[:, :1] * across + places[:, 1:] * up - 2 * np.asarray(towards), places


def _tilted(degrees: float) -> tuple[np.ndarray, np.ndarray]:
    """Direction of sight and the zenith in the frame of a stone tilted about its x axis."""
    a = math.radians(degrees)
    zenith = np.array([0.0, math.sin(a), math.cos(a)])
    return -zenith, zenith


def _shares(exits: Exits, zenith: np.ndarray, head: float) -> tuple[Shares, float]:
    """Shares over the rays that meet the stone, and the glare."""
    rays = exits.hit
    if not rays.any():
        return Shares(0.0, 0.0, 0.0, 0.0), 0.0
    weight = exits.weight[:, rays]
    cosine = exits.direction[:, rays] @ zenith
    is_head, is_sky = cosine > math.cos(head), cosine > 0
    absorbed = exits.absorbed[rays].sum()
    total = weight.sum() + absorbed  # of what ended; the little that still runs about would end likewise
    returned = weight * (is_sky & ~is_head)
    ends = (returned.sum(), weight[is_head].sum(), weight[~is_sky].sum(), absorbed)
    return Shares(*(float(end / total) for end in ends)), float(returned[0].sum() / total)


def _white_shares(rays: StoneRays, at_d: Exits | None, origins: np.ndarray, tilt: float, head: float) -> tuple[Shares, float]:
    """Shares and glare of white light; `at_d` saves the clear stone's rays where they are known."""
    towards, zenith = _tilted(tilt)
    if rays.stone.absorption is None:
        return _shares(at_d or rays.look(origins, towards, LINE_D), zenith, head)
    ends = np.zeros(5)
    for nm, weight in _LUMINANCE:
        s, glare = _shares(rays.look(origins, towards, nm), zenith, head)
        ends += weight * np.array([s.light_return, s.head, s.leakage, s.absorbed, glare])
    return Shares(*(float(end) for end in ends[:4])), float(ends[4])


def _fire(stone: FacetedStone, red: Exits, violet: Exits, zenith: np.ndarray) -> float:
    """Mean angle (degrees) between exits at two wavelengths that went through the same facets to the sky."""
    facets = np.append(stone.facets, -1)
    same = np.cumprod(facets[red.triangle] == facets[violet.triangle], axis=0).astype(bool)
    inner = np.zeros_like(same)
    inner[1:] = True  # the outside's reflection has no colours
    weight = np.minimum(red.weight, violet.weight)
    used = same & inner & (weight > 0) & (red.direction @ zenith > 0) & (violet.direction @ zenith > 0)
    if not used.any():
        return 0.0
    chord = np.linalg.norm(red.direction[used] - violet.direction[used], axis=-1)
    return float(np.degrees(np.average(2 * np.arcsin(np.clip(0.5 * chord, 0, 1)), weights=weight[used])))


def _fish_eye(stone: FacetedStone, exits: Exits, through_table: np.ndarray) -> float:
    """Share of the table's rays that see the girdle after one reflection or two."""
    if not through_table.any():
        return 0.0
    met = exits.triangle[1 : _FISH_EYE_FACETS + 1, through_table]
    return float((stone.is_girdle[met] & (met >= 0)).any(axis=0).mean())


def _nail_head(exits: Exits, places: np.ndarray, through_table: np.ndarray, zenith: np.ndarray, head: float) -> float:
    """Share of the light from inside that the head takes in the middle of the table."""
    if not through_table.any():
        return 0.0
    centre = places[through_table].mean(axis=0)
    radius = np.linalg.norm(places[through_table] - centre, axis=1).max()
    middle = through_table & (np.linalg.norm(places - centre, axis=1) < _MIDDLE * radius)
    weight = exits.weight[1:, middle]
    to_head = exits.direction[1:, middle] @ zenith > math.cos(head)
    total = weight.sum()
    return float(weight[to_head].sum() / total) if total > 0 else 0.0


def measure(
    stone: FacetedStone,
    tilts: np.ndarray | None = None,
    head: float = HEAD_ANGLE,
    side: int = 128,
    progress: Progress | None = None,
) -> Report:
    """Judges a stone.

    Parameters
    ----------
    stone : FacetedStone
    tilts : array_like, optional
        Degrees, about the stone's x axis; -30 to 30 in steps of 5 by default.
    head : float
        Half of the cone that the observer's head takes, radians.
    side : int
        Rays across the stone; half as many for each tilt.
    progress : callable, optional
        Told the part done; returns False to stop.

    Raises
    ------
    Cancelled
        If `progress` said so.
    ValueError
        If the head's angle is not between 0 and 90 degrees.
    """
    if not 0 <= head < math.pi / 2:
        raise ValueError(f"the head has to take between 0 and 90 degrees, not {math.degrees(head):.0f}")
    tilts = np.arange(-30.0, 31.0, 5.0) if tilts is None else np.asarray(tilts, float)
    steps = len(tilts) + 3

    def told(done: int) -> None:
        if progress is not None and not progress(done / steps):
            raise Cancelled

    with StoneRays(stone) as rays:
        towards, zenith = _tilted(0.0)
        origins, places = _eye_rays(towards, side)
        at_d = rays.look(origins, towards, LINE_D)
        shares, glare = _white_shares(rays, at_d, origins, 0.0, head)
        told(1)
        red, violet = rays.look(origins, towards, LINE_B), rays.look(origins, towards, LINE_G)
        told(3)
        curve = []
        for number, tilt in enumerate(tilts):
            seen = _eye_rays(_tilted(float(tilt))[0], side // 2)[0]
            curve.append(_white_shares(rays, None, seen, float(tilt), head)[0])
            told(4 + number)
    through_table = at_d.hit & stone.is_table[at_d.triangle[0]] & (at_d.triangle[0] >= 0)
    return Report(
        face_up=shares,
        glare=glare,
        fire=_fire(stone, red, violet, zenith),
        fish_eye=_fish_eye(stone, at_d, through_table),
        nail_head=_nail_head(at_d, places, through_table, zenith, head),
        tilts=tilts,
        tilt_curve=tuple(curve),
    )
