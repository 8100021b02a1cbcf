# SPDX-License-Identifier: GPL-3.0-or-later
"""From a theory to a table: sizes averaged, the sun folded in, wavelengths shared among threads.

A theory gives one drop's phase function at one wavelength; the sum over sizes weighs each with its number and cross-section.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait

import numpy as np

from opal_kernels.optics.rainbow import (
    THEORIES,
    Cancelled,
    _fourier,
    _mie_binding,
    airy,
    background,
    descartes,
    droplet,
    drops,
    geometric,
    mie,
    sun,
    water,
)

# Sizes of Airy and Droplet: a share of the radius between neighbours, and how many in each population.
_SIZE_STEP, _FEWEST, _MOST = 0.012, 21, 144
_SHARP = 80.0  # size parameter under which single resonances show
_RIPPLE = 0.4  # of a size parameter, half the period of Lorenz-Mie's ripple
_RAY_GRID = 36001  # 0.005 degrees
_FINEST = 288000  # intervals that a polynomial is filled in to
_RAYS_FROM = 60.0  # size parameter above which rays say what a drop lets straight through
_POLL_SECONDS = 0.1  # how often a caller who watches may stop a long table
_NEGLIGIBLE = 1e-7  # share of the cross-section under which a size is left out

Theory = Callable[[np.ndarray, bool], np.ndarray]  # angles, whether they are equally spaced from 0 to pi -> (2, n_angles)


def build(
    theory: str,
    radius_um: float,
    wavelengths_nm: np.ndarray,
    angles_rad: np.ndarray,
    spread: float,
    sun_radius_rad: float,
    distribution: str,
    sizes: int | None,
    celsius: float,
    salinity: float,
    index: np.ndarray | None,
    diffraction: bool,
    flattening: float,
    sun_elevation_rad: float,
    clock_rad: float,
    threads: int,
    progress: Callable[[float], bool | None] | None,
) -> np.ndarray:
    """`rainbow.phase_function` with every argument given."""
    if theory not in THEORIES:
        raise ValueError(f"no rainbow theory {theory!r}; there are {', '.join(THEORIES)}")
    nm = np.atleast_1d(np.asarray(wavelengths_nm, float))
    angles = np.atleast_1d(np.asarray(angles_rad, float))
    if nm.ndim != 1 or nm.size == 0 or not ((nm >= 200) & (nm <= 1100)).all():
        raise ValueError("wavelengths must lie between 200 and 1100 nm, and there must be one")
    if angles.ndim != 1 or angles.size == 0 or not ((angles >= 0) & (angles <= np.pi + 1e-9)).all():
        raise ValueError("scattering angles must lie between 0 and pi, and there must be one")
    n = water.index(nm, celsius, salinity) if index is None else np.broadcast_to(np.asarray(index, float), nm.shape)
    if not (np.isfinite(n) & (n > 1)).all():
        raise ValueError("the index of a drop relative to air must be finite and above 1")
    radii, weights = drops.quadrature(
        radius_um, spread, distribution, _sizes(theory, radius_um, nm, spread, distribution) if sizes is None else sizes
    )
    area = weights * radii**2
    kept = area > _NEGLIGIBLE * area.sum()
    radii, weights = radii[kept], weights[kept]
    shape = droplet.Shape(flattening, sun_elevation_rad, clock_rad)
    sun.smooth(np.zeros(3), sun_radius_rad)  # refuses an impossible sun before the work

    stopping = threading.Event()

    def one(i: int) -> np.ndarray:
        evaluate = _theory(theory, radii, weights, float(n[i]), float(nm[i]), diffraction, shape, stopping)
        return _seen(evaluate, angles, sun_radius_rad, _grid(theory, radii, nm[i]))

    result = np.empty((2, nm.size, angles.size))
    workers = threads if threads > 0 else os.cpu_count() or 1
    with ThreadPoolExecutor(min(workers, nm.size)) as pool:
        futures = {pool.submit(one, i): i for i in range(nm.size)}
        waiting = set(futures)
        try:
            while waiting:
                finished, waiting = wait(waiting, None if progress is None else _POLL_SECONDS, FIRST_COMPLETED)
                for future in finished:
                    result[:, futures[future]] = future.result()
                if progress is not None and progress(1 - len(waiting) / nm.size) is False:
                    raise Cancelled("the table was cancelled")
        finally:
            stopping.set()
            for future in futures:
                future.cancel()
    return result


def _sizes(theory: str, radius_um: float, nm: np.ndarray, spread: float, distribution: str) -> int:
    """How many sizes average away the ripple of Lorenz-Mie theory, or the arcs that each size of another theory draws.

    Lorenz-Mie: measured on primaries of 5 % spread at 550 nm under a point sun, against four times as many: the peak is within 1.5 % from 20
    to 250 um radius and 3.5 % at 500, single angles within 2.5 % of the peak (3.6 at 500). Ask for more `sizes` where that shows. Under 7 um
    twice as many: a resonance of so small a drop is a larger part of its light.
    """
    if theory.startswith("DESCARTES"):
        return 1
    populations = 2 if distribution == "TWO_SIZES" else 1
    if theory != "MIE" or not radius_um > 0:
        needed = drops.count_for(spread, distribution, _SIZE_STEP) // populations
        return int(np.clip(needed, _FEWEST, _MOST)) * populations
    x = 2000 * np.pi * radius_um / nm.mean()
    ripples = drops.count_for(spread, distribution, _RIPPLE / x)  # what small drops need and can be given
    return int(max(np.clip(1.44e5 / x, 48, 240 if x > _SHARP else 480), min(ripples, 1.44e5 / x, 480)))


def _grid(theory: str, radii: np.ndarray, nm: float) -> int:
    """How many angles resolve a theory's finest ripple; intensities have twice the degree of amplitudes."""
    if theory != "MIE":
        return _RAY_GRID
    return max(3601, 2 * int(1.2 * _mie_binding.terms(2000 * np.pi * radii.max() / nm)) + 1)


