# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as Blender's float images, and as multilayer OpenEXR files."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from . import own_images


def put(name: str, pixels: np.ndarray, owner: str = "", about: str = "") -> Any:
    """A float image of this name that shows the pixels; an image of the same name that is not Opal's is left alone.

    Parameters
    ----------
    name : str
        Wanted; Blender adds a number where a stranger has it, and the owner stands behind it where another's picture has it.
    pixels : ndarray
        (height, width, 3 or 4) scene-linear, premultiplied, rows from the bottom up.
    owner : str
        Whose picture it is, by `own_images.owner_of`; empty: of the whole file.
    about : str
        Kept in the image's custom property ``opal_picture``.

    Returns
    -------
    bpy.types.Image
    """
    height, width, channels = pixels.shape
    image = own_images.own(name, owner)
    if image is not None and (tuple(image.size) != (width, height) or not image.is_float):
        bpy.data.images.remove(image)
        image = None
    if image is None:
        image = bpy.data.images.new(own_images.name_for(name, owner, bpy.data.images), width, height, alpha=True, float_buffer=True)
    image.alpha_mode = "PREMUL"
    image[own_images.KEY], image[own_images.NAME_KEY], image[own_images.OWNER_KEY] = about or name, name, owner
    whole = np.ones((height, width, 4), np.float32)
    whole[..., :channels] = pixels
    image.pixels.foreach_set(whole.reshape(-1))
    image.update()
    image.pack()
    return image


def read(image: Any) -> np.ndarray:
    """An image's pixels, (height, width, channels) float32, rows from the bottom up."""
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(image.size[1], image.size[0], -1)


def write_layers(path: Path, layers: Mapping[str, Mapping[str, np.ndarray]]) -> None:
    """Writes a multilayer OpenEXR file as Blender reads it: channels ``Layer.Pass.R`` in 32 bits.

    Parameters
    ----------
    layers : mapping of str to mapping of str to ndarray
        By layer and pass: (height, width, 1, 3 or 4), rows from the bottom up.

    Raises
    ------
    OpalError
        If there is no OpenImageIO, or the file cannot be written.
    """
    from opal_kernels.binding import OpalError

    from ..addon.spectral_exr import image_io

    oiio = image_io("Multilayer files")
    names, planes = [], []
    for layer, found in layers.items():
        for name, pixels in found.items():
            letters = {1: "V", 3: "RGB", 4: "RGBA"}[pixels.shape[2]]
            names += [f"{layer}.{name}.{letter}" for letter in letters]
            planes.append(pixels)
    stack = np.ascontiguousarray(np.concatenate(planes, axis=2)[::-1], np.float32)
    spec = oiio.ImageSpec(stack.shape[1], stack.shape[0], stack.shape[2], "float")
    spec.channelnames = tuple(names)
    spec.attribute("compression", "zip")
    partial = path.with_name(path.stem + ".part.exr")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        out = oiio.ImageOutput.create(str(partial))
        if out is None or not out.open(str(partial), spec) or not out.write_image(stack) or not out.close():
            raise OpalError(f"The file {path} cannot be written: {out.geterror() if out is not None else oiio.geterror()}.")
        shutil.move(partial, path)
    except OSError as error:
        raise OpalError(f"The file {path} cannot be written: {error.strerror or error}.") from error
    finally:
        partial.unlink(missing_ok=True) if partial.parent.is_dir() else None


def write_png(path: Path, pixels: np.ndarray) -> None:
    """Writes display values, (height, width, 4), rows from the bottom up, as a PNG of 8 bits.

    Raises
    ------
    OpalError
        If it cannot be written.
    """
    from opal_kernels.binding import OpalError

    height, width, _ = pixels.shape
    image = bpy.data.images.new("Opal file", width, height, alpha=False)
    try:
        whole = np.ones((height, width, 4), np.float32)
        whole[..., :3] = pixels[..., :3]
        image.pixels.foreach_set(whole.reshape(-1))
        image.filepath_raw, image.file_format = str(path), "PNG"
        image.save()
    except RuntimeError as error:
        raise OpalError(f"The picture {path} cannot be written: {str(error).strip().splitlines()[-1]}") from None
    finally:
        bpy.data.images.remove(image)
