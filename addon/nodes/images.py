# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender images as arrays for the tracer.

Bytes stay bytes: an 8-bit sRGB image is decoded by the kernels after interpolation, as in Cycles. Float images are scene linear
in Blender already. Other colour spaces are converted here by OpenColorIO, with Blender's own configuration. Colours are
multiplied by alpha unless the image says otherwise (Channel Packed, None, data).
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Callable
from contextlib import contextmanager
from typing import Any

import numpy as np

from ..identity import Named, key_of
from .context import Problem

TRANSFER_LINEAR, TRANSFER_SRGB = 0, 1
_SRGB = {"sRGB", "sRGB Texture"}
_LINEAR = {"Linear", "Linear Rec.709", "Linear Rec.709 (sRGB)", "scene_linear", "Non-Color", "Raw", "Generic Data"}


class Images:
    """A kernel scene's images by Blender's, each once.

    Parameters
    ----------
    add_image : callable
        Takes pixels (height, width, channels), uint8 or float32, rows from the bottom up, and the transfer; returns a number.
    note : callable
        Takes a `Problem`.
    """

    def __init__(self, add_image: Callable[[np.ndarray, int], int], note: Callable[[Problem], None]) -> None:
        self._add, self._note = add_image, note
        self._numbers: dict[tuple, int] = {}
        self.any_frames = False  # whether a sequence or a film was asked for

    def index(self, image: Any, image_user: Any = None, frame: int = 1) -> int:
        """The number of an image, of a sequence at its user's frame while the scene is at `frame`; -1 where it cannot be read."""
        self.any_frames |= image.source in {"SEQUENCE", "MOVIE"}
        if image.source == "SEQUENCE" and image_user is not None and not image.packed_files:
            shown = frame_shown(image_user, frame)
            return self._number((key_of(image), "frame", shown), image, lambda: frame_pixels(image, shown))
        if image.source == "MOVIE":
            self._note(Problem(Named(image), "", "Films show the frame that Blender has loaded."))
        return self._number((key_of(image),), image, lambda: loaded_pixels(image))

    def tiles(self, image: Any) -> list[tuple[int, int]]:
        """(UDIM number, kernel number) of the tiles that can be read."""
        if image.is_dirty:
            sentence = "Tiles that were painted and not saved since show what their files hold: save the image."
            self._note(Problem(Named(image), "", sentence))
        found = []
        for position, tile in enumerate(image.tiles):
            key = (key_of(image), tile.number)
            number = self._number(key, image, lambda p=position, t=tile.number: tile_pixels(image, p, t))
            if number >= 0:
                found.append((tile.number, number))
        return found

    def _number(self, key: tuple, image: Any, read: Callable[[], np.ndarray | None]) -> int:
        if key not in self._numbers:
            self._numbers[key] = self._read(image, read)
        return self._numbers[key]

    def _read(self, image: Any, read: Callable[[], np.ndarray | None]) -> int:
        try:
            pixels = read()
        except (OSError, RuntimeError, MemoryError, ImportError) as error:
            self._note(Problem(Named(image), "", f"The image cannot be read ({error}); it is magenta.", lost=True))
            return -1
        if pixels is None:
            where = image.filepath_raw or "nowhere"
            self._note(Problem(Named(image), "", f"The image is not found at {where}; it is magenta.", lost=True))
            return -1
        pixels, transfer, sentence = prepared(pixels, image)
        if sentence:
            self._note(Problem(Named(image), "", sentence))
        return self._add(pixels, transfer)


def loaded_pixels(image: Any) -> np.ndarray | None:
    """What Blender holds of an image.

    Returns
    -------
    ndarray or None
        (height, width, channels): uint8 as stored, or float32 scene linear; None where there is nothing.
    """
    width, height = image.size
    channels = image.channels
    if width == 0 or height == 0 or channels == 0:
        return None
    values = np.empty(width * height * channels, np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, channels)
    return values if image.is_float else np.rint(values * 255).clip(0, 255).astype(np.uint8)