def _seen(evaluate: Theory, angles: np.ndarray, sun_radius: float, grid: int) -> np.ndarray:
    """A theory at the wanted angles, under a point or under a disc."""
    uniform = angles.size >= 2 and np.allclose(angles, np.linspace(0, np.pi, angles.size), rtol=0, atol=1e-9)
    if sun_radius == 0:
        return evaluate(angles, uniform)
    if uniform and angles.size >= grid:
        return np.clip(sun.smooth(evaluate(angles, True), sun_radius), 0, None)
    fine = np.linspace(0, np.pi, grid)
    smoothed = np.clip(sun.smooth(evaluate(fine, True), sun_radius), 0, None)
    return np.array([np.interp(angles, fine, row) for row in smoothed])


def _theory(
    name: str,
    radii: np.ndarray,
    weights: np.ndarray,
    n: float,
    nm: float,
    diffraction: bool,
    shape: droplet.Shape,
    stopping: threading.Event,
) -> Theory:
    sizes = 2000 * np.pi * radii / nm
    share = weights * radii**2 / (weights * radii**2).sum()  # of the geometric cross-section
    if name == "MIE":
        return lambda angles, uniform: _mie(angles, uniform, n, sizes, weights, share, diffraction, stopping)
    if name == "AIRY":
        scattered = airy.Drop(n).scattered
    elif name == "DROPLET":
        scattered = droplet.Drop(n, shape, nm, stopping).scattered
    else:
        table = descartes.solved_table(n) if name == "DESCARTES" else descartes.sampled_table(n)

        def scattered(angles, *_):
            return background.at(angles, table)

    def evaluate(angles: np.ndarray, uniform: bool) -> np.ndarray:
        light = scattered(angles, sizes, share)
        return background.with_diffraction(angles, light, sizes, share) if diffraction else light

    return evaluate


def _mie(
    angles: np.ndarray,
    uniform: bool,
    n: float,
    sizes: np.ndarray,
    weights: np.ndarray,
    share: np.ndarray,
    diffraction: bool,
    stopping: threading.Event,
) -> np.ndarray:
    # Intensities are polynomials in cos(theta) of twice the amplitudes' degree, and so is their sum over sizes: where fewer angles than
    # were asked for determine it, those are summed and the rest filled in once.
    intervals = _fourier.fast_length(2 * _mie_binding.terms(sizes.max()) + 2)
    sparse = not uniform and 1.5 * intervals < angles.size
    at = np.linspace(0, np.pi, intervals + 1) if sparse else angles
    area = (weights * np.pi * sizes**2 * mie.efficiencies(n, sizes)[1]).sum()
    phase = _summed(at, uniform, n, sizes, weights, stopping) / area
    if sparse:
        phase = _filled_in(phase, angles)
    if diffraction:
        return phase
    front, solid_angles, last = _front(sizes, share)
    before = _summed(front, False, n, sizes, weights, stopping) / area
    after = _without_lobe(front, before, n, sizes, share)
    # Beyond the front all is doubled but for what is left of the lobe, whose integral is 1.
    lobe = geometric.diffraction(front, sizes, share) @ solid_angles if last < np.pi / 2 else 1.0
    whole = (after - 2 * before).mean(axis=0) @ solid_angles + 1 + lobe
    return _without_lobe(angles, phase, n, sizes, share) / whole


