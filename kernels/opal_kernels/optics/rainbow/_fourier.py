# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths that a fast Fourier transform likes."""

from __future__ import annotations


def fast_length(least: int) -> int:
    """Return the smallest number of the form 2^a 3^b 5^c that is not below `least`."""
    best = 1 << max(least - 1, 1).bit_length()
    five = 1
    while five < best:
        three = five
        while three < best:
            power = max(-(-least // three) - 1, 0).bit_length()
            best = min(best, three << power)
            three *= 3
        five *= 5
    return best
