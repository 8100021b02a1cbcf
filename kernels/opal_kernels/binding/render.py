# SPDX-License-Identifier: GPL-3.0-or-later
"""The ``opal_render_`` and ``opal_film_`` functions: one Python function for one C function."""

from __future__ import annotations

from ctypes import POINTER, byref, c_double, c_int32
from typing import Any

import numpy as np

from ..descriptions import PASS_CHANNELS, Pass
from .arrays import fill, get, numbers, pointer
from .library import OpalError, checked, last_error, library
from .structures import RenderSettingsStruct, RenderStatisticsStruct


def render_create(scene: int, settings: Any) -> int:
    """A film and the state of a render, from `descriptions.RenderSettings`; free it with `render_destroy` once."""
    struct = fill(RenderSettingsStruct(), settings, skip=("region", "passes"))
    struct.region = (c_int32 * 4)(*(get(settings, "region") or (0, 0, struct.width, struct.height)))
    passes = get(settings, "passes", ())
    struct.passes = 1
    for number in passes:
        struct.passes |= 1 << int(number)
    handle = library().opal_render_create(scene, byref(struct))
    if not handle:
        raise OpalError(last_error() or "The render could not be created.")
    return handle


def render_destroy(render: int) -> None:
    """Frees a render; not while a pass runs."""
    library().opal_render_destroy(render)


def render_pass(render: int, number: int) -> None:
    """Renders one pass and adds it to the film; blocks without the interpreter lock.

    Raises
    ------
    Cancelled
        If `render_cancel` was called from another thread.
    """
    checked(library().opal_render_pass(render, number))


def render_cancel(render: int) -> None:
    """Asks the running pass to stop; from any thread."""
    library().opal_render_cancel(render)


def render_progress(render: int) -> float:
    """Fraction of the running pass that is done; from any thread."""
    return library().opal_render_progress(render)


def film_read(render: int, which: int, height: int, width: int, channels: int | None = None) -> np.ndarray:
    """An image of the film.

    Parameters
    ----------
    which : Pass
    height, width : int
        Of the rendered region.
    channels : int, optional
        Only for the spectral pass: its bins.

    Returns
    -------
    ndarray
        float32 of shape (height, width, channels), rows from the bottom up.
    """
    out = np.empty((height, width, channels or PASS_CHANNELS[Pass(which)]), np.float32)
    checked(library().opal_film_read(render, int(which), pointer(out)))
    return out


def film_read_sums(render: int, which: int, height: int, width: int, channels: int | None = None) -> np.ndarray:
    """The film's sums over passes: float64 of shape (height, width, channels), rows from the bottom up.

    Exact in double precision, so the sums of disjoint passes add up in any order. ``Pass.NOISE`` gives sums of squared luminance,
    ``Pass.DEPTH`` the depth itself.
    """
    out = np.empty((height, width, channels or PASS_CHANNELS[Pass(which)]), np.float64)
    checked(library().opal_film_read_sums(render, int(which), out.ctypes.data_as(POINTER(c_double))))
    return out


def film_depth_pass(render: int) -> int:
    """Number of the pass whose depth the film keeps; -1 before the first."""
    return library().opal_film_depth_pass(render)


def film_noise(render: int) -> float:
    """Mean estimated error relative to brightness; negative before two passes."""
    return library().opal_film_noise(render)


def render_get_statistics(render: int) -> dict[str, Any]:
    """Rays, photons, seconds and bytes of a render so far."""
    struct = RenderStatisticsStruct()
    checked(library().opal_render_get_statistics(render, byref(struct)))
    return numbers(struct)