def _summed(angles: np.ndarray, uniform: bool, n: float, sizes: np.ndarray, weights: np.ndarray, stopping: threading.Event) -> np.ndarray:
    """Intensities (2, n_angles) of spheres, each times its weight."""
    total = np.zeros((2, angles.size))
    # Single spheres where each is filled in by itself, else as many at once as make a tenth of a second's work.
    each = 1 if uniform else max(1, int(2e7 / (_mie_binding.terms(sizes.max()) * angles.size)))
    for some in np.array_split(np.arange(sizes.size), -(-sizes.size // each)):
        if stopping.is_set():
            raise Cancelled("the table was cancelled")
        if uniform:
            total += weights[some] * mie.uniform_intensities(n, float(sizes[some[0]]), angles.size, threads=1)
        else:
            total += mie.summed_intensities(n, sizes[some], weights[some], angles, threads=1)
    return total


def _filled_in(values: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Rows of a polynomial in cos(theta) at equally spaced angles from 0 to pi, at least one more than its degree: at any angles.

    By a Fourier transform to a grid so fine that linear interpolation between its points loses nothing: under 1e-5 of the finest ripple.
    """
    intervals = values.shape[1] - 1
    times = -(-_FINEST // intervals)
    whole = np.concatenate([values, values[:, -2:0:-1]], axis=1)
    spectrum = np.fft.rfft(whole, axis=1)
    spectrum[:, -1] *= 0.5  # the highest order stands for itself and its mirror
    fine = np.fft.irfft(spectrum, n=2 * intervals * times, axis=1)[:, : intervals * times + 1] * times
    nodes = np.linspace(0, np.pi, intervals * times + 1)
    return np.clip([np.interp(angles, nodes, row) for row in fine], 0, None)


def _front(sizes: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Angles and solid angles that integrate, after Gauss and Legendre, what taking the lobe away changes by more than a difference; and where they end.

    From forward to three times where `_without_lobe` ends its mending: all of the front where the drops are small. As many angles as the polynomial
    that is integrated has fringes there, and a quarter more.
    """
    x = 1 / (share / sizes).sum()  # by which the lobe's mean goes
    last = min(3 * _lobe_end(x), np.pi / 2) if x >= _RAYS_FROM else np.pi / 2  # behind that a disc diffracts nothing
    nodes, weights = np.polynomial.legendre.leggauss(64 + int(2.5 * _mie_binding.terms(sizes.max()) * last / np.pi))
    angles = 0.5 * last * (nodes + 1)
    return angles, weights * np.pi * last * np.sin(angles), last


def _lobe_end(x: float) -> float:
    """Angle at which the diffraction lobe's mean, 1/(pi^2 x theta^3), has fallen to 0.3/sr."""
    return (1 / (0.3 * np.pi**2 * x)) ** (1 / 3)


def _without_lobe(angles: np.ndarray, phase: np.ndarray, n: float, sizes: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Take the diffraction lobe, half of all light, out of Lorenz-Mie's phase function and double what remains; its integral is near 1.

    Amplitudes near the forward direction are the lobe's with a little of all else, and a difference of two large numbers is
    nothing to keep: there the rays' intensity stands, to half again `_lobe_end`. Drops under a few wavelengths have no lobe to speak of: what a
    disc's is above their light is cut off.
    """
    rest = np.clip(2 * phase - geometric.diffraction(angles, sizes, share), 0, None)
    x = (share * sizes).sum()
    if x < _RAYS_FROM:
        return rest
    end = _lobe_end(x)
    near = angles < 1.5 * end
    if near.any():
        t = np.clip(2 * angles[near] / end - 2, 0, 1)
        rays = background.at(angles[near], sum(background.orders(n).values()))
        rest[:, near] += (1 - t * t * (3 - 2 * t)) * (rays - rest[:, near])
    return rest
