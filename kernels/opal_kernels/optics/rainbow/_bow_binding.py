# SPDX-License-Identifier: GPL-3.0-or-later
"""The function of `include/opal_bow.h` on arrays."""

from __future__ import annotations

import ctypes
from functools import lru_cache

import numpy as np

from opal_kernels import binding

_double_p = ctypes.POINTER(ctypes.c_double)


class _Folds(ctypes.Structure):
    _fields_ = (
        *((name, ctypes.c_int32) for name in ("n_folds", "n_dark", "n_points", "n_single")),
        *((name, ctypes.c_double) for name in ("side", "dark", "shortest")),
        *((name, _double_p) for name in ("curves", "ends", "single")),
    )


class _AirySquares(ctypes.Structure):
    _fields_ = (("n", ctypes.c_int32), ("first", ctypes.c_double), ("step", ctypes.c_double), ("value", _double_p), ("slope", _double_p))


@lru_cache(maxsize=1)
def _function():
    function = binding.library().opal_bow_sum
    function.restype = ctypes.c_int32
    sizes = (ctypes.c_int32, *[_double_p] * 5)
    function.argtypes = [ctypes.POINTER(_Folds), ctypes.POINTER(_AirySquares), *sizes, ctypes.c_int32, _double_p, _double_p]
    return function


def _pointer(array: np.ndarray):
    return array.ctypes.data_as(_double_p)


def bow_sum(
    side: float,
    layout: tuple[int, int, float, float],
    curves: np.ndarray,
    ends: np.ndarray,
    single: np.ndarray,
    airy: tuple[float, float, np.ndarray, np.ndarray],
    sizes: np.ndarray,
    angles: np.ndarray,
) -> np.ndarray:
    """Return (2, n_angles); `layout` is (n_dark, n_points, dark, shortest), `airy` (first, step, value, slope), `sizes` (5, n): place, angle,
    x, share, shadow."""
    curves, ends, single, sizes, angles = (np.ascontiguousarray(a, float) for a in (curves, ends, single, sizes, angles))
    n_dark, n_points, dark, shortest = layout
    if curves.shape[1:] != (5, n_dark + n_points) or ends.shape != (len(curves), 3) or single.shape[:2] != (len(curves), 2):
        raise ValueError("a fold's curves do not have the shape that they are laid out in")
    folds = _Folds(len(curves), n_dark, n_points, single.shape[2], side, dark, shortest, _pointer(curves), _pointer(ends), _pointer(single))
    first, step, value, slope = airy
    squares = _AirySquares(len(value), first, step, _pointer(value), _pointer(slope))
    out = np.empty((2, angles.size))
    status = _function()(
        ctypes.byref(folds), ctypes.byref(squares), sizes.shape[1], *map(_pointer, sizes), angles.size, _pointer(angles), _pointer(out)
    )
    if status != 0:
        raise (
            MemoryError("out of memory in the sum of bows") if status == -2 else binding.OpalError("the sum of bows refused its arguments")
        )
    return out
