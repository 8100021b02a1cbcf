# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffraction where a wavefront folds once: a bow, from the rays that a trace brings to one meridian of the sky.

Two rays arrive in every direction on the bright side of a simple fold and none on the dark one. The sum of their waves, infinite at the
caustic itself, is continued through it by the uniform approximation of Chester, Friedman and Ursell (Proc. Camb. Phil. Soc. 53 (1957) 599),

    I = pi [(A1 + A2)^2 zeta^(1/2) Ai^2(-zeta) + (A1 - A2)^2 zeta^(-1/2) Ai'^2(-zeta)],    (4/3) zeta^(3/2) = k |path difference|,

whose factors are smooth functions of the angle from the caustic and are extrapolated a little into the dark. The path difference
is the integral of the difference of the two rays' lever arms over the angle, which does not cancel as the paths themselves do.

`Meridian` holds the rays of a wavefront that leave in the half plane of one clock angle, wherever they entered: columns are
joined by a Fourier series, whose terms fall off exponentially, and the ray of each row is found by Newton's steps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opal_kernels.optics.rainbow import geometric
from opal_kernels.optics.rainbow.folded_bow import DARK, DARK_POINTS, SINGLE_POINTS, Fold, places
from opal_kernels.optics.rainbow.wavefront import Wavefront, cross

_CLOSE = np.radians(0.4)  # nearer than this to the caustic, fits replace differences
_FIT_END = np.radians(4.0)
_NEWTON_STEPS = 12
_EVEN = 0.2  # least over greatest rate of the path that a single fold has
_TURNED = 1.2  # rad that a ray may have entered from the half plane it leaves in


class Harmonics:
    """What folds need of a wavefront, as Fourier series over its columns: for any number of meridians."""

    def __init__(self, wave: Wavefront) -> None:
        self.wave = wave
        rows, columns = wave.path.shape
        slope = _slope(wave.direction, rows)
        field = wave.field.reshape(6, rows, columns)
        stack = np.concatenate([wave.direction, slope, wave.exit, field.real, field.imag, wave.area[None]])
        series = np.fft.rfft(stack, axis=-1) / columns
        self._orders = np.arange(series.shape[-1])
        series[..., 1:] *= 2
        series[..., -1] *= 0.5
        self._series = series * np.exp(-1j * self._orders * wave.columns[0])
        self.met = wave.met.all(axis=1)
        self.plain = int(np.argmin(np.append(wave.plain.all(axis=1), False)))  # rows before the first with total reflection

    def across(self, axis: np.ndarray) -> np.ndarray:
        """The series (rows, orders) of the direction's component along an axis."""
        return _along(axis, self._series[_DIRECTION])

    def powers(self, angles: np.ndarray) -> np.ndarray:
        """Return (rows, orders), e^(i m angle) of one angle a row."""
        steps = np.repeat(np.exp(1j * angles)[:, None], len(self._orders), axis=1)
        steps[:, 0] = 1
        return np.multiply.accumulate(steps, axis=1)

    def slope(self, powers: np.ndarray) -> np.ndarray:
        """Return the powers' derivative over the angle."""
        return powers * (1j * self._orders)

    def at(self, fields: slice, powers: np.ndarray) -> np.ndarray:
        """Fields (n, rows) at one angle a row."""
        return (self._series[fields] * powers).sum(axis=-1).real


_DIRECTION, _ALONG, _EXIT, _FIELD, _AREA = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 21), 21


