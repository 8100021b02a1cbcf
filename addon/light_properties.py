# SPDX-License-Identifier: GPL-3.0-or-later
"""`light.opal`: the spectrum of a lamp."""

from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty, PointerProperty


def _tag(settings: Any, _context: Any) -> None:
    """Tells Blender that the lamp is another, also where a script set it, so that a rendered view follows."""
    settings.id_data.update_tag()


class OpalLightProperties(bpy.types.PropertyGroup):
    """What a lamp's light is made of; its brightness stays that of a white lamp of the same power."""

    spectrum: EnumProperty(
        name="Spectrum",
        description="What the lamp's light is made of. A lamp with a spectrum is as bright as a white lamp of the same power; "
        "the lamp's color filters it",
        items=(
            ("COLOR", "Color", "Daylight filtered by the lamp's color, or the black body of its temperature, as in Cycles"),
            ("D65", "Daylight (D65)", "CIE standard illuminant D65, noon daylight of 6504 K"),
            ("BLACKBODY", "Black Body", "A glowing body of some temperature: candles, filaments, the sun"),
            ("A", "Incandescent (A)", "CIE standard illuminant A, a filament of 2856 K"),
            ("F2", "Fluorescent (F2)", "CIE F2, a cool white fluorescent tube"),
            ("F11", "Fluorescent, Three Bands (F11)", "CIE F11, a tube whose light comes in narrow bands"),
            ("LED", "White LED", "A measured phosphor-converted white LED"),
            ("SODIUM", "Sodium", "The yellow doublet of a low-pressure sodium lamp, 589.0 and 589.6 nm; no stone has fire in it"),
            ("LASER", "Laser", "A single wavelength"),
        ),
        default="COLOR",
        update=_tag,
    )
    temperature: FloatProperty(
        name="Temperature",
        description="Temperature of the black body in kelvin: a candle has 1900, a filament 2800, the sun 5800",
        default=2800.0,
        min=800.0,
        soft_max=12_000.0,
        max=40_000.0,
        precision=0,
        step=10_000,
        update=_tag,
    )
    laser_wavelength: FloatProperty(
        name="Wavelength",
        description="Wavelength of the laser in nanometres",
        default=532.0,
        min=380.0,
        max=780.0,
        precision=1,
        step=100,
        update=_tag,
    )


def register() -> None:
    bpy.utils.register_class(OpalLightProperties)
    bpy.types.Light.opal = PointerProperty(type=OpalLightProperties, name="Opal", description="Settings of the render engine Opal")


def unregister() -> None:
    del bpy.types.Light.opal
    bpy.utils.unregister_class(OpalLightProperties)
