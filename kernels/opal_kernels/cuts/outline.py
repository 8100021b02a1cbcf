# SPDX-License-Identifier: GPL-3.0-or-later
"""Girdle outlines: the curve that a stone shows from above, and its stations, the points that carry main facets.

Between two neighbouring stations the tangents meet in a point; the ray from the origin to it carries the ridge between the two mains, and
where it crosses the outline two half facets meet (`Junction`). Outlines run counter-clockwise round the origin; width (y) is 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Station:
    """A point of the outline that carries a main facet.

    Attributes
    ----------
    point : ndarray, shape (2,)
        On the outline.
    normal : ndarray, shape (2,)
        Unit, outward. At a corner of the outline, the direction in which its facet faces.
    """

    point: np.ndarray
    normal: np.ndarray

    @property
    def reach(self) -> float:
        """Distance of the tangent from the origin."""
        return float(self.point @ self.normal)

    def mirrored(self) -> Station:
        """The same on the other side of the x axis."""
        return Station(self.point * (1.0, -1.0), self.normal * (1.0, -1.0))


@dataclass(frozen=True)
class Outline:
    """A stone's outline.

    Attributes
    ----------
    points : ndarray, shape (N, 2)
        Corners of the girdle, counter-clockwise; the first follows the last when the outline is closed.
    stations : tuple of Station
        In the same order.
    """

    points: np.ndarray
    stations: tuple[Station, ...]


@dataclass(frozen=True)
class Junction:
    """What lies between two stations, along the ray from the origin that their ridge follows.

    Attributes
    ----------
    direction : ndarray, shape (2,)
        Unit, along the ray.
    meeting, girdle, chord : float
        Distances from the origin at which the tangents meet, the ray crosses the outline, and it crosses the line between the stations.
    """

    direction: np.ndarray
    meeting: float
    girdle: float
    chord: float


def junction(a: Station, b: Station, points: np.ndarray) -> Junction:
    """The junction between two stations of an outline with these corners."""
    meeting = np.linalg.solve(np.array((a.normal, b.normal)), np.array((a.reach, b.reach)))
    distance = float(np.linalg.norm(meeting))
    direction = meeting / distance
    chord = b.point - a.point
    across = np.array((chord[1], -chord[0]))
    return Junction(direction, distance, _leaving(points, direction), float(across @ a.point / (across @ direction)))


def _leaving(points: np.ndarray, direction: np.ndarray) -> float:
    """Distance at which a ray from the origin crosses the outline, closed or open, seen from the origin once in every direction."""
    edges = np.roll(points, -1, axis=0) - points
    slant = direction[0] * edges[:, 1] - direction[1] * edges[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (direction[1] * points[:, 0] - direction[0] * points[:, 1]) / slant
        distance = (points[:, 0] * edges[:, 1] - points[:, 1] * edges[:, 0]) / slant
    crossed = np.isfinite(along) & (along > -1e-9) & (along < 1.0 + 1e-9) & (distance > 0.0)
    return float(distance[crossed].max())


def ellipse(ratio: float, segments: int = 96) -> Outline:
    """An ellipse of length `ratio`, with eight stations as a round brilliant has when it is stretched."""
    angles = 2.0 * math.pi * np.arange(segments) / segments
    points = 0.5 * np.stack((ratio * np.cos(angles), np.sin(angles)), axis=1)
    stations = []
    for angle in math.tau * np.arange(8) / 8:
        normal = np.array((math.cos(angle) / ratio, math.sin(angle)))
        stations.append(Station(0.5 * np.array((ratio * math.cos(angle), math.sin(angle))), normal / np.linalg.norm(normal)))
    return Outline(points, tuple(stations))


def cushion(ratio: float, exponent: float = 3.0, segments: int = 96) -> Outline:
    """A superellipse |2x/ratio|ᵖ + |2y|ᵖ = 1 (G. Lamé), stations on its sides and corners."""

    def at(angle: np.ndarray) -> np.ndarray:
        c, s = np.cos(angle), np.sin(angle)
        return 0.5 * np.stack((ratio * np.sign(c) * np.abs(c) ** (2 / exponent), np.sign(s) * np.abs(s) ** (2 / exponent)), axis=-1)

    stations = []
    for angle in math.tau * np.arange(8) / 8:
        x, y = np.where(np.abs(at(angle)) < 1e-9, 0.0, at(angle))
        normal = np.array((math.copysign(abs(2 * x / ratio) ** (exponent - 1), x) / ratio, math.copysign(abs(2 * y) ** (exponent - 1), y)))
        stations.append(Station(np.array((x, y)), normal / np.linalg.norm(normal)))
    return Outline(at(2.0 * math.pi * np.arange(segments) / segments), tuple(stations))


@dataclass(frozen=True)
class Arc:
    """A circular arc, run counter-clockwise from one direction of its normal to another."""

    centre: tuple[float, float]
    radius: float
    start: float
    end: float

    def station(self, fraction: float) -> Station:
        """The point at this fraction of the arc."""
        angle = self.start + fraction * (self.end - self.start)
        normal = np.array((math.cos(angle), math.sin(angle)))
        return Station(np.array(self.centre) + self.radius * normal, normal)

    def points(self, count: int) -> np.ndarray:
        """Start and steps of the arc without its end, shape (count, 2)."""
        return np.array([self.station(i / count).point for i in range(count)])


def _flank(tip: float, shoulder: float = 0.0) -> Arc:
    """The arc from a tip at (tip, 0) to the widest point (shoulder, 0.5), level there."""
    run = tip - shoulder
    radius = run * run + 0.25
    return Arc((shoulder, 0.5 - radius), radius, math.atan2(radius - 0.5, run), 0.5 * math.pi)


def marquise(ratio: float, segments: int = 24) -> Outline:
    """Two arcs that meet in two tips, length `ratio`; stations on tips, sides and between."""
    flank = _flank(0.5 * ratio)
    quarter = [flank.station(i / segments).point for i in range(segments)]
    points = np.array(quarter + [(-x, y) for x, y in [(0.0, 0.5), *quarter[:0:-1]]])
    points = np.concatenate((points, -points))
    tip, between, side = Station(np.array((0.5 * ratio, 0.0)), np.array((1.0, 0.0))), flank.station(0.5), flank.station(1.0)
    half = [tip, between, side, Station(between.point * (-1, 1), between.normal * (-1, 1))]
    return Outline(points, (*half, *(Station(-s.point, -s.normal) for s in half)))


def pear(ratio: float, segments: int = 24) -> Outline:
    """Half a circle about the origin and two arcs to a tip at +x; length `ratio`."""
    tip = ratio - 0.5
    flank, head = _flank(tip), Arc((0.0, 0.0), 0.5, 0.5 * math.pi, math.pi)
    half = np.concatenate((flank.points(segments), head.points(segments)))
    points = np.concatenate((half, [(-0.5, 0.0)], half[:0:-1] * (1.0, -1.0)))
    upper = [flank.station(0.5), head.station(0.0), head.station(0.5)]
    stations = [Station(np.array((tip, 0.0)), np.array((1.0, 0.0))), *upper, head.station(1.0), *(s.mirrored() for s in upper[::-1])]
    return Outline(points, tuple(stations))


def trillion(bulge: float, segments: int = 24) -> Outline:
    """A triangle with arcs for sides, a tip at +x; `bulge` is the arcs' height over the sides, in sides.

    Stations sit on the three corners and on the middles of the three sides.
    """
    side = 1.0
    corner = side / math.sqrt(3.0)
    radius = (0.25 * side * side + (bulge * side) ** 2) / (2.0 * bulge * side)
    half_angle = math.asin(0.5 * side / radius)
    points, stations = [], []
    for turn in math.tau * np.arange(3) / 3:
        facing = turn + math.pi / 3.0
        offset = 0.5 * corner + bulge * side - radius
        arc = Arc((offset * math.cos(facing), offset * math.sin(facing)), radius, facing - half_angle, facing + half_angle)
        out = np.array((math.cos(turn), math.sin(turn)))
        stations += [Station(corner * out, out), arc.station(0.5)]
        points.append(arc.points(segments))
    joined = np.concatenate(points)
    width = np.ptp(joined[:, 1])
    return Outline(joined / width, tuple(Station(s.point / width, s.normal) for s in stations))


def heart_lobe(ratio: float, cleft: float = 0.11, segments: int = 24) -> Outline:
    """The half y ≥ 0 of a heart with its tip at +x: open, from the tip round the lobe to the cleft.

    Parameters
    ----------
    ratio : float
        Length, lobes to tip.
    cleft : float
        Depth of the cleft from the lobes' ends.
    """
    lobe = 0.28
    centre = 0.5 - lobe
    if not 0.0 < cleft < lobe:
        raise ValueError(f"cleft must lie between 0 and {lobe:g}, not {cleft!r}")
    # The lobe's circle reaches y = 0 at this distance behind its centre only if the cleft is this deep.
    across = lobe - cleft
    centre = min(centre, math.sqrt(lobe * lobe - across * across))
    shoulder = -0.10 * ratio
    scale = 0.5 / (centre + lobe)
    flank = _flank(shoulder + ratio - lobe * scale, shoulder)
    head = Arc((shoulder, centre * scale), lobe * scale, 0.5 * math.pi, math.pi + math.asin(centre / lobe))
    end = (shoulder - scale * math.sqrt(lobe * lobe - centre * centre), 0.0)
    points = np.concatenate((flank.points(segments), head.points(segments), [end]))
    tip = Station(np.array((flank.station(0.0).point[0], 0.0)), np.array((1.0, 0.0)))
    stations = (tip, flank.station(0.45), flank.station(1.0), head.station(0.40), head.station(0.80))
    return Outline(points, stations)