@dataclass(frozen=True)
class Meridian:
    """Rays of one order in one half plane, a row each from the shadow's middle to its edge.

    `entry` is the place in the shadow as a sphere's angle of incidence, `angle` the deviation, unwrapped, `spread` the solid angle per area of
    the wavefront, `lever` the arm about the drop's centre, `amplitudes` (2 out: across the plane, in it; 2 in; rows). The first `plain` rays
    were nowhere totally reflected.
    """

    entry: np.ndarray
    angle: np.ndarray
    spread: np.ndarray
    lever: np.ndarray
    amplitudes: np.ndarray
    plain: int

    @classmethod
    def of(cls, harmonics: Harmonics, clock_rad: float, entry_rad: float) -> Meridian | None:
        """Return the rays of the rows about one (a sphere's angle of incidence) that have one ray there each; None where too few have."""
        wave, frame = harmonics.wave, harmonics.wave.frame
        place = np.cos(clock_rad) * frame.up + np.sin(clock_rad) * frame.side  # on the bow, as seen from its centre
        across = np.cross(frame.sun, place)
        rows = wave.path.shape[0]
        entered = clock_rad + (0.0 if wave.order % 2 else np.pi)
        # One ray a row: going round it, the side of the half plane changes twice, here and opposite.
        side = np.sign(_along(across, wave.direction))
        alone = (np.abs(np.diff(side, axis=1, append=side[:, :1])) > 0).sum(axis=1) == 2
        angle = np.full(rows, entered)
        series = harmonics.across(across)
        for _ in range(_NEWTON_STEPS):
            powers = harmonics.powers(angle)
            off, turn = (series * powers).sum(axis=1).real, (series * harmonics.slope(powers)).sum(axis=1).real
            step = np.clip(off / np.where(np.abs(turn) < 1e-12, 1e-12, turn), -0.3, 0.3)
            angle = angle - step
            if np.abs(step[alone]).max(initial=0.0) < 1e-11:
                break
        alone &= (np.abs(step) < 1e-8) & (np.abs(angle - entered) < _TURNED)
        alone &= harmonics.met
        alone[0] = False
        start = round(entry_rad / (np.pi / 2) * (rows - 1))
        if not alone[start]:
            return None
        gaps = np.flatnonzero(~np.append(alone, False))
        kept = slice(int(gaps[gaps < start][-1]) + 1, int(gaps[gaps > start][0]))
        powers = harmonics.powers(angle)
        fields = harmonics.at(slice(None), powers)
        u, along, exit_, area = fields[_DIRECTION], fields[_ALONG], fields[_EXIT], fields[_AREA]
        spread = cross(along, harmonics.at(_DIRECTION, harmonics.slope(powers)))
        real, imaginary = fields[_FIELD].reshape(2, 2, 3, rows)
        field = real + 1j * imaginary  # of totally reflected light
        plane = cross(across, u)
        amplitudes = np.array([(field * across[:, None]).sum(1), (field * plane).sum(1)]) / np.sqrt(wave.shadow)
        spread = np.abs((u * spread).sum(0)) / np.maximum(area, 1e-12)
        # Total reflection has an edge, which no short Fourier series follows: past it rays may not crowd more than before it.
        edge = max(harmonics.plain, 1)
        spread[edge:] = np.maximum(spread[edge:], 0.7 * spread[edge - 1])
        return cls(
            wave.rows[kept] * np.pi / 2,
            np.unwrap(np.arctan2(-(place @ u), frame.sun @ u))[kept],
            spread[kept],
            (_along(across, cross(exit_, u)))[kept],
            amplitudes[..., kept],
            min(kept.stop, harmonics.plain) - kept.start,
        )


