# SPDX-License-Identifier: GPL-3.0-or-later
"""A wavefront traced through a drop that need not be round: the fifth theory, for flattened drops and twinned bows.

After Sadeghi et al., "Physically-Based Simulation of Rainbows", ACM TOG 31(1) (2012): a plane wave is a grid of rays, each with
amplitudes in both polarisations by Fresnel's formulas; the area that neighbours span on the far sphere gives the amplitude,
the optical path the phase, and rays that leave in one direction add as waves. Where they fold, at the caustic, that paper blurs
by a table. Here the fold is done as waves do it: the two rays' sum is continued through the caustic by the uniform
approximation of Chester, Friedman and Ursell (Proc. Camb. Phil. Soc. 53 (1957) 599),

    I = pi [(A1 + A2)^2 zeta^(1/2) Ai^2(-zeta) + (A1 - A2)^2 zeta^(-1/2) Ai'^2(-zeta)],    (4/3) zeta^(3/2) = k |path difference|,

whose factors are smooth functions of the angle from the caustic and are extrapolated a little into the dark. The path difference
is the integral of the difference of the two rays' lever arms over the angle, which does not cancel as the paths themselves do.

The drop is a spheroid of the axis ratio of falling drops (Beard and Chuang, J. Atmos. Sci. 44 (1987) 1509), its axis vertical.
Where the trace finds no single clean caustic (seen in some views from an axis
ratio of 0.93 down) the bow is smeared out, by choice and not by theory. The light seen at one place of the bow is that of the rays in the plane of sun, drop and place; the slight turn of the plane of
incidence out of it is neglected (none at the bow's top, where twinned bows part). Reflection outside, light passed through and
higher orders are those of a sphere; of these the fifth, whose bow stands in the dark band, is a traced fold as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from opal_kernels.optics import fresnel
from opal_kernels.optics.rainbow import background, geometric, sun
from opal_kernels.optics.rainbow.airy_function import squares

_RAYS = 1200
_STEP = 2e-4  # between neighbours on the wavefront, in radii
_CLOSE = np.radians(0.4)  # nearer than this to the caustic, fits replace differences
_FIT_END = np.radians(4.0)
_SMEAR = 0.15  # rad
_INDEX_STEP = 0.005  # of the traces between which flattened drops are interpolated
_SINGLES = 400


def axis_ratio(radius_um: float) -> float:
    """Return height over width of a falling drop: Beard and Chuang 1987, a polynomial in the diameter, at most 1."""
    d = min(2e-3 * radius_um, 8.0)
    return min(1.0, 1.0048 + d * (5.7e-4 + d * (-2.628e-2 + d * (3.682e-3 - 1.677e-4 * d))))


@dataclass(frozen=True)
class Shape:
    """How far from round, where the sun stands, and which place of the bow is looked at.

    flattening : 0 for spheres, 1 for the axis ratio of a falling drop; between, and up to 2, in proportion.
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

    def ratio(self, radius_um: float) -> float:
        """Return height over width of a drop of this radius."""
        return 1 - self.flattening * (1 - axis_ratio(radius_um))


@dataclass(frozen=True)
class Fold:
    """One bow of one drop: smooth functions of the angle from the caustic (delta, into the bright side), per unit of radius.

    `sums` and `differences` hold (2 polarisations, n) B1 + B2 and (B1 - B2)/sqrt(delta) with B = amplitude times delta^(1/4);
    `path` the path difference over delta^(3/2); `single` the intensity where only one ray arrives.
    """

    angle: float  # scattering angle of the caustic
    side: float  # +1 where the bright side has larger scattering angles
    delta: np.ndarray
    sums: np.ndarray
    differences: np.ndarray
    path: np.ndarray
    single_delta: np.ndarray
    single: np.ndarray

    def intensity(self, angles_rad: np.ndarray, x: float) -> np.ndarray:
        """Return (2, n_angles), d sigma/d Omega over the light on the drop."""
        result = np.zeros((2, len(angles_rad)))
        delta = self.side * (np.asarray(angles_rad, float) - self.angle)
        last = self.delta[-1]
        alone = delta > last
        both = np.flatnonzero((delta > -np.radians(25)) & ~alone)
        delta_both = delta[both]
        at = np.clip(delta_both, self.delta[0], last)
        scale = (0.75 * x * np.interp(at, self.delta, self.path)) ** (2 / 3)  # zeta/delta
        value, slope = squares(scale * delta_both)
        value, slope = np.pi * np.sqrt(scale) * value, np.pi / np.sqrt(scale) * slope
        for j in range(2):
            total, difference = (np.interp(at, self.delta, row[j]) for row in (self.sums, self.differences))
            result[j, both] = total**2 * value + difference**2 * slope
            result[j, alone] = np.interp(delta[alone], self.single_delta, self.single[j], right=0.0)
        return result


