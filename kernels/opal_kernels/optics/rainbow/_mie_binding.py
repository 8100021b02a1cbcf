# SPDX-License-Identifier: GPL-3.0-or-later
"""The three functions of `include/opal_mie.h` on arrays: shapes and ranges checked at the door, one exception on failure."""

from __future__ import annotations

import ctypes
from functools import lru_cache

import numpy as np

from opal_kernels import binding

MAX_SIZE_PARAMETER = 150000.0

_double_p = ctypes.POINTER(ctypes.c_double)


@lru_cache(maxsize=1)
def _functions() -> ctypes.CDLL:
    library = binding.library()
    library.opal_mie_terms.restype = ctypes.c_int32
    library.opal_mie_terms.argtypes = [ctypes.c_double]
    library.opal_mie_efficiencies.restype = ctypes.c_int32
    library.opal_mie_efficiencies.argtypes = [ctypes.c_int32, *[_double_p] * 4]
    library.opal_mie_amplitudes.restype = ctypes.c_int32
    library.opal_mie_amplitudes.argtypes = [ctypes.c_int32, *[_double_p] * 3, ctypes.c_int32, _double_p, ctypes.c_int32, _double_p]
    return library


def _pointer(array: np.ndarray):
    return array.ctypes.data_as(_double_p)


def _spheres(m, x) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Check and flatten: real and imaginary parts of m, and x, contiguous."""
    m, x = np.broadcast_arrays(np.asarray(m, complex), np.asarray(x, float))
    if not (np.isfinite(m).all() and (m.real > 0).all() and (m.imag >= 0).all()):
        raise ValueError("an index must be finite with a positive real part and an imaginary part that is not negative")
    if not ((x > 0) & (x <= MAX_SIZE_PARAMETER)).all():
        raise ValueError(f"a size parameter must lie between 0 and {MAX_SIZE_PARAMETER:g}, a drop's radius thus under 8 mm")
    return tuple(np.ascontiguousarray(part.ravel(), float) for part in (m.real, m.imag, x))


def _check(status: int) -> None:
    if status != 0:
        raise (
            MemoryError("out of memory in the Lorenz-Mie sums")
            if status == -2
            else binding.OpalError("the Lorenz-Mie sums refused their arguments")
        )


def terms(x: float) -> int:
    """Return how many terms of the series a sphere of size parameter x needs."""
    return int(_functions().opal_mie_terms(float(x)))


def efficiencies(m, x) -> np.ndarray:
    """Return (n, 3): Q_ext, Q_sca, g of the broadcast and flattened spheres."""
    m_re, m_im, sizes = _spheres(m, x)
    out = np.empty((sizes.size, 3))
    _check(_functions().opal_mie_efficiencies(sizes.size, _pointer(m_re), _pointer(m_im), _pointer(sizes), _pointer(out)))
    return out


def amplitudes(m, x, cosines: np.ndarray, threads: int = 0) -> np.ndarray:
    """Return complex (n, n_angles, 4): S1, S2 at the cosines, then S1, S2 at minus the cosines."""
    m_re, m_im, sizes = _spheres(m, x)
    cosines = np.ascontiguousarray(cosines, float)
    out = np.empty((sizes.size, cosines.size, 8))
    _check(
        _functions().opal_mie_amplitudes(
            sizes.size, _pointer(m_re), _pointer(m_im), _pointer(sizes), cosines.size, _pointer(cosines), threads, _pointer(out)
        )
    )
    return out.view(complex)
