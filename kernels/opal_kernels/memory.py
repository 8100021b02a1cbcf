# SPDX-License-Identifier: GPL-3.0-or-later
"""How much memory a film takes, and how much there is: to refuse a render before it swaps the machine to death."""

from __future__ import annotations

import os
from collections.abc import Iterable

from .descriptions import PASS_CHANNELS, Pass

# A film sums in double precision and holds one pass in single precision; luminance squared is kept for the error.
_BYTES_PER_CHANNEL = 8 + 4
_BYTES_PER_PIXEL = 8 + 16


def film_bytes(pixels: int, passes: Iterable[int] = (), spectral_bins: int = 0) -> int:
    """Bytes that the film of a render takes.

    Parameters
    ----------
    pixels : int
        Of the rendered region.
    passes : iterable of Pass
        Beside Combined.
    spectral_bins : int
        Bins of the spectral film, 0 for none.
    """
    kept = {Pass.COMBINED, *(Pass(p) for p in passes)} - {Pass.SPECTRAL}
    channels = sum(PASS_CHANNELS[p] for p in kept) + spectral_bins
    return pixels * (channels * _BYTES_PER_CHANNEL + _BYTES_PER_PIXEL)


def available_bytes() -> int | None:
    """Memory that can be had without swapping; None where the system does not say."""
    try:
        with open("/proc/meminfo", encoding="ascii") as lines:
            for line in lines:
                if line.startswith("MemAvailable:"):
                    return int(line.split()[1]) * 1024
    except OSError:
        pass
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
    except (AttributeError, ValueError, OSError):
        return None
