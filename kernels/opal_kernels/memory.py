# SPDX-License-Identifier: GPL-3.0-or-later
"""How much memory a film and the pictures made of it take, and how much there is: to refuse a render before it swaps the machine to death."""

from __future__ import annotations

import os
from collections.abc import Iterable

from .descriptions import PASS_CHANNELS, Pass

# A film sums in double precision and holds one pass in single precision; luminance squared is kept for the error.
_BYTES_PER_CHANNEL = 8 + 4
_BYTES_PER_PIXEL = 8 + 16
_BYTES_OF_A_FLOAT = 4
# Open Image Denoise works on tiles where it would need more than its default limit ("maxMemoryMB"); the need is measured.
_DENOISER_PER_PIXEL, _DENOISER_AT_MOST = 550, 3_000_000_000


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


def copies_bytes(pixels: int, spectral_bins: int = 0, denoised: bool = False) -> int:
    """Bytes that reading a finished film takes at once, at most: one picture, what denoises it, or what a spectral file is made of.

    Parameters
    ----------
    pixels : int
        Of the rendered region.
    spectral_bins : int
        Bins of the spectral file, 0 for none.
    denoised : bool
        Whether the picture is denoised.
    """
    picture = 4
    denoising = 2 * 4 + 6 * 3  # the picture and the clean one; colour, its guides, those cleaned, and what comes out
    spectrum = 4 + spectral_bins + 2 * (3 + spectral_bins)  # the picture, the spectra, both in one array and that upside down
    floats = max(picture, denoising if denoised else 0, spectrum if spectral_bins else 0)
    return pixels * _BYTES_OF_A_FLOAT * floats + (min(pixels * _DENOISER_PER_PIXEL, _DENOISER_AT_MOST) if denoised else 0)


def result_bytes(pixels: int, passes: Iterable[int] = ()) -> int:
    """Bytes of the pictures that Blender keeps in single precision.

    Parameters
    ----------
    pixels : int
        Of Blender's picture.
    passes : iterable of Pass
        Beside Combined.
    """
    return pixels * _BYTES_OF_A_FLOAT * (PASS_CHANNELS[Pass.COMBINED] + sum(PASS_CHANNELS[Pass(p)] for p in passes))


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
