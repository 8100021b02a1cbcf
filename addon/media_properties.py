# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of materials that fill a body instead of covering it: media and rainbows."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty


class OpalMediumProperties(bpy.types.PropertyGroup):
    """A participating medium: it takes light away, turns it and may glow."""

    extinction: FloatProperty(
        name="Extinction",
        description="How much light the medium takes out of a beam in each metre, by absorption and scattering together",
        default=1.0,
        min=0.0,
        soft_max=100.0,
        precision=4,
    )
    albedo: FloatVectorProperty(
        name="Albedo",
        description="Which part of the light taken is scattered on, by colour; the rest is absorbed",
        size=3,
        default=(0.9, 0.9, 0.9),
        min=0.0,
        max=1.0,
        subtype="COLOR",
    )
    phase: EnumProperty(
        name="Phase Function",
        description="Into which directions light is scattered",
        items=(
            ("ISOTROPIC", "Isotropic", "Alike into every direction"),
            ("HENYEY_GREENSTEIN", "Henyey-Greenstein", "Forward or backward, as the anisotropy says: fog, smoke, milk"),
            ("RAYLEIGH", "Rayleigh", "As particles much smaller than a wavelength do: clear air"),
        ),
        default="ISOTROPIC",
    )
    anisotropy: FloatProperty(
        name="Anisotropy",
        description="Mean cosine of the angle by which light is turned: 0 is even, near 1 is straight on, below 0 is back",
        default=0.0,
        min=-0.999,
        max=0.999,
    )
    emission_color: FloatVectorProperty(
        name="Emission Color",
        description="Colour of the medium's own light",
        size=3,
        default=(1.0, 1.0, 1.0),
        min=0.0,
        soft_max=1.0,
        subtype="COLOR",
    )
    emission_strength: FloatProperty(
        name="Emission Strength",
        description="Radiance that each metre of the medium adds by itself",
        default=0.0,
        min=0.0,
        soft_max=100.0,
    )


class OpalRainbowProperties(bpy.types.PropertyGroup):
    """Water drops in the air: with the sun behind the camera they show a rainbow."""

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
        min=0.001,
        max=5.0,
        precision=3,
        step=1,
    )
    spread: FloatProperty(
        name="Spread",
        description="Width of the distribution of radii relative to the mean; supernumerary arcs need narrow ones",
        default=0.05,
        min=0.0,
        max=1.0,
    )
    extinction: FloatProperty(
        name="Extinction",
        description="How much light the drops take out of a beam in each metre: heavy rain has about 0.001",
        default=0.002,
        min=0.0,
        soft_max=1.0,
        precision=5,
    )
    flattening: FloatProperty(
        name="Flattening",
        description="How far drops take the shape that falling gives them: 0 are spheres, 1 is full; used by the theory Droplet alone",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )


CLASSES = (OpalMediumProperties, OpalRainbowProperties)
