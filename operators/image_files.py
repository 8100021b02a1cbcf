# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of NumPy as Blender images and as PNG files. Pictures are linear Rec.709, (height, width, 3), rows from the top."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy


def to_image(name: str, pixels: Any) -> bpy.types.Image:
    """The image of this name in the file, made or replaced, with these pixels packed into it."""
    import numpy as np

    height, width = pixels.shape[:2]
    image = bpy.data.images.get(name)
    if image is None or tuple(image.size) != (width, height) or not image.is_float:
        if image is not None:
            bpy.data.images.remove(image)
        image = bpy.data.images.new(name, width, height, alpha=False, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709"
    flat = np.ones((height, width, 4), np.float32)
    flat[..., :3] = pixels[::-1]
    image.pixels.foreach_set(flat.reshape(-1))
    image.update()
    image.pack()
    return image


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
