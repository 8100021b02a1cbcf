# SPDX-License-Identifier: GPL-3.0-or-later
"""Lorenz-Mie theory: the exact scattering of light by a sphere, of any size up to millimetres.

Conventions of Bohren and Huffman, Absorption and Scattering of Light by Small Particles (1983): m = n + ik, x = 2 pi a/lambda in
the surrounding medium, S1 perpendicular and S2 parallel to the scattering plane, angle 0 forward. Number of terms: Wiscombe,
Appl. Opt. 19 (1980) 1505. The sums run in C++ (`kernels/src/mie/`).

S1 and S2 are polynomials in cos(theta) of the degree of the last term, so a few more angles than terms determine them
everywhere: dense tables are summed at those and filled in by a Fourier transform, exactly.
"""

from __future__ import annotations

import numpy as np

from opal_kernels.optics.rainbow import _mie_binding
from opal_kernels.optics.rainbow._fourier import fast_length


def efficiencies(m, x) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (Q_ext, Q_sca, g) of spheres.

    Parameters
    ----------
    m : complex or array
        Index relative to the surrounding medium, n + ik; k >= 0 absorbs.
    x : float or array
        Size parameter 2 pi a/lambda, above 0 and at most 150,000.

    Returns
    -------
    three arrays of the broadcast shape
        Extinction and scattering cross-section over pi a^2, and the mean cosine of the scattering angle.

    Raises
    ------
    ValueError
        If m or x is out of range.
    """
    shape = np.broadcast_shapes(np.shape(m), np.shape(x))
    return tuple(column.reshape(shape)[()] for column in _mie_binding.efficiencies(m, x).T)


def amplitudes(m, x: float, angles_rad: np.ndarray, threads: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Return the complex amplitudes (S1, S2) of one sphere at scattering angles.

    Parameters
    ----------
    m, x : complex, float
        As for `efficiencies`.
    angles_rad : array (n,)
        In [0, pi].
    threads : int
        0 takes every core.

    Returns
    -------
    two complex arrays (n,)

    Raises
    ------
    ValueError
        If m or x is out of range.
    """
    angles = np.asarray(angles_rad, float)
    folded = np.minimum(angles, np.pi - angles)  # the sums give an angle and its mirror; fold to where the cosine is positive
    values = _mie_binding.amplitudes(m, x, np.cos(np.clip(folded, 0, np.pi / 2)), threads)[0]
    behind = angles > np.pi / 2
    return np.where(behind, values[:, 2], values[:, 0]), np.where(behind, values[:, 3], values[:, 1])


def summed_intensities(m, sizes: np.ndarray, weights: np.ndarray, angles_rad: np.ndarray, threads: int = 0) -> np.ndarray:
    """Return the sum of weight |S1|^2 and weight |S2|^2 (2, n_angles) over spheres of one index and several size parameters.

    Needs 64 bytes for every sphere and angle.

    Raises
    ------
    ValueError
        If m or a size is out of range.
    """
    angles = np.asarray(angles_rad, float)
    behind = angles > np.pi / 2
    folded = np.where(behind, np.pi - angles, angles)
    result = np.empty((2, angles.size))
    mirrored = np.allclose(angles, np.pi - angles[::-1], rtol=0, atol=1e-12)  # then half of the angles give all
    asked = folded[: (angles.size + 1) // 2] if mirrored else folded
    values = _mie_binding.amplitudes(m, sizes, np.cos(np.clip(asked, 0, np.pi / 2)), threads)
    sums = np.tensordot(np.asarray(weights, float), values.real**2 + values.imag**2, 1).T
    for j, (front, back) in enumerate(((0, 2), (1, 3))):
        if mirrored:
            result[j, : asked.size] = sums[front]
            result[j, angles.size - asked.size :] = sums[back, ::-1]
        else:
            result[j] = np.where(behind, sums[back], sums[front])
    return result


def uniform_intensities(m, x: float, n_angles: int, threads: int = 0) -> np.ndarray:
    """Return |S1|^2 and |S2|^2 (2, n_angles) at equally spaced scattering angles from 0 to pi, both ends included.

    Raises
    ------
    ValueError
        If m or x is out of range, or there are under two angles.
    """
    if n_angles < 2:
        raise ValueError(f"a table needs at least two angles, not {n_angles}")
    degree = _mie_binding.terms(x)
    intervals = fast_length(degree // 2 + 1) * 2 if degree > 0 else 2
    wanted = n_angles - 1
    if wanted < 1.2 * intervals:
        s1, s2 = amplitudes(m, x, np.linspace(0, np.pi, n_angles), threads)
        return np.abs(np.array([s1, s2])) ** 2
    half = np.arange(intervals // 2 + 1) * (np.pi / intervals)
    values = _mie_binding.amplitudes(m, x, np.cos(half), threads)[0]
    samples = np.empty((4, 2 * intervals))  # real and imaginary parts over the whole circle, on which they are even
    for row, (front, behind) in enumerate(((0, 2), (1, 3))):
        quarter = np.concatenate([values[:, front], values[-2::-1, behind]])
        whole = np.concatenate([quarter, quarter[-2:0:-1]])
        samples[2 * row], samples[2 * row + 1] = whole.real, whole.imag
    spectrum = np.fft.rfft(samples, axis=1) * (wanted / intervals)
    dense = np.fft.irfft(spectrum[:, : intervals + 1], n=2 * wanted, axis=1)[:, :n_angles]
    return dense[0::2] ** 2 + dense[1::2] ** 2
