# SPDX-License-Identifier: GPL-3.0-or-later
"""Small pictures of what a material looks like, for lists to choose from: (size, size, 4), display values, premultiplied as
Blender draws icons, rows from the bottom up."""

from __future__ import annotations

import numpy as np

from ..metrics import srgb


def diffuse_reflectance(albedo: np.ndarray, anisotropy: float) -> np.ndarray:
    """What a thick slab of a medium sends back of diffuse light.

    Van de Hulst, "Multiple Light Scattering" (1980), volume 2: R = (1 - s)(1 - 0.139 s) / (1 + 1.17 s) with the similarity parameter
    s = sqrt((1 - a) / (1 - a g)).

    Parameters
    ----------
    albedo : ndarray
        Share of the light taken that is scattered, 0 to 1.
    anisotropy : float
        Mean cosine of the phase function.
    """
    a = np.clip(np.asarray(albedo, float), 0.0, 1.0)
    s = np.sqrt((1.0 - a) / np.maximum(1.0 - a * anisotropy, 1e-9))
    return (1.0 - s) * (1.0 - 0.139 * s) / (1.0 + 1.17 * s)


def flat(rgb: np.ndarray, size: int = 32) -> np.ndarray:
    """A disc of one colour (linear Rec.709), darker towards its edge as a ball is."""
    y, x = (np.mgrid[:size, :size] + 0.5) * 2.0 / size - 1.0
    distance = np.hypot(x, y)
    shade = 0.55 + 0.45 * np.sqrt(np.clip(1.0 - distance**2, 0.0, 1.0))
    return _in_a_disc(srgb(np.asarray(rgb, float) * shade[..., None]), distance, size)


def gem(rgb: np.ndarray, size: int = 32) -> np.ndarray:
    """A stone seen from above, eight facets about a table, in the color that white light takes on in it (linear Rec.709)."""
    y, x = (np.mgrid[:size, :size] + 0.5) * 2.0 / size - 1.0
    distance, facet = np.hypot(x, y), np.floor((np.arctan2(y, x) / (2 * np.pi)) % 1.0 * 8).astype(int)
    depth = np.where(distance < 0.5, 1.0, np.array([0.5, 1.3, 0.8, 1.7, 0.6, 1.4, 0.9, 1.6])[facet])
    light = np.where(distance < 0.5, 0.9, np.array([1.0, 0.7, 0.95, 0.6, 1.0, 0.75, 0.9, 0.65])[facet])
    body = np.clip(np.asarray(rgb, float), 1e-4, 1.0) ** depth[..., None]  # Beer's law along facets of unlike depth
    return _in_a_disc(srgb(body * light[..., None]), distance, size)


def strip(rows: np.ndarray, size: int = 32) -> np.ndarray:
    """Colours (n, 3) of display values from outside to inside as an arc, the outside on top."""
    y, x = (np.mgrid[:size, :size] + 0.5) / size
    radius = np.hypot(x - 0.5, y + 0.15)
    place = (1.05 - radius) / 0.42
    at = np.clip(place * (len(rows) - 1), 0, len(rows) - 1)
    colours = np.stack([np.interp(at, np.arange(len(rows)), rows[:, c]) for c in range(3)], axis=-1)
    out = np.ones((size, size, 4), np.float32)
    out[..., :3] = colours
    out[..., 3] = (place >= 0) & (place <= 1)
    out[..., :3] *= out[..., 3:]
    return out


def _in_a_disc(colours: np.ndarray, distance: np.ndarray, size: int) -> np.ndarray:
    out = np.ones((size, size, 4), np.float32)
    out[..., :3] = colours
    out[..., 3] = np.clip((1.0 - distance) * size / 2.0 + 0.5, 0.0, 1.0)
    out[..., :3] *= out[..., 3:]
    return out
