# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of a gem; `presets` holds what happens when they are edited."""

import bpy
from bpy.props import CollectionProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from . import presets

# Diamond, which a new gem starts as: Peter 1923 as in the species table, and a Cauchy formula through its F and C lines.
_DIAMOND_B, _DIAMOND_C = (4.3356, 0.3306, 0.0), (0.011236, 0.030625, 0.0)
_DIAMOND_CAUCHY = (2.37837, 0.013422)


class OpalAbsorptionSample(bpy.types.PropertyGroup):
    """One sample of a measured absorption."""

    wavelength: FloatProperty(
        name="Wavelength",
        description="Wavelength of the sample in nanometres",
        default=550.0,
        precision=1,
        update=presets.on_sample,
    )
    absorption: FloatProperty(
        name="Absorption",
        description="Absorption at this wavelength per millimetre: light falls to exp(-absorption × millimetres)",
        default=0.0,
        precision=4,
        update=presets.on_sample,
    )
    last_good: FloatVectorProperty(size=2, default=(550.0, 0.0), options={"HIDDEN"})


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
            ("CAUCHY", "Cauchy", "Cauchy's n = B + C / λ²: enough for most stones"),
            ("SELLMEIER", "Sellmeier", "Sellmeier's n² = 1 + Σ B λ² / (λ² - C): what glass makers and tables give"),
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
            ("EXACT", "Exact", "Fresnel's equations as they are, at every angle and wavelength"),
            ("SCHLICK", "Schlick", "Schlick's approximation, taken on the side of the lower index"),
        ),
        default="EXACT",
    )
    absorption_source: EnumProperty(
        name="Absorption",
        description="What says how the stone absorbs light",
        items=(
            ("COLOR", "Color", "A color that white light takes on along a depth"),
            ("CURVE", "Curve", "Absorption against wavelength: the species' own, or one imported from a measurement"),
        ),
        default="COLOR",
        update=presets.on_absorption_source,
    )
    absorption_color: FloatVectorProperty(
        name="Absorption Color",
        description="What white light becomes along the absorption depth",
        size=3,
        default=(1.0, 1.0, 1.0),
        soft_min=0.0,
        soft_max=1.0,
        subtype="COLOR",
        update=presets.on_absorption,
    )
    absorption_depth: FloatProperty(
        name="Absorption Depth",
        description="Length of stone after which white light has the absorption color",
        default=0.005,
        soft_min=1e-6,
        soft_max=1.0,
        precision=4,
        subtype="DISTANCE",
        update=presets.on_absorption,
    )
    absorption_curve: CollectionProperty(
        type=OpalAbsorptionSample,
        name="Absorption Curve",
        description="Samples of absorption against wavelength, straight between them and level outside",
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
    last_good_absorption: FloatVectorProperty(size=4, default=(1.0, 1.0, 1.0, 0.005), options={"HIDDEN"})
    last_good_source: StringProperty(default="", options={"HIDDEN"})  # empty in files from before it was kept


CLASSES = (OpalAbsorptionSample, OpalGemProperties)