def frame_shown(image_user: Any, frame: int) -> int:
    """The number of the frame that an image user shows while the scene is at `frame`, as Blender counts."""
    length = image_user.frame_duration
    if length == 0:
        return 0
    place = frame - image_user.frame_start + 1
    if image_user.use_cyclic:
        place = place % length or length
    return min(max(place, 0), length) + image_user.frame_offset


def frame_pixels(image: Any, number: int) -> np.ndarray | None:
    """One frame of a sequence, read from its file; shape, type and meaning as of `loaded_pixels`.

    The frame's number takes the place of the last digits in the file's name.
    """
    import bpy

    folder, name = os.path.split(bpy.path.abspath(image.filepath_raw, library=image.library))
    stem, suffix = os.path.splitext(name)
    stem = re.sub(r"\d+(?=\D*$)", lambda digits: f"{max(number, 0):0{len(digits.group())}d}", stem)
    path = os.path.join(folder, stem + suffix)
    pixels = _file_pixels(path) if os.path.isfile(path) else None
    return None if pixels is None else _as_loaded(pixels, image)


def tile_pixels(image: Any, position: int, number: int) -> np.ndarray | None:
    """One tile of a tiled image, read from its file or from what is packed; shape, type and meaning as of `loaded_pixels`."""
    if image.packed_files:
        data = image.packed_files[position].packed_file.data if position < len(image.packed_files) else b""
        with _as_file(bytes(data)) as path:
            pixels = _file_pixels(path)
    else:
        import bpy

        u, v = (number - 1001) % 10, (number - 1001) // 10
        path = bpy.path.abspath(image.filepath_raw, library=image.library)
        path = path.replace("<UDIM>", str(number)).replace("<UVTILE>", f"u{u + 1}_v{v + 1}")
        pixels = _file_pixels(path) if os.path.isfile(path) else None
    return None if pixels is None else _as_loaded(pixels, image)


@contextmanager
def _as_file(data: bytes):
    handle, path = tempfile.mkstemp()
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        yield path
    finally:
        os.unlink(path)


def _file_pixels(path: str) -> np.ndarray | None:
    """What a file holds, alpha and encoding as they are stored; uint8, or float32 for anything finer."""
    import bpy

    bpy.utils.expose_bundled_modules()
    import OpenImageIO as oiio

    as_stored = oiio.ImageSpec()
    as_stored.attribute("oiio:UnassociatedAlpha", 1)  # OpenImageIO multiplies alpha in by itself otherwise
    source = oiio.ImageInput.open(path, as_stored)
    if source is None:
        return None
    is_bytes = source.spec().format == oiio.UINT8
    pixels = source.read_image(oiio.UINT8 if is_bytes else oiio.FLOAT)
    source.close()
    if pixels is None:
        return None
    pixels = np.asarray(pixels)
    if pixels.ndim == 2:
        pixels = pixels[:, :, None]
    if pixels.shape[2] == 2:  # grey and alpha
        pixels = pixels[:, :, [0, 0, 0, 1]]
    return np.ascontiguousarray(pixels[::-1, :, :4])


def _as_loaded(pixels: np.ndarray, image: Any) -> np.ndarray:
    """A file's pixels as Blender holds them: bytes with alpha apart, floats scene linear with alpha multiplied in.

    As in Blender, the image's alpha mode says how the file has it.
    """
    space, is_data = image.colorspace_settings.name, image.colorspace_settings.is_data
    is_multiplied = image.alpha_mode == "PREMUL"
    has_alpha = pixels.shape[2] == 4 and not is_data and image.alpha_mode not in ("CHANNEL_PACKED", "NONE")
    if pixels.dtype == np.uint8:
        return np.rint(_divided(pixels / np.float32(255)).clip(0, 1) * 255).astype(np.uint8) if has_alpha and is_multiplied else pixels
    if is_data or (space in _LINEAR and (is_multiplied or not has_alpha)):
        return pixels
    if has_alpha and is_multiplied:
        pixels = _divided(pixels)
    pixels = _linear(pixels, space)
    return _premultiplied(pixels) if has_alpha else pixels


