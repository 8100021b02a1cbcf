# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of a gem; `presets` holds what happens when they are edited."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from . import presets

# Diamond, which a new gem starts as: Peter 1923 as in the species table, and a Cauchy formula through its F and C lines.
_DIAMOND_B, _DIAMOND_C = (4.3356, 0.3306, 0.0), (0.011236, 0.030625, 0.0)
_DIAMOND_CAUCHY = (2.37837, 0.013422)


class OpalGemProperties(bpy.types.PropertyGroup):
    """A gem: a boundary whose index of refraction depends on wavelength, round an interior that absorbs."""

    species: EnumProperty(
        name="Species",
        description="The stone; choosing one fills the settings below, editing those makes it Custom",
        items=presets.species_items,
        default=presets.species_number("DIAMOND"),
        update=presets.on_species,
    )
    dispersion: EnumProperty(
        name="Dispersion",
        description="Formula of the index of refraction against wavelength",
        items=(
            ("CAUCHY", "Cauchy", "n = B + C / λ²: enough for most stones"),
            ("SELLMEIER", "Sellmeier", "n² = 1 + Σ B λ² / (λ² - C): what glass makers and tables give"),
        ),
        default="SELLMEIER",
        update=presets.on_index,
    )
    cauchy_b: FloatProperty(
        name="B",
        description="Cauchy's B: the index of refraction at very long wavelengths",
        default=_DIAMOND_CAUCHY[0],
        min=0.0,
        soft_min=1.0,
        soft_max=3.0,
        precision=5,
        step=1,
        update=presets.on_index,
    )
    cauchy_c: FloatProperty(
        name="C",
        description="Cauchy's C in square micrometres: how strongly the index rises towards violet",
        default=_DIAMOND_CAUCHY[1],
        soft_min=0.0,
        soft_max=0.1,
        precision=6,
        step=0.1,
        update=presets.on_index,
    )
    sellmeier_b: FloatVectorProperty(
        name="B",
        description="Sellmeier's B: the strengths of three resonances",
        size=3,
        default=_DIAMOND_B,
        precision=6,
        update=presets.on_index,
    )
    sellmeier_c: FloatVectorProperty(
        name="C",
        description="Sellmeier's C in square micrometres: the squared wavelengths of three resonances",
        size=3,
        default=_DIAMOND_C,
        precision=7,
        update=presets.on_index,
    )
    fresnel: EnumProperty(
        name="Fresnel",
        description="How much the boundary reflects",
        items=(
            ("EXACT", "Exact", "Fresnel's equations"),
            ("SCHLICK", "Schlick", "Schlick's approximation, taken on the side of the lower index"),
        ),
        default="EXACT",
    )
    absorption_color: FloatVectorProperty(
        name="Absorption Color",
        description="What white light becomes along the absorption depth",
        size=3,
        default=(1.0, 1.0, 1.0),
        min=0.0,
        max=1.0,
        subtype="COLOR",
        update=presets.on_absorption,
    )
    absorption_depth: FloatProperty(
        name="Absorption Depth",
        description="Length of stone after which white light has the absorption color",
        default=0.005,
        min=1e-6,
        soft_max=1.0,
        precision=4,
        subtype="DISTANCE",
        update=presets.on_absorption,
    )
    roughness: FloatProperty(
        name="Roughness",
        description="Roughness of the surface: 0 is polished, 1 is fully frosted",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    priority: IntProperty(
        name="Priority",
        description="Where two stones or liquids overlap, the one of higher priority fills the place",
        default=0,
        min=-100,
        max=100,
    )
    refusal: StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    last_good: FloatVectorProperty(size=8, default=(*_DIAMOND_CAUCHY, *_DIAMOND_B, *_DIAMOND_C), options={"HIDDEN"})
    last_good_dispersion: StringProperty(default="SELLMEIER", options={"HIDDEN"})


CLASSES = (OpalGemProperties,)