def of_meridian(rays: Meridian, n: float, k: int) -> Fold | None:
    """Return the fold of order k that a sphere's caustic becomes; None where it has no caustic to that side, or no simple one."""
    slope = np.diff(rays.angle[: max(rays.plain, 0)])
    turns = np.flatnonzero(slope[1:] * slope[:-1] < 0) + 1
    if len(turns) == 0 or not 1 < n < k + 1:
        return None
    chosen = int(np.argmin(np.abs(rays.entry[turns] - geometric.caustic_incidence(n, k))))
    branch = slice(turns[chosen - 1] + 1 if chosen > 0 else 0, turns[chosen + 1] if chosen + 1 < len(turns) else None)
    turn = int(turns[chosen]) - branch.start
    entry, angle = rays.entry[branch], rays.angle[branch]
    if turn < 10 or turn > len(entry) - 10:
        return None
    near = slice(turn - 4, turn + 5)
    curve = np.polynomial.Polynomial.fit(entry[near], angle[near], 6)
    peaks = curve.deriv().roots()
    peak = float(peaks[np.argmin(np.abs(peaks - entry[turn]))].real)
    caustic = float(curve(peak))
    distance = np.abs(angle - caustic)
    root = np.sqrt(distance) * np.sign(entry - peak)  # smooth along the wavefront: < 0 inside, > 0 outside
    away = distance > 0.02 * _CLOSE
    grown = rays.amplitudes[..., branch] * np.sqrt(np.abs(root) / np.maximum(rays.spread[branch], 1e-300))
    end = min(root[away][-1], -root[away][0])
    if end**2 < 2 * _CLOSE:  # two caustics nearly meet: no two rays to fit
        return None

    u = end * places()
    inner, outer = _ascending(-root, root < 0, away), _ascending(root, root > 0, away)
    flat = grown.reshape(4, -1)
    a, b = (np.array([np.interp(u, at, row[order]) for row in flat]) for at, order in (outer, inner))
    lever = rays.lever[branch]
    rate = np.abs(np.interp(u, outer[0], lever[outer[1]]) - np.interp(u, inner[0], lever[inner[1]])) / u
    # From the caustic on the difference of levers grows as u; its integral over the angle u^2 is the path.
    close, fit = u * u < _CLOSE, (u * u > _CLOSE / 4) & (u * u < _FIT_END)
    rate = _continued(u, rate[None], fit, close)[0]
    trapezoids = np.diff(u) * (u[1:] ** 2 * rate[1:] + u[:-1] ** 2 * rate[:-1])
    path = np.append(2 / 3 * rate[0] * u[0] ** 3, trapezoids).cumsum()
    over = path / u**3
    smooth = _continued(u, np.concatenate([over[None], a + b, (a - b) / u]), fit, close)
    if not smooth[0].real.min() > _EVEN * smooth[0].real.max():  # another fold is near
        return None
    dark = np.linspace(-DARK, 0, DARK_POINTS, endpoint=False)
    curves = np.concatenate([_lines(u, np.concatenate([over[None], a + b, (a - b) / u]), fit, dark), smooth], axis=1)
    power = (np.abs(curves[1:]).reshape(2, 2, 2, -1) ** 2).sum(axis=2)  # sum or difference, out; over what comes in

    far = np.abs(root) > end
    order = np.argsort(distance[far])
    at, single = distance[far][order], (np.abs(grown[..., far]) ** 2).sum(axis=1) / np.maximum(np.abs(root[far]), 1e-12)
    alone = (float(at[0]), float(at[-1])) if at.size else (float(end**2), float(end**2) + 1e-6)
    even = np.linspace(*alone, SINGLE_POINTS)
    folded = abs((caustic + np.pi) % (2 * np.pi) - np.pi)
    side = 1.0 if abs((float(angle[0]) + np.pi) % (2 * np.pi) - np.pi) > folded else -1.0
    return Fold(
        angle=folded,
        side=side,
        last=float(end**2),
        curves=np.concatenate([power[0], power[1], np.cbrt(0.75 * np.maximum(curves[:1].real, 0.5 * smooth[0, 0].real)) ** 2]),
        alone=alone,
        single=np.array([np.interp(even, at, row[order]) for row in single]) if at.size else np.zeros((2, SINGLE_POINTS)),
    )


def _along(axis: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Components of vectors (3, ...) along an axis (3,); BLAS would start threads for it."""
    return axis[0] * vectors[0] + axis[1] * vectors[1] + axis[2] * vectors[2]


def _slope(f: np.ndarray, rows: int) -> np.ndarray:
    """Derivative over the row's place, of fourth order inside."""
    result = np.gradient(f, axis=1, edge_order=2)
    result[:, 2:-2] = (8 * (f[:, 3:-1] - f[:, 1:-3]) - (f[:, 4:] - f[:, :-4])) / 12
    return result * (rows - 1)


def _ascending(values: np.ndarray, which: np.ndarray, away: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Chosen values in ascending order, and which they are."""
    chosen = np.flatnonzero(which & away)
    chosen = chosen[np.argsort(values[chosen])]
    return values[chosen], chosen


def _lines(u: np.ndarray, values: np.ndarray, fit: np.ndarray, at: np.ndarray, degree: int = 1) -> np.ndarray:
    """Polynomials in u^2 of rows, fitted where `fit` says: their values at u^2 = `at`."""
    powers = np.vander(u[fit] ** 2 / _FIT_END, degree + 1)
    solution = np.linalg.lstsq(powers, values[:, fit].T, rcond=None)[0]
    return (np.vander(at / _FIT_END, degree + 1) @ solution).T


def _continued(u: np.ndarray, values: np.ndarray, fit: np.ndarray, close: np.ndarray) -> np.ndarray:
    """Rows with what lies next to the caustic taken from cubics fitted beside it."""
    result = values.copy()
    result[:, close] = _lines(u, values, fit, u[close] ** 2, 3)
    return result