def _linear(pixels: np.ndarray, space: str) -> np.ndarray:
    """Float colours of a named space as scene linear."""
    if space in _LINEAR:
        return pixels
    if space in _SRGB:
        colors = pixels[:, :, :3]
        decoded = np.where(colors <= 0.04045, colors / 12.92, ((np.maximum(colors, 0) + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1
        return np.concatenate([decoded, pixels[:, :, 3:]], axis=2).astype(np.float32)
    converted = _converted(pixels, space)
    if converted is None:
        raise RuntimeError(f"the colour space {space} is not known here")
    return converted


def _divided(pixels: np.ndarray) -> np.ndarray:
    """Float colours that alpha was multiplied into, without it."""
    alpha = pixels[:, :, 3:]
    colors = np.divide(pixels[:, :, :3], alpha, out=pixels[:, :, :3].copy(), where=alpha > 0)
    return np.concatenate([colors, alpha], axis=2)


def prepared(pixels: np.ndarray, image: Any) -> tuple[np.ndarray, int, str]:
    """Pixels in the form that the tracer takes: alpha multiplied in, colours linear or to be decoded as sRGB.

    Parameters
    ----------
    pixels : ndarray
        As `loaded_pixels` gives them.
    image
        For its alpha mode and colour space.

    Returns
    -------
    ndarray
        (height, width, channels), uint8 or float32; without alpha where that is 1 everywhere.
    int
        The transfer.
    str
        A sentence on what could not be kept, or empty.
    """
    space, is_data = image.colorspace_settings.name, image.colorspace_settings.is_data
    if pixels.shape[2] == 4 and (image.alpha_mode == "NONE" or not _any_transparent(pixels)):
        pixels = pixels[:, :, :3]
    if pixels.shape[2] == 2:
        pixels = pixels[:, :, :1]
    transfer, sentence = TRANSFER_LINEAR, ""
    if pixels.dtype == np.uint8 and not is_data:
        if space in _SRGB:
            transfer = TRANSFER_SRGB
        elif space not in _LINEAR:
            converted = _converted(pixels, space)
            if converted is None:
                transfer, sentence = TRANSFER_SRGB, f"The colour space {space} is not known here; sRGB is taken for it."
            else:
                pixels = converted
        if pixels.shape[2] == 4 and image.alpha_mode != "CHANNEL_PACKED":
            pixels = _premultiplied(pixels)
    elif pixels.dtype == np.float32:
        pixels = np.nan_to_num(pixels, nan=0.0, posinf=65504.0, neginf=0.0)
    return np.ascontiguousarray(pixels), transfer, sentence


def _any_transparent(pixels: np.ndarray) -> bool:
    opaque = 255 if pixels.dtype == np.uint8 else 1.0
    return bool((pixels[:, :, 3] != opaque).any())


def _premultiplied(pixels: np.ndarray) -> np.ndarray:
    if pixels.dtype != np.uint8:
        return np.concatenate([pixels[:, :, :3] * pixels[:, :, 3:], pixels[:, :, 3:]], axis=2)
    wide = pixels.astype(np.uint16)
    wide[:, :, :3] = wide[:, :, :3] * wide[:, :, 3:] // 255
    return wide.astype(np.uint8)


def _converted(pixels: np.ndarray, space: str) -> np.ndarray | None:
    """Colours of a named space, uint8 or float32, as scene linear float32, by OpenColorIO; None where that is not possible."""
    try:
        import bpy

        bpy.utils.expose_bundled_modules()
        import PyOpenColorIO as ocio

        path = os.environ.get("OCIO") or os.path.join(bpy.utils.system_resource("DATAFILES"), "colormanagement", "config.ocio")
        processor = ocio.Config.CreateFromFile(path).getProcessor(space, "scene_linear").getDefaultCPUProcessor()
    except (ImportError, AttributeError, Exception):  # OpenColorIO raises its own kind
        return None
    if pixels.dtype == np.uint8:
        pixels = pixels.astype(np.float32) / 255
    colors = np.array(pixels[:, :, :3] if pixels.shape[2] > 1 else pixels.repeat(3, axis=2), np.float32, order="C")
    processor.applyRGB(colors)
    if pixels.shape[2] == 4:
        colors = np.concatenate([colors, pixels[:, :, 3:]], axis=2)
    return colors
