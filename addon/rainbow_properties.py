# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of rainbows: the drops of a material or of the world, and the filter before a camera's lens."""

import math

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from . import rainbow_presets


class OpalRainbowProperties(bpy.types.PropertyGroup):
    """Water drops in the air: with the sun behind the camera they show a rainbow."""

    preset: EnumProperty(
        name="Preset",
        description="Fills in the drops of a known bow; they can be edited afterwards",
        items=rainbow_presets.items(),
        default="CUSTOM",
        update=rainbow_presets.on_preset,
    )
    theory: EnumProperty(
        name="Theory",
        description="How the light that drops scatter is computed",
        items=(
            ("DESCARTES", "Descartes", "Rays alone (1637): solves for the wavelength that each angle shows"),
            ("DESCARTES_SAMPLED", "Descartes, Sampled", "Rays alone: wavelengths weighted by their distance from the bow"),
            ("AIRY", "Airy", "Waves near the bow (1838): supernumerary arcs; right for drops above 0.05 mm"),
            ("MIE", "Lorenz-Mie", "Exact for spheres (1908): fogbow, corona and glory too; slow for large drops"),
            ("DROPLET", "Droplet", "Waves traced through drops of their real shape, after Sadeghi et al. 2012"),
        ),
        default="AIRY",
    )
    radius: FloatProperty(
        name="Radius",
        description="Mean radius of the drops in millimetres: large drops give narrow, bright colours, fog an almost white bow",
        default=0.25,
        min=0.0,
        soft_min=0.001,
        soft_max=5.0,
        precision=3,
        step=1,
    )
    distribution: EnumProperty(
        name="Sizes",
        description="How the drops' radii are distributed about the mean",
        items=(
            ("SINGLE", "One Size", "All drops alike"),
            ("NORMAL", "Normal", "A bell curve"),
            ("LOG_NORMAL", "Log-Normal", "A bell curve of the logarithm, as sprays have"),
            ("GAMMA", "Gamma", "Many small and few large drops, as clouds and showers have"),
            ("TWO_SIZES", "Two Sizes", "Drops of this radius and, with as much area, of 0.45 of it: flattened, they make a twinned bow"),
            ("MARSHALL_PALMER", "Marshall-Palmer", "Rain (1948): numbers fall exponentially with size, whatever the spread"),
        ),
        default="LOG_NORMAL",
    )
    spread: FloatProperty(
        name="Spread",
        description="Width of the distribution of radii relative to the mean; supernumerary arcs need narrow ones",
        default=0.05,
        min=0.0,
        soft_max=1.0,
    )
    extinction: FloatProperty(
        name="Extinction",
        description="How much light the drops take out of a beam in each metre by their discs' area: heavy rain has about 0.001",
        default=0.002,
        min=0.0,
        soft_max=1.0,
        precision=5,
    )
    liquid: EnumProperty(
        name="Liquid",
        description="What the drops are made of",
        items=(
            ("WATER", "Water", "Pure water of the temperature below"),
            ("SEA_WATER", "Sea Water", "Water with salt: its bow is about a degree smaller"),
            ("CUSTOM", "Other", "A liquid or glass of a given index: glass beads of 1.51 have a bow of 22 degrees"),
        ),
        default="WATER",
    )
    temperature: FloatProperty(
        name="Temperature",
        description="Of the water in degrees Celsius: warm drops have a slightly larger bow",
        default=20.0,
        min=0.0,
        max=100.0,
        precision=1,
    )
    salinity: FloatProperty(
        name="Salinity",
        description="Salt in parts per thousand of the sea water's mass; the oceans have 35",
        default=35.0,
        min=0.0,
        max=300.0,
        precision=1,
    )
    index: FloatProperty(
        name="Index",
        description="Index of refraction of the other liquid relative to air, at the sodium line (589.3 nm)",
        default=1.51,
        min=1.01,
        max=2.4,
        precision=4,
    )
    index_dispersion: FloatProperty(
        name="Dispersion",
        description="How much the other liquid splits colours: Cauchy's second coefficient in µm²; water has 0.003, crown glass 0.004",
        default=0.0042,
        min=0.0,
        max=0.1,
        precision=5,
    )
    diffraction: BoolProperty(
        name="Forward Lobe",
        description="Keeps the light that drops diffract forward, half of all: it makes the corona close round the sun and much noise. "
        "Without it that light goes straight on",
        default=False,
    )
    flattening: FloatProperty(
        name="Flattening",
        description="How far drops take the shape that falling gives them: 0 are spheres, 1 is full; used by the theory Droplet alone",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    polarization: BoolProperty(
        name="Polarization",
        description="The bow's light is polarised along the bow, as a camera with a polarising filter sees it",
        default=True,
    )


class OpalCameraProperties(bpy.types.PropertyGroup):
    """What stands before a camera's lens."""

    polarizer: BoolProperty(
        name="Polarizing Filter",
        description="A linear polarising filter before the lens; it takes half of unpolarised light and can make a rainbow vanish",
        default=False,
    )
    polarizer_angle: FloatProperty(
        name="Angle",
        description="Direction of the light's field that passes, from the camera's horizontal: 0 keeps the top of a bow, 90 degrees "
        "takes it away",
        default=0.0,
        soft_min=-math.pi,
        soft_max=math.pi,
        subtype="ANGLE",
    )


CLASSES = (OpalRainbowProperties,)
CAMERA_CLASSES = (OpalCameraProperties,)
