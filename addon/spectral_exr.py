# SPDX-License-Identifier: GPL-3.0-or-later
"""The spectral film as an OpenEXR file: one channel a wavelength, after Fichet, Pacanowski and Wilkie,
"An OpenEXR Layout for Spectral Images", JCGT 10(3), 2021.

A channel is named ``S0.<wavelength>nm`` with a comma for the decimal point: S0 is the first Stokes component, the whole
radiance. R, G and B beside them are the picture that an ordinary viewer shows. Rows run from the top down.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from opal_kernels.binding import OpalError

from .film_files import with_frame

# Blender's watts are not bound to a spectrum, so neither is the scale: only ratios between wavelengths and pixels are physical.
UNITS = "relative spectral radiance: 1 at every wavelength has luminance 1 in R, G, B"


def bin_centers(first: float, last: float, bins: int) -> np.ndarray:
    """Middle of each bin in nm, shape (bins,)."""
    return first + (np.arange(bins) + 0.5) * (last - first) / bins


def channel_name(wavelength: float) -> str:
    """The channel of a wavelength in nm: ``S0.550,5nm``; three decimals at most."""
    digits = f"{wavelength:.3f}".rstrip("0")
    return f"S0.{digits + '0' if digits.endswith('.') else digits}nm".replace(".", ",").replace(",", ".", 1)


def output_path(scene: Any, layer: str, suffix: str = "") -> Path:
    """Where a frame's spectral file goes: # are digits of the frame; a layer's name is added where there are several, and a view's suffix.

    Raises
    ------
    OpalError
        If the scene's setting names no file, or one beside a file that was never saved.
    """
    path = scene.opal.spectral_path
    if not path or path.endswith(("/", "\\")):
        raise OpalError("The spectral file cannot be written: Spectral EXR › File names no file.")
    path = with_frame(path, scene.frame_current)
    if not path.lower().endswith(".exr"):
        path += ".exr"
    if len(scene.view_layers) > 1:
        path = f"{path[:-4]}_{bpy.path.clean_name(layer)}.exr"
    return Path(f"{path[:-4]}{suffix}.exr")


def unavailable() -> str:
    """Why no spectral file can be written here, in one sentence; empty where it can."""
    try:
        image_io()
    except OpalError as error:
        return str(error)
    return ""


def image_io(what: str = "Spectral files") -> Any:
    """Blender's OpenImageIO module; OpalError where this build has none."""
    try:
        import OpenImageIO
    except ImportError:
        getattr(bpy.utils, "expose_bundled_modules", lambda: None)()
        try:
            import OpenImageIO
        except ImportError:
            raise OpalError(f"{what} cannot be written: this build of Blender has no OpenImageIO module.") from None
    return OpenImageIO


def write(path: Path, spectra: np.ndarray, rgb: np.ndarray, wavelengths: Sequence[float]) -> None:
    """Writes a spectral picture.

    Parameters
    ----------
    path : Path
        Folders are made as needed.
    spectra : ndarray
        (height, width, bins) radiance per nm, rows from the bottom up.
    rgb : ndarray
        (height, width, 3 or more) the same picture in linear Rec.709.
    wavelengths : sequence of float
        Middle of each bin, nm.

    Raises
    ------
    OpalError
        If there is no OpenImageIO, or the file cannot be written.
    """
    oiio = image_io()
    height, width, bins = spectra.shape
    spec = oiio.ImageSpec(width, height, 3 + bins, "float")
    spec.channelnames = ("R", "G", "B", *map(channel_name, wavelengths))
    spec.attribute("spectralLayoutVersion", "1.0")
    spec.attribute("emissiveUnits", UNITS)
    spec.attribute("compression", "zip")
    pixels = np.ascontiguousarray(np.concatenate((rgb[..., :3], spectra), axis=2)[::-1], np.float32)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OpalError(f"The spectral file {path} cannot be written: {error.strerror}.") from error
    out = oiio.ImageOutput.create(str(path))
    if out is None or not out.open(str(path), spec):
        reason = out.geterror() if out is not None else oiio.geterror()
        raise OpalError(f"The spectral file {path} cannot be written: {reason}.")
    written = out.write_image(pixels)
    reason = out.geterror()
    out.close()
    if not written:
        raise OpalError(f"The spectral file {path} cannot be written: {reason}.")
