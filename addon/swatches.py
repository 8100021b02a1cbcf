# SPDX-License-Identifier: GPL-3.0-or-later
"""Swatches of presets as preview icons, made when a list is first opened."""

from __future__ import annotations

from typing import Any

_previews: Any = None


def icon(kind: str, name: str) -> int:
    """The icon number of a preset's swatch."""
    global _previews
    import bpy.utils.previews

    if _previews is None:
        _previews = bpy.utils.previews.new()
    key = f"{kind} {name}"
    if key not in _previews:
        pixels = picture(kind, name)
        preview = _previews.new(key)
        preview.icon_size = preview.image_size = pixels.shape[1::-1]
        flat = pixels.reshape(-1)
        preview.icon_pixels_float.foreach_set(flat)
        preview.image_pixels_float.foreach_set(flat)
    return _previews[key].icon_id


def picture(kind: str, name: str) -> Any:
    """The swatch, (32, 32, 4) display values, rows from the bottom up."""
    import numpy as np
    from opal_kernels.charts import swatches

    if kind == "GEM":
        from opal_kernels import gem as gems

        return swatches.gem(gems.settings_of_species(name, 0.005).absorption_color)
    if kind == "MEDIUM":
        from .media_presets import PRESETS

        row = PRESETS[name]
        return swatches.flat(swatches.diffuse_reflectance(np.array(row.albedo), row.anisotropy))
    from .bow_swatches import COLORS

    colours = np.frombuffer(bytes.fromhex(COLORS[name]), np.uint8).reshape(-1, 3) / 255.0
    return swatches.strip(colours)


def clear() -> None:
    """Frees every picture."""
    global _previews
    if _previews is not None:
        import bpy.utils.previews

        bpy.utils.previews.remove(_previews)
        _previews = None
