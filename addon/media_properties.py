# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of what fills a body or the world instead of covering it; rainbows have a file of their own."""

from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty, StringProperty

from . import media_presets, rainbow_properties, units


class OpalMediumProperties(bpy.types.PropertyGroup):
    """A participating medium: it takes light away, turns it and may glow."""

    preset: EnumProperty(
        name="Preset",
        description="Fills in the numbers of a known medium; they can be edited afterwards",
        items=media_presets.items(),
        default="CUSTOM",
        update=media_presets.on_preset,
    )
    extinction: FloatProperty(
        name="Extinction",
        description="How much light the medium takes out of a beam in each metre, by absorption and scattering together",
        default=1.0,
        min=0.0,
        soft_max=100.0,
        precision=4,
    )
    extinction_color: FloatVectorProperty(
        name="Extinction Color",
        description="How the extinction depends on colour: a factor a channel. White takes all colours alike; blue lets red pass",
        size=3,
        default=(1.0, 1.0, 1.0),
        min=0.0,
        soft_max=1.0,
        subtype="COLOR",
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
    density: EnumProperty(
        name="Density",
        description="Where the medium is dense and where it is thin; extinction and emission are multiplied by it",
        items=(
            ("HOMOGENEOUS", "Homogeneous", "The same everywhere"),
            ("NOISE", "Noise", "Clouds of procedural noise, in the object's own space"),
            ("GRID", "Grid", "A grid of voxels: of an OpenVDB file, of a volume that nodes generate, or of a smoke domain"),
        ),
        default="HOMOGENEOUS",
    )
    grid: StringProperty(
        name="Grid",
        description="Name of the grid that says the density; a missing grid is named in the report and renders as nothing",
        default="density",
    )
    noise_scale: FloatProperty(
        name="Size",
        description="Size of the largest lumps, in the object's own space",
        default=0.5,
        min=1e-4,
        soft_max=10.0,
        subtype="DISTANCE",
    )
    noise_detail: FloatProperty(
        name="Detail",
        description="How many octaves of finer lumps are added, each half as large and half as strong",
        default=3.0,
        min=0.0,
        max=15.0,
    )
    noise_contrast: FloatProperty(
        name="Contrast",
        description="0 is even, at half of the extinction; higher values part the medium into empty space and full density",
        default=2.0,
        min=0.0,
        soft_max=10.0,
    )
    noise_seed: IntProperty(
        name="Seed",
        description="Another seed gives other clouds",
        default=0,
        min=0,
    )
    emission_source: EnumProperty(
        name="Emission",
        description="What the medium's own light looks like",
        items=(
            ("COLOR", "Color", "A colour of the artist's choice"),
            ("BLACKBODY", "Blackbody", "The light of a glowing body of some temperature"),
        ),
        default="COLOR",
    )
    emission_temperature: FloatProperty(
        name="Temperature",
        description="Temperature whose light a blackbody sends",
        default=1500.0,
        min=500.0,
        max=40_000.0,
        subtype="TEMPERATURE",
    )
    emission_grid: StringProperty(
        name="Emission Grid",
        description="Name of a grid that the emission is multiplied by, such as flame; empty: the density",
        default="",
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


# What rain or haze on the world begins with, m and 1/m: of a shower cloud's base, and so thin that the sun comes through (a half of it from overhead).
_WORLD_HEIGHT, _WORLD_EXTINCTION = 1000.0, 0.0005


def _on_world_kind(world: Any, context: Any) -> None:
    """A world that is filled for the first time lets the sun through: defaults of a body are a wall without end there."""
    filling = {"MEDIUM": world.medium, "RAINBOW": world.rainbow}.get(world.kind)
    if filling is None:
        return
    if not world.is_property_set("scale_height"):
        world.scale_height = _WORLD_HEIGHT / units.here(context)
    if not filling.is_property_set("extinction"):
        filling.extinction = _WORLD_EXTINCTION


class OpalWorldProperties(bpy.types.PropertyGroup):
    """What fills the world: nothing, a medium or rain."""

    kind: EnumProperty(
        name="Kind",
        description="What fills the whole world, outside of every object",
        items=(
            ("NONE", "None", "Empty space, or what the Volume socket of the world's node tree says"),
            ("MEDIUM", "Medium", "Haze or fog everywhere"),
            ("RAINBOW", "Rainbow", "Water drops everywhere: rain to the horizon"),
        ),
        default="NONE",
        update=_on_world_kind,
    )
    medium: PointerProperty(type=OpalMediumProperties, name="Medium")
    rainbow: PointerProperty(type=rainbow_properties.OpalRainbowProperties, name="Rainbow")
    scale_height: FloatProperty(
        name="Scale Height",
        description="Height over which the density falls to 37 %; 0 keeps it to infinity, where no sun and no sky shines through",
        default=0.0,
        min=0.0,
        soft_max=10_000.0,
        subtype="DISTANCE",
    )
    base_height: FloatProperty(
        name="Base Height",
        description="Height from which on the density falls; below it stays as it is, down to the ground under everything in the scene",
        default=0.0,
        subtype="DISTANCE",
    )


CLASSES = (OpalMediumProperties, *rainbow_properties.CLASSES, OpalWorldProperties)
