# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal's layers as pictures, and how they lie over a base.

    composite = base x transmittance + caustics + gems + media + rainbow

in scene-linear and premultiplied: added light, replaced pixels (the base has a hole there) and attenuation. The layers are films of
one render (`opal_kernels.descriptions.Pass.LAYER_*`).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from .layer_names import ADDED


def passes(chosen: Collection[str]) -> list[Any]:
    """The films that the chosen layers need, beside Combined."""
    from opal_kernels.descriptions import Pass

    through = "TRANSMITTANCE" in chosen
    kept = [Pass[f"LAYER_{name}"] for name in ADDED if name in chosen or (through and name in {"MEDIA", "RAINBOW"})]
    return kept + ([Pass.LAYER_BASE, Pass.LAYER_BEHIND, Pass.LAYER_DIMMED] if through else [])


def pictures(films: Mapping[Any, np.ndarray], chosen: Collection[str], transparent: bool) -> dict[str, np.ndarray]:
    """The chosen layers by identifier, (height, width, 4) float32, premultiplied; the transmittance is no light.

    Parameters
    ----------
    transparent : bool
        Whether the film is transparent; if not, the alphas of base and media add up to 1 in every pixel.
    """
    from opal_kernels.descriptions import Pass

    found = {name: films[Pass[f"LAYER_{name}"]] for name in ADDED if name in chosen}
    if "TRANSMITTANCE" in chosen:
        found["TRANSMITTANCE"] = through = transmittance(films[Pass.LAYER_DIMMED], films[Pass.LAYER_BEHIND])
        if not transparent:
            base = films[Pass.LAYER_BASE][..., 3]
            seen = base + films[Pass.LAYER_MEDIA][..., 3] + films[Pass.LAYER_RAINBOW][..., 3]
            through[..., 3] = np.divide(base, seen, out=np.zeros_like(seen), where=seen > 0)
    if "FULL" in chosen:
        found["FULL"] = films[Pass.COMBINED]
    return found


def transmittance(dimmed: np.ndarray, behind: np.ndarray) -> np.ndarray:
    """What media let through, pixel by pixel: the base with them over the base without, both from the same paths.

    The quotient has the noise of neither, and where things at several depths share a pixel it weighs them by the light they send.
    Where no light lies behind, alpha says how many paths came through; where none did, nothing does.
    """
    share = np.divide(dimmed[..., 3:], behind[..., 3:], out=np.zeros_like(dimmed[..., 3:]), where=behind[..., 3:] > 0)
    some = behind > 1e-6 * np.maximum(behind.max(axis=2, keepdims=True), 1e-6)
    result = np.where(some, np.divide(dimmed, behind, out=np.zeros_like(dimmed), where=some), share)
    return np.clip(result, 0.0, 1.0).astype(np.float32)


def composite(base: np.ndarray, layers: Mapping[str, np.ndarray]) -> np.ndarray:
    """Lays layers over a base; alpha is at most 1."""
    result = base.astype(np.float32, copy=True)
    if "TRANSMITTANCE" in layers:
        result *= layers["TRANSMITTANCE"]
    for name in ADDED:
        if name in layers:
            result += layers[name]
    result[..., 3] = np.clip(result[..., 3], 0.0, 1.0)
    return result