def _trace(origins: np.ndarray, direction: np.ndarray, n: float, k: int, inverse2: np.ndarray):
    """Follow rays (3, m) through a spheroid: directions and points of exit, amplitude factors (2, m), and which ones hit.

    `inverse2` holds 1/semi-axis^2: points p of the surface have sum(inverse2 p^2) = 1.
    """
    d = np.repeat(direction[:, None], origins.shape[1], axis=1)
    w = inverse2[:, None]
    a, b, c = (w * d * d).sum(0), (w * origins * d).sum(0), (w * origins * origins).sum(0) - 1
    root = b * b - a * c
    hit = root > 0
    point = origins + d * ((-b - np.sqrt(np.clip(root, 0, None))) / a)
    normal = w * point
    normal /= np.sqrt((normal * normal).sum(0))
    cos_i = np.clip(-(d * normal).sum(0), 0, 1)
    r_s, r_p = (r.real for r in fresnel.amplitudes(cos_i, n))
    factors = np.array([1 - r_s**2, 1 - r_p**2]) ** 0.5
    d = d / n + normal * (cos_i / n - np.sqrt(1 - (1 - cos_i**2) / n**2))
    for bounce in range(k + 1):
        point = point - d * (2 * (w * point * d).sum(0) / (w * d * d).sum(0))
        normal = w * point
        normal /= np.sqrt((normal * normal).sum(0))
        cos_in = np.clip((d * normal).sum(0), 0, 1)
        r_s, r_p = fresnel.amplitudes(cos_in, 1 / n)
        if bounce < k:
            factors = factors * np.array([r_s.real, r_p.real])
            d = d - 2 * normal * cos_in
        else:
            factors = factors * np.sqrt(np.clip(1 - np.abs(np.array([r_s, r_p])) ** 2, 0, None))
            d = d * n + normal * (np.sqrt(np.clip(1 - n * n * (1 - cos_in**2), 0, None)) - n * cos_in)
    return d, point, factors, hit


