# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of curves for panels, kept as preview icons: one a curve, made when it is first drawn."""

from __future__ import annotations

from typing import Any

# Dragging a number makes a picture a step: beyond this many the old ones go.
_MOST = 48
_previews: Any = None


def icon(chart: Any) -> int:
    """The icon number of an `opal_kernels.charts.wavelength_curve.Chart`; its picture is made on first use."""
    global _previews
    import bpy.utils.previews
    from opal_kernels.charts import wavelength_curve

    key = f"{hash((chart.values.tobytes(), chart.low, chart.high)):x}"
    if _previews is not None and len(_previews) >= _MOST and key not in _previews:
        clear()
    if _previews is None:
        _previews = bpy.utils.previews.new()
    if key not in _previews:
        pixels = wavelength_curve.picture(chart)
        preview = _previews.new(key)
        preview.image_size = pixels.shape[1::-1]
        preview.image_pixels_float.foreach_set(pixels.reshape(-1))
    return _previews[key].icon_id


def draw(layout: Any, chart: Any) -> None:
    """A small picture of a curve in a panel, and the range that it shows; nothing for None."""
    if chart is None:
        return
    layout.template_icon(icon_value=icon(chart), scale=5.0)
    row = layout.row()
    row.alignment = "CENTER"
    row.label(text=chart.caption)


def clear() -> None:
    """Frees every picture."""
    global _previews
    if _previews is not None:
        import bpy.utils.previews

        bpy.utils.previews.remove(_previews)
        _previews = None
