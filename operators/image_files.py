# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of NumPy as Blender images and as PNG files. Pictures are linear Rec.709, (height, width, 3), rows from the top."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

# Custom property of texts that Opal made.
_KEY = "opal_text"


def to_image(name: str, pixels: Any) -> bpy.types.Image:
    """Opal's image of this name, made or filled anew, with these pixels packed into it; a stranger's image of that name is left alone."""
    from . import float_images

    image = float_images.put(name, pixels[::-1])
    image.colorspace_settings.name = "Linear Rec.709"
    return image


def to_text(name: str, content: str) -> bpy.types.Text:
    """Opal's text of this name, made or written anew; a stranger's text of that name is left alone."""
    text = next((t for t in bpy.data.texts if t.library is None and t.get(_KEY) == name), None)
    if text is None:
        text = bpy.data.texts.new(name)
        text[_KEY] = name
    text.from_string(content)
    return text


def save_png(path: Path, pixels: Any) -> None:
    """Writes a PNG in sRGB, without the scene's view transform; folders are made.

    Raises
    ------
    OSError, RuntimeError
        If it cannot be written.
    """
    import numpy as np

    path.parent.mkdir(parents=True, exist_ok=True)
    height, width = pixels.shape[:2]
    clipped = np.clip(pixels, 0, 1)
    image = bpy.data.images.new(path.stem, width, height, alpha=False)
    try:
        flat = np.ones((height, width, 4), np.float32)
        flat[..., :3] = np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)[::-1]  # IEC 61966-2-1
        image.pixels.foreach_set(flat.reshape(-1))
        image.file_format = "PNG"
        image.filepath_raw = str(path)
        image.save()
    finally:
        bpy.data.images.remove(image)