@lru_cache(maxsize=1024)
def fold(n: float, k: int, ratio: float, sun_elevation: float, clock: float) -> Fold | None:
    """Trace one order through a spheroid of unit equal-volume radius; None where it has no caustic to that side."""
    wide = ratio ** (-1 / 3)
    inverse2 = 1 / np.array([wide, wide, wide * ratio]) ** 2
    sun = np.array([np.cos(sun_elevation), 0.0, -np.sin(sun_elevation)])  # the way the light goes
    up = np.array([np.sin(sun_elevation), 0.0, np.cos(sun_elevation)])
    place = np.cos(clock) * up + np.sin(clock) * np.array([0.0, 1.0, 0.0])  # on the bow, as seen from its centre
    across = np.cross(sun, place)
    # Half-width of the shadow along `place`, and its area: support of an ellipsoid seen along `sun`.
    axes2 = 1 / inverse2
    metric = np.array([[place @ (axes2 * place), place @ (axes2 * across)], [place @ (axes2 * across), across @ (axes2 * across)]])
    # The shadow is an ellipse with the inverse metric of the projected ellipsoid's dual.
    shadow_area = np.pi * np.sqrt(np.linalg.det(metric))
    reach = np.sqrt(np.linalg.det(metric) / metric[1, 1])  # extent on the line through its centre

    entry = np.sin(np.linspace(0, np.pi / 2, _RAYS + 2)[1:-1]) * (reach - 2 * _STEP) * (1 if k % 2 else -1)
    offsets = np.array([[0, 0], [_STEP, 0], [-_STEP, 0], [0, _STEP], [0, -_STEP]])
    along = (entry[None, :] + offsets[:, :1]).ravel()
    beside = (0 * entry[None, :] + offsets[:, 1:]).ravel()
    out, point, factors, hit = _trace(-3 * sun[:, None] + np.outer(place, along) + np.outer(across, beside), sun, n, k, inverse2)
    if not hit.all():
        return None
    rays = out.reshape(3, 5, -1)
    centre = rays[:, 0]
    span_along, span_across = (rays[:, 1] - rays[:, 2]) / (2 * _STEP), (rays[:, 3] - rays[:, 4]) / (2 * _STEP)
    jacobian = np.abs((centre * np.cross(span_along, span_across, axis=0)).sum(0))  # solid angle per area of the wavefront
    angle = np.unwrap(np.arctan2(-(place @ centre), sun @ centre))
    exit_point = point.reshape(3, 5, -1)[:, 0]
    lever = across @ np.cross(exit_point, centre, axis=0)
    factors = factors.reshape(2, 5, -1)[:, 0]

    # The caustic: the turning point of the angle along the wavefront nearest to a sphere's, with the rays up to the next ones.
    slope = np.diff(angle)
    turns = np.flatnonzero(slope[1:] * slope[:-1] < 0) + 1
    if len(turns) == 0 or not 1 < n < k + 1:
        return None
    chosen = int(np.argmin(np.abs(np.abs(entry[turns]) / reach - np.sin(geometric.caustic_incidence(n, k)))))
    branch = slice(turns[chosen - 1] + 1 if chosen > 0 else 0, turns[chosen + 1] if chosen + 1 < len(turns) else None)
    turn = int(turns[chosen]) - branch.start
    entry, angle, jacobian, lever, factors = entry[branch], angle[branch], jacobian[branch], lever[branch], factors[:, branch]
    if turn < 10 or turn > len(entry) - 10:
        return None
    near = slice(turn - 3, turn + 4)
    parabola = np.polynomial.Polynomial.fit(entry[near], angle[near], 4)
    peaks = parabola.deriv().roots()
    peak = float(peaks[np.argmin(np.abs(peaks - entry[turn]))].real)
    caustic = float(parabola(peak))
    distance = np.abs(angle - caustic)
    root = np.sqrt(distance) * np.sign(np.abs(entry) - abs(peak))  # smooth along the wavefront: < 0 inside, > 0 outside
    away = distance > 0.02 * _CLOSE
    grown = factors * np.sqrt(np.abs(root) / np.maximum(jacobian, 1e-300)) / np.sqrt(shadow_area)

    end = min(root[away][-1], -root[away][0])
    if end**2 < 2 * _CLOSE:  # two caustics nearly meet: no two rays to fit
        return None
    u = np.linspace(0, end, 1500)[1:]
    strength = np.array([[np.interp(sign * u, root[away], row[away]) for row in grown] for sign in (1, -1)])
    outer, inner = (np.interp(sign * u, root[away], lever[away]) for sign in (1, -1))
    difference = np.abs(outer - inner)
    # From the caustic on the difference grows as u; its integral over the angle u^2 is the path.
    close = u * u < _CLOSE
    rate = difference / u
    fit = (u * u > _CLOSE / 4) & (u * u < _FIT_END)
    smooth_rate = np.polynomial.Polynomial.fit(u[fit] ** 2, rate[fit], 3)
    rate = np.where(close, smooth_rate(u * u), rate)
    path = np.cumsum(2 * u * u * rate) * (u[1] - u[0])
    path -= u * u * rate * (u[1] - u[0])  # trapezoids
    # Near zero the sum is coarse: the series of the integral of 2 u^2 (r0 + r1 u^2) is 2/3 r0 u^3 + 2/5 r1 u^5.
    over = path / u**3
    even = [(strength[0] + strength[1]), (strength[0] - strength[1]) / u]

    delta = np.concatenate([np.linspace(-np.radians(6), 0, 40, endpoint=False), u * u])

    def continued(values: np.ndarray, degree: int) -> np.ndarray:
        line = np.polynomial.Polynomial.fit(u[fit] ** 2, values[fit], degree)
        inside = np.where(close, line(u * u), values)
        dark = line(delta[:40]) if degree == 1 else np.polynomial.Polynomial.fit(u[fit] ** 2, values[fit], 1)(delta[:40])
        return np.concatenate([dark, inside])

    far = np.abs(root) > end
    order = np.argsort(distance[far])
    single = grown[:, far] ** 2 / np.maximum(np.abs(root[far]), 1e-12)
    folded = abs((caustic + np.pi) % (2 * np.pi) - np.pi)
    side = 1.0 if abs((float(angle[0]) + np.pi) % (2 * np.pi) - np.pi) > folded else -1.0
    return Fold(
        angle=folded,
        side=side,
        delta=delta,
        sums=np.array([continued(row, 3) for row in even[0]]),
        differences=np.array([continued(row, 3) for row in even[1]]),
        path=np.clip(continued(over, 3), 1e-6, None),
        single_delta=distance[far][order],
        single=single[:, order],
    )


