# SPDX-License-Identifier: GPL-3.0-or-later
"""RGB to spectra: a linear basis for everything that varies, a smooth fit for single colours.

`reflectance` and `emission` use three fixed curves R + G + B = 1 (Mallett and Yuksel 2019; ours are solved by
`tools/make_tables/uplift_basis.py`), so mixing, textures and interpolation commute with the uplift. `smooth_reflectance` is
Jakob and Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral Upsampling", eq. 3: a sigmoid of a parabola,
fitted to one colour by Gauss-Newton; it is smoother, so it suits what is raised to a power, such as a gem's transmittance.

Colours are linear Rec.709, fits are made under D65, spectra are at 360-830 nm in 1 nm steps.
"""

from __future__ import annotations

import numpy as np

from opal_kernels import data
from opal_kernels.optics import colour

_BRIGHTEST, _DARKEST = 1 - 1e-4, 1e-4  # a sigmoid reaches neither 1 nor 0
_X = (colour.WAVELENGTHS_NM - colour.FIRST_NM) / (colour.LAST_NM - colour.FIRST_NM) * 2 - 1


def basis() -> np.ndarray:
    """Return the spectra (3, 471) of the unit colours: they sum to 1, lie in [0, 1], and round-trip under D65."""
    return data.array("uplift_basis")


def reflectance(rgb: np.ndarray) -> np.ndarray:
    """Return spectra (..., 471) of linear Rec.709 colours (..., 3); in [0, 1] for colours in [0, 1]."""
    return np.asarray(rgb, float) @ basis()


def emission(rgb: np.ndarray) -> np.ndarray:
    """Return spectra (..., 471) of lights whose image is the linear Rec.709 colour (..., 3): D65 times the basis."""
    return reflectance(rgb) * colour.white()


def _sigmoid(t: np.ndarray) -> np.ndarray:
    return 0.5 + 0.5 * t / np.sqrt(1 + t * t)


def smooth_reflectance(rgb: np.ndarray, steps: int = 200) -> np.ndarray:
    """Fit one colour by a sigmoid of a parabola in wavelength.

    Parameters
    ----------
    rgb : array (3,)
        Linear Rec.709, each in [0, 1].
    steps : int
        Gauss-Newton steps at most; each is halved until the error falls.

    Returns
    -------
    array (471,)
        A reflectance in (0, 1) whose colour under D65 is `rgb`, to 1e-6 inside the gamut and 1e-3 on its edges.

    Raises
    ------
    ValueError
        If a component is not in [0, 1].
    """
    rgb = np.asarray(rgb, float)
    if rgb.shape != (3,) or not ((rgb >= 0) & (rgb <= 1)).all():
        raise ValueError(f"a reflectance needs three components in [0, 1], not {rgb}")
    target = np.clip(rgb, _DARKEST, _BRIGHTEST)
    film = colour.rec709_response() * colour.white()
    powers = np.stack([_X**2, _X, np.ones_like(_X)])

    def error_of(c: np.ndarray) -> np.ndarray:
        return film @ _sigmoid(c @ powers) - target

    mean = float(np.clip(colour.luminance(target), 0.01, 0.99))
    c = np.array([0.0, 0.0, (2 * mean - 1) / np.sqrt(1 - (2 * mean - 1) ** 2)])
    error, damping = error_of(c), 1e-4
    for _ in range(steps):
        t = c @ powers
        jacobian = (film * (0.5 * (1 + t * t) ** -1.5)) @ powers.T
        normal = jacobian.T @ jacobian
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal) + 1e-12), jacobian.T @ error)
        trial = error_of(c - step)
        if trial @ trial < error @ error:
            c, error, damping = c - step, trial, damping * 0.2
        else:
            damping = min(damping * 6, 1e8)
        if error @ error < 1e-18:
            break
    return _sigmoid(c @ powers)


def absorption(rgb: np.ndarray, depth_m: float) -> np.ndarray:
    """Return the absorption coefficient (471,), 1/m, that turns white into `rgb` over a depth.

    Parameters
    ----------
    rgb : array (3,)
        What D65 becomes, linear Rec.709 in [0, 1]; black is taken as 1e-4.
    depth_m : float
        Over which length, metres, above zero.

    Raises
    ------
    ValueError
        If the depth is not positive or a component is not in [0, 1].
    """
    if not depth_m > 0:
        raise ValueError(f"an absorption depth must be above zero, not {depth_m}")
    rgb = np.asarray(rgb, float)
    if rgb.shape == (3,) and (rgb == rgb[0]).all() and 0 <= rgb[0] <= 1:
        transmittance = np.full(colour.WAVELENGTHS_NM.shape, max(rgb[0], _DARKEST))  # a grey absorbs alike everywhere
    else:
        transmittance = smooth_reflectance(rgb)
    return -np.log(transmittance) / depth_m
