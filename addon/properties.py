# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything Opal saves in a file: `scene.opal`, `view_layer.opal` and `material.opal`.

Lengths are Blender units, which the interface shows by the Unit Scale (`units`), wavelengths nm, angles radians. The names are public: scripts and saved files depend on them.
"""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from . import gem_properties, media_properties, rainbow_properties, twin_updates


class OpalSceneProperties(bpy.types.PropertyGroup):
    """How a scene is rendered."""

    passes: IntProperty(
        name="Passes",
        description="How many times the whole picture is rendered anew, with new photons; the passes are averaged, so more "
        "passes give less noise and smaller blur in caustics",
        default=64,
        min=1,
        soft_max=4096,
    )
    samples_per_pass: IntProperty(
        name="Samples per Pass",
        description="How many camera paths each pixel gets in one pass",
        default=4,
        min=1,
        soft_max=64,
        max=4096,
    )
    use_adaptive_sampling: BoolProperty(
        name="Adaptive Sampling",
        description="Look before the first pass where the noise will be: more camera paths go there, and photons and paths are weighed "
        "against each other. Samples and photons per pass then say how much work a pass is, not how it is shared out",
        default=True,
    )
    photons_per_pass: IntProperty(
        name="Photons per Pass",
        description="How many photons each pass sends out from lamps, emissive meshes and the world; 0 leaves all light to camera paths",
        default=200_000,
        min=0,
        soft_max=5_000_000,
        max=100_000_000,
    )
    photons_carry: EnumProperty(
        name="Photons Carry",
        description="Which light the photons bring; camera paths bring the rest. All choices converge to the same picture",
        items=(
            ("CAUSTICS", "Caustics", "Light that reached a diffuse surface or a medium through a gem or glass or off a mirror"),
            ("INDIRECT", "Indirect", "All light but that which comes straight from its source"),
            ("ALL", "All", "All light, as in Jensen's photon mapping"),
        ),
        default="CAUSTICS",
    )
    gather: IntProperty(
        name="Gather",
        description="How many photons one estimate of light uses at most",
        default=64,
        min=1,
        soft_max=500,
        max=100_000,
    )
    radius: FloatProperty(
        name="Radius",
        description="Radius within which photons count in the first pass; 0 chooses four pixels' width at the distance of the gems",
        default=0.0,
        min=0.0,
        soft_max=1.0,
        precision=5,
        subtype="DISTANCE",
    )
    radius_shrink: FloatProperty(
        name="Radius Shrink",
        description="How slowly the radius shrinks from pass to pass: 1 keeps it and its blur, smaller values trade blur for noise. "
        "Two thirds is best for surfaces (Knaus and Zwicker 2011)",
        default=2.0 / 3.0,
        min=0.1,
        max=1.0,
        subtype="FACTOR",
    )
    volume_estimate: EnumProperty(
        name="Volume Estimate",
        description="How light that photons bring to media is found. All three converge to the same picture",
        items=(
            ("POINTS", "Points", "Photons in spheres at steps along each ray (Jensen and Christensen 1998)"),
            ("BEAM_RADIANCE", "Beam Radiance", "Photons as discs that each ray pierces, without steps (Jarosz 2008)"),
            ("BEAMS", "Beams", "Whole flights of photons as beams that each ray crosses: least noise in thin media (Jarosz 2011)"),
        ),
        default="BEAMS",
    )
    volume_photons_per_pass: IntProperty(
        name="Volume Photons",
        description="How many photons each pass sends out for media alone; 0 lets the same photons serve surfaces and media",
        default=0,
        min=0,
        soft_max=5_000_000,
        max=100_000_000,
    )
    volume_radius: FloatProperty(
        name="Volume Radius",
        description="Radius within which photons in media count in the first pass; 0 takes Radius, and if that is 0 too, chooses by the photons",
        default=0.0,
        min=0.0,
        soft_max=1.0,
        precision=5,
        subtype="DISTANCE",
    )
    march_steps: IntProperty(
        name="March Steps",
        description="Places along each ray where Points looks for photons",
        default=16,
        min=1,
        soft_max=64,
        max=256,
    )
    march_tolerance: FloatProperty(
        name="March Tolerance",
        description="A step of Points is halved where its light differs from its neighbour's by more than this share; 0 halves none",
        default=0.5,
        min=0.0,
        soft_max=1.0,
        max=100.0,
        subtype="FACTOR",
    )
    max_depth: IntProperty(
        name="Max Depth",
        description="After how many bounces a path ends at the latest; dim paths end before, by chance and without darkening",
        default=64,
        min=1,
        max=1024,
    )
    transparent_depth: IntProperty(
        name="Transparent Depth",
        description="How many transparent surfaces one ray passes at most",
        default=64,
        min=0,
        max=1024,
    )
    wavelengths: FloatVectorProperty(
        name="Wavelengths",
        description="First and last wavelength of the light rendered, in nanometres; the eye sees little outside 380 to 730",
        size=2,
        default=(360.0, 830.0),
        min=360.0,
        max=830.0,
        precision=0,
        step=500,
    )
    denoise: BoolProperty(
        name="Denoise",
        description="Removes the remaining noise after the last pass by Intel Open Image Denoise, guided by albedo and normals",
        default=False,
    )
    seed: IntProperty(
        name="Seed",
        description="The same seed gives the same noise on any number of threads; another seed gives an independent render",
        default=0,
        min=0,
    )
    seed_per_frame: BoolProperty(
        name="Vary Seed",
        description="Every frame gets noise and photons of its own, derived from the seed; off, noise stands still in an animation",
        default=False,
    )
    pass_first: IntProperty(
        name="First Pass",
        description="Number of the first pass to render: passes 9 to 16 are rendered with First Pass 9 and 8 passes. Machines that "
        "render different passes of one picture are merged by opal.merge",
        default=1,
        min=1,
        max=1_000_000,
    )
    use_film_file: BoolProperty(
        name="Film File",
        description="Writes the film's exact sums beside the picture, to be merged with other passes of the same picture",
        default=False,
    )
    film_path: StringProperty(
        name="File",
        description="Where the film is written; # stands for a digit of the frame number. The passes are added to the name",
        default="//film_####.npz",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    time_limit: FloatProperty(
        name="Time Limit",
        description="After how many seconds the render ends, to the nearest whole pass; 0 sets no limit",
        default=0.0,
        min=0.0,
        soft_max=36_000.0,
        unit="TIME_ABSOLUTE",
    )
    noise_threshold: FloatProperty(
        name="Noise Threshold",
        description="The render ends once the estimated error of brightness, averaged over the picture and relative to it, falls "
        "below this; 0 renders all passes",
        default=0.0,
        min=0.0,
        soft_max=0.2,
        max=1.0,
        precision=4,
    )
    film_exposure: FloatProperty(
        name="Exposure",
        description="Factor on the brightness of every pixel",
        default=1.0,
        min=0.0,
        soft_max=10.0,
    )
    pixel_filter: EnumProperty(
        name="Pixel Filter",
        description="How neighbouring samples are weighted into a pixel",
        items=(
            ("BOX", "Box", "The pixel alone, all of it alike"),
            ("GAUSSIAN", "Gaussian", "A bell curve"),
            ("BLACKMAN_HARRIS", "Blackman-Harris", "A bell curve that ends at its width; sharper, and the default of Cycles"),
        ),
        default="BLACKMAN_HARRIS",
    )
    filter_width: FloatProperty(
        name="Width",
        description="Width of the pixel filter in pixels",
        default=1.5,
        min=0.01,
        max=10.0,
        subtype="PIXEL",
    )
    clamp_direct: FloatProperty(
        name="Clamp Direct",
        description="Largest value that one sample of direct light may add to a pixel; 0 does not clamp, which alone is right",
        default=0.0,
        min=0.0,
        soft_max=100.0,
    )
    clamp_indirect: FloatProperty(
        name="Clamp Indirect",
        description="Largest value that one sample of indirect light may add to a pixel; 0 does not clamp, which alone is right",
        default=0.0,
        min=0.0,
        soft_max=100.0,
    )
    use_spectral_output: BoolProperty(
        name="Spectral EXR",
        description="Writes the radiance at each wavelength beside the picture, as a spectral OpenEXR file (layout of Fichet et al. 2021)",
        default=False,
    )
    spectral_path: StringProperty(
        name="File",
        description="Where the spectral file is written; # stands for a digit of the frame number",
        default="//spectral_####.exr",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    spectral_bins: IntProperty(
        name="Bins",
        description="How many equal parts the range of wavelengths is divided into for the spectral file",
        default=47,
        min=1,
        max=1000,
    )


class OpalViewLayerProperties(bpy.types.PropertyGroup):
    """Render passes that Blender has no option for."""

    use_pass_albedo: BoolProperty(
        name="Albedo", description="Keeps the share of white light that surfaces send back, for denoisers and compositing"
    )
    use_pass_direct: BoolProperty(name="Direct", description="Keeps light that met one surface between its source and the camera")
    use_pass_indirect: BoolProperty(name="Indirect", description="Keeps light that met more than one surface, without caustics")
    use_pass_caustics: BoolProperty(
        name="Caustics", description="Keeps light that reached a diffuse surface through a gem or glass or off a mirror"
    )
    use_pass_medium: BoolProperty(
        name="Medium", description="Keeps light that a medium or a rainbow scattered or gave off towards the camera"
    )


class OpalMaterialProperties(bpy.types.PropertyGroup):
    """What Opal makes of a material."""

    kind: EnumProperty(
        name="Kind",
        description="What the material is",
        items=(
            ("SURFACE", "Surface", "What the material's node tree says"),
            ("GEM", "Gem", "A transparent body that splits and absorbs light: a stone, glass or a liquid"),
            ("MEDIUM", "Medium", "Fills a closed body with fog, smoke or milk"),
            ("RAINBOW", "Rainbow", "Fills a closed body with water drops, which show a bow opposite the sun"),
        ),
        default="SURFACE",
    )
    gem: PointerProperty(type=gem_properties.OpalGemProperties, name="Gem")
    use_medium: BoolProperty(
        name="Clouded",
        description="Fills the gem with a medium: milky opal, clouded quartz",
        default=False,
    )
    medium: PointerProperty(type=media_properties.OpalMediumProperties, name="Medium")
    rainbow: PointerProperty(type=rainbow_properties.OpalRainbowProperties, name="Rainbow")


CLASSES = (
    OpalSceneProperties,
    OpalViewLayerProperties,
    *gem_properties.CLASSES,
    *media_properties.CLASSES,
    *rainbow_properties.CAMERA_CLASSES,
    OpalMaterialProperties,
)
_OWNERS = (
    (bpy.types.Scene, OpalSceneProperties),
    (bpy.types.ViewLayer, OpalViewLayerProperties),
    (bpy.types.Material, OpalMaterialProperties),
    (bpy.types.World, media_properties.OpalWorldProperties),
    (bpy.types.Camera, rainbow_properties.OpalCameraProperties),
)


# What a twin shows (twins/): every setting of these updates it.
_SHOWN = (*gem_properties.CLASSES, *media_properties.CLASSES, OpalMaterialProperties)


def register() -> None:
    for cls in _SHOWN:
        twin_updates.attach(cls)
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for owner, group in _OWNERS:
        owner.opal = PointerProperty(type=group, name="Opal", description="Settings of the render engine Opal")


def unregister() -> None:
    for owner, _ in _OWNERS:
        del owner.opal
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
