# SPDX-License-Identifier: GPL-3.0-or-later
"""Light panels: the spectrum of a lamp."""

from __future__ import annotations

from typing import Any

import bpy

from . import curve_icons
from .panels import OpalPanel


class OPAL_LIGHT_PT_spectrum(OpalPanel):
    """What a lamp's light is made of."""

    bl_label = "Spectrum"
    bl_context = "data"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.light is not None

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        light = context.light
        layout.prop(light.opal, "spectrum")
        if light.opal.spectrum == "BLACKBODY":
            layout.prop(light.opal, "temperature")
        elif light.opal.spectrum == "LASER":
            layout.prop(light.opal, "laser_wavelength", text="Wavelength (nm)")
        if light.opal.spectrum != "COLOR" and getattr(light, "use_temperature", False):
            layout.label(text="The spectrum takes the place of the lamp's temperature", icon="INFO")
        if light.opal.spectrum != "COLOR":
            self._draw_curve(light)

    def _draw_curve(self, light: Any) -> None:
        from opal_kernels.charts.wavelength_curve import power_chart

        from .translate.lights import lamp_spectrum

        curve_icons.draw(self.layout, power_chart(lamp_spectrum(light)))


def register() -> None:
    bpy.utils.register_class(OPAL_LIGHT_PT_spectrum)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_LIGHT_PT_spectrum)