def fold_near(n: float, k: int, ratio: float, sun_elevation: float, clock: float) -> Fold | None:
    """As `fold`, for flattened drops between traces of neighbouring indices, so that all wavelengths share four of them.

    The distance of the caustic from a sphere's is what is interpolated: within 0.001 degrees of the trace (measured for water at
    axis ratios down to 0.95).
    """
    if ratio == 1.0 or not 1 < n < k + 1:
        return fold(n, k, ratio, sun_elevation, clock)
    step = int(np.floor(n / _INDEX_STEP))
    nodes = (step * _INDEX_STEP, (step + 1) * _INDEX_STEP)
    pair = [fold(node, k, ratio, sun_elevation, clock) for node in nodes]
    if pair[0] is None or pair[1] is None or pair[0].side != pair[1].side:
        return fold(n, k, ratio, sun_elevation, clock)
    t = n / _INDEX_STEP - step
    shifts = [one.angle - float(geometric.fold(geometric.caustic_deviation(node, k))) for one, node in zip(pair, nodes, strict=True)]
    low, high = (
        (max(one.single_delta[0] for one in pair), min(one.single_delta[-1] for one in pair))
        if all(one.single_delta.size for one in pair)
        else (0.0, 0.0)
    )
    alone = np.linspace(low, max(high, low), _SINGLES)

    def mixed(name: str) -> np.ndarray:
        return (1 - t) * getattr(pair[0], name) + t * getattr(pair[1], name)

    singles = [
        np.array([np.interp(alone, one.single_delta, row) for row in one.single]) if one.single_delta.size else np.zeros((2, _SINGLES))
        for one in pair
    ]
    return Fold(
        angle=(1 - t) * shifts[0] + t * shifts[1] + float(geometric.fold(geometric.caustic_deviation(n, k))),
        side=pair[0].side,
        delta=mixed("delta"),
        sums=mixed("sums"),
        differences=mixed("differences"),
        path=mixed("path"),
        single_delta=alone,
        single=(1 - t) * singles[0] + t * singles[1],
    )


class Drop:
    """Drops of one index and several sizes, each with the shape that its size has."""

    def __init__(self, n: float, shape: Shape, nm: float) -> None:
        self._n, self._shape, self._nm = n, shape, nm
        self._densities = background.orders(n)

    def _bows(self, angles_rad: np.ndarray, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
        total = np.zeros((2, len(angles_rad)))
        for x, part in zip(sizes, share, strict=True):
            ratio = round(self._shape.ratio(x * self._nm / (2000 * np.pi)), 4)
            for k in background.BOWS:  # without a single caustic to that side a large flat drop smears its bow over the sky
                bow = fold_near(self._n, k, ratio, self._shape.sun_elevation_rad, self._shape.clock_rad)
                total += part * (
                    background.at(angles_rad, sun.smooth(self._densities[k], _SMEAR)) if bow is None else bow.intensity(angles_rad, x)
                )
            quinary = fold(self._n, background.QUINARY, 1.0, 0.0, 0.0)
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
