# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene is made of, as plain values: lights, camera, world, gems, programs and render settings.

The fields are those of the structures in ``include/opal.h``, in their order and with their names. Lengths are metres,
wavelengths nanometres, angles radians, powers watts, colours linear Rec.709; transforms are 3 x 4 matrices, object to world.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntEnum, IntFlag

import numpy as np

SPECTRUM_FIRST_NM = 360
SPECTRUM_SIZE = 471


def wavelengths() -> np.ndarray:
    """The wavelengths of every spectral table: 360, 361, ... 830 nm, float64 of shape (471,)."""
    return np.arange(SPECTRUM_FIRST_NM, SPECTRUM_FIRST_NM + SPECTRUM_SIZE, dtype=np.float64)


class Ray(IntFlag):
    """Kinds of ray, for visibility masks."""

    CAMERA = 1
    DIFFUSE = 2
    GLOSSY = 4
    TRANSMISSION = 8
    SHADOW = 16
    SCATTER = 32
    ALL = 63


class LightType(IntEnum):
    """Shapes of lamps."""

    POINT = 0
    SPOT = 1
    SUN = 2
    RECTANGLE = 3
    ELLIPSE = 4


class CameraType(IntEnum):
    """Projections."""

    PERSPECTIVE = 0
    ORTHOGRAPHIC = 1


class Transfer(IntEnum):
    """Decoding of an image's stored values, applied after interpolation."""

    LINEAR = 0
    SRGB = 1


class Domain(IntEnum):
    """What an attribute has one value for."""

    CORNER = 0
    VERTEX = 1
    FACE = 2


class Fresnel(IntEnum):
    """How a gem's boundary reflects."""

    EXACT = 0
    SCHLICK = 1


class MaterialFlag(IntFlag):
    """What the tracer has to know of a material before it runs its program."""

    CASTER = 1
    EMISSIVE = 2
    TRANSPARENT_SHADOW = 4
    NO_SURFACE = 8


class PhaseKind(IntEnum):
    """How a medium turns light."""

    ISOTROPIC = 0
    HENYEY_GREENSTEIN = 1
    RAYLEIGH = 2
    TABLE = 3


class Density(IntEnum):
    """What a medium's extinction and scattering are multiplied by."""

    HOMOGENEOUS = 0
    NOISE = 1
    GRID = 2
    HEIGHT = 3


class EmissionDensity(IntEnum):
    """What a medium's emission is multiplied by."""

    AS_DENSITY = 0
    EVERYWHERE = 1
    GRID = 2


class Carry(IntEnum):
    """Which light the photons bring; the camera's paths take the rest."""

    CAUSTICS = 0
    INDIRECT = 1
    ALL = 2
    NONE = 3


class VolumeEstimate(IntEnum):
    """How photons in media are looked up: three methods, one picture in the limit."""

    POINTS = 0
    BEAM_RADIANCE = 1
    BEAMS = 2


class Filter(IntEnum):
    """Pixel filters."""

    BOX = 0
    GAUSSIAN = 1
    BLACKMAN_HARRIS = 2


class Pass(IntEnum):
    """Images that a film keeps."""

    COMBINED = 0
    DEPTH = 1
    NORMAL = 2
    POSITION = 3
    ALBEDO = 4
    EMISSION = 5
    DIRECT = 6
    INDIRECT = 7
    CAUSTICS = 8
    MEDIUM = 9
    SPECTRAL = 10
    NOISE = 11
    LAYER_BASE = 12
    LAYER_BEHIND = 13
    LAYER_CAUSTICS = 14
    LAYER_GEMS = 15
    LAYER_MEDIA = 16
    LAYER_RAINBOW = 17
    LAYER_DIMMED = 18


class MediumLayer(IntEnum):
    """Which compositing layer shows a medium; ``BASE``: the other engine renders it as it does surfaces."""

    MEDIA = 0
    RAINBOW = 1
    BASE = 2


# Channels of each pass; the spectral one has as many as the settings ask for.
PASS_CHANNELS = {
    Pass.COMBINED: 4,
    Pass.DEPTH: 1,
    Pass.NORMAL: 3,
    Pass.POSITION: 3,
    Pass.ALBEDO: 3,
    Pass.EMISSION: 3,
    Pass.DIRECT: 3,
    Pass.INDIRECT: 3,
    Pass.CAUSTICS: 3,
    Pass.MEDIUM: 3,
    Pass.NOISE: 1,
    Pass.LAYER_BASE: 4,
    Pass.LAYER_BEHIND: 4,
    Pass.LAYER_CAUSTICS: 4,
    Pass.LAYER_GEMS: 4,
    Pass.LAYER_MEDIA: 4,
    Pass.LAYER_RAINBOW: 4,
    Pass.LAYER_DIMMED: 4,
}

IDENTITY = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
Matrix = Sequence[Sequence[float]]


@dataclass
class Program:
    """A material's register program (``include/opal_shader.h``).

    Attributes
    ----------
    code : ndarray
        int32 of shape (n_instructions, 16): operation, mode, first register written, 13 operands.
    constants : ndarray
        float32 of shape (n_constants, 4): what registers 0 .. n_constants - 1 start with.
    n_registers : int
        Registers in all.
    """

    code: np.ndarray
    constants: np.ndarray
    n_registers: int


@dataclass
class Gem:
    """A dielectric boundary whose index depends on wavelength, round an absorbing interior.

    Attributes
    ----------
    index_spectrum, absorption_spectrum : int
        Numbers that ``Scene.add_spectrum`` gave: n(λ), and σa(λ) in 1/m or -1 for a clear interior.
    roughness : float
        0 is polished; the GGX width is its square.
    priority : int
        Where two interiors overlap the higher one wins.
    """

    index_spectrum: int
    absorption_spectrum: int = -1
    roughness: float = 0.0
    fresnel: int = Fresnel.EXACT
    priority: int = 0


@dataclass
class Phase:
    """A phase function: per steradian, over the angle between propagation directions (0 is straight on).

    Attributes
    ----------
    anisotropy : float
        Henyey-Greenstein: the mean cosine, -1 to 1.
    wavelengths, angles : array_like, optional
        A table's nodes: (n,) nm and (m,) radians from 0 to π, ascending.
    values : array_like, optional
        (n, m) in 1/sr; rows are normalised. With elevations and clocks (n_elevations, n_clocks, n, m).
    polarization : array_like, optional
        Of the shape of values: degree of polarisation of what scatters unpolarised light, 1 perpendicular to the plane of scattering.
    elevations, clocks : array_like, optional
        For particles that are not round and fall along -Z: the light's height over the horizon, and the place on a bow from 0 above
        the antisolar point to π below it, radians, ascending.
    """

    kind: int = PhaseKind.ISOTROPIC
    anisotropy: float = 0.0
    wavelengths: object = None
    angles: object = None
    values: object = None
    polarization: object = None
    elevations: object = None
    clocks: object = None


@dataclass
class Medium:
    """A participating medium, by numbers that the scene gave.

    Attributes
    ----------
    extinction, scattering : int
        Spectra in 1/m; -1 is 0.
    emission : int
        Spectrum of radiance per metre; -1 is none.
    phase : int
        Phase function; -1 is isotropic.
    density : Density
        What extinction and scattering are multiplied by; see ``opal_medium_desc``.
    emission_density : EmissionDensity
        What the emission is multiplied by.
    density_grid, emission_density_grid : int
        1 + a grid of one channel; 0 is none.
    scattering_grid, absorption_grid, emission_grid : int
        1 + a grid of three channels that adds to the coefficients; 0 is none.
    noise_seed, noise_scale, noise_detail, noise_contrast
        Of procedural density: lumps of this size in object space, octaves, and how sharply they part.
    scale_height, base_height : float
        Of density that falls with height.
    also : int
        1 + a medium that fills the same body with it, with its own coefficients and phase function; 0 is none.
    """

    extinction: int = -1
    scattering: int = -1
    emission: int = -1
    phase: int = -1
    density: int = Density.HOMOGENEOUS
    density_grid: int = 0
    emission_density: int = EmissionDensity.AS_DENSITY
    emission_density_grid: int = 0
    scattering_grid: int = 0
    absorption_grid: int = 0
    emission_grid: int = 0
    noise_seed: int = 0
    noise_scale: float = 1.0
    noise_detail: float = 0.0
    noise_contrast: float = 1.0
    scale_height: float = 1.0
    base_height: float = 0.0
    also: int = 0


@dataclass
class Attribute:
    """A mesh attribute that programs read by number.

    Attributes
    ----------
    name : int
        The number programs use for it.
    domain : Domain
        Corner (3 a triangle), vertex or face.
    values : ndarray
        float32 of shape (count, 1 to 4).
    """

    name: int
    domain: int
    values: np.ndarray


@dataclass
class Light:
    """A lamp; it looks along its local -Z.

    Attributes
    ----------
    color : sequence of 3 floats
        Linear Rec.709, without the power.
    power : float
        Watts as Blender counts them (sun: irradiance in W/m²), exposure included.
    radius : float
        Point and spot: of the sphere in metres. Sun: half of its angle.
    size_u, size_v : float
        Area: edge lengths or axes along local X and Y, before ``transform``.
    spread : float
        Area: full angle, π is Lambertian.
    soft_falloff : int
        Point and spot: non-zero lights as a disc that faces each point (Blender's default), zero as a sphere.
    receivers : int
        Light linking: bit i lights receiver set i.
    """

    type: int = LightType.POINT
    spectrum: int = -1
    transform: Matrix = IDENTITY
    color: Sequence[float] = (1.0, 1.0, 1.0)
    power: float = 1.0
    radius: float = 0.0
    spot_angle: float = math.pi / 4
    spot_blend: float = 0.0
    size_u: float = 1.0
    size_v: float = 1.0
    spread: float = math.pi
    visibility: int = Ray.ALL
    cast_shadow: int = 1
    normalize: int = 1
    caustics: int = 1
    soft_falloff: int = 1
    receivers: int = 0xFFFFFFFFFFFFFFFF


@dataclass
class World:
    """Radiance from infinity: a program run with the direction looked in as its position.

    Attributes
    ----------
    map_width : int
        Width in pixels of the importance map; 0 for a uniform world.
    """

    program: Program | None = None
    visibility: int = Ray.ALL
    map_width: int = 0
    caustics: int = 1


@dataclass
class Camera:
    """Looks along its local -Z with Y up.

    Attributes
    ----------
    transform : matrix
        Camera to world; with motion, in the middle of the shutter.
    transform_start, transform_end : matrix, optional
        At shutter open and close; None is as in the middle. It turns between them, and goes straight.
    window : sequence of 4 floats
        Left, right, bottom, top of the full frame: at distance 1 (perspective) or in metres (orthographic).
    aperture_radius : float
        0 is a pinhole.
    polarizer : int
        1 puts a linear polarising filter before the lens, which takes half of unpolarised light.
    polarizer_angle : float
        Of what it lets through, radians from the camera's X axis towards Y.
    """

    type: int = CameraType.PERSPECTIVE
    blades: int = 0
    transform: Matrix = IDENTITY
    transform_start: Matrix | None = None
    transform_end: Matrix | None = None
    window: Sequence[float] = (-0.36, 0.36, -0.36, 0.36)
    clip_start: float = 0.0
    clip_end: float = 1e30
    aperture_radius: float = 0.0
    focus_distance: float = 1.0
    blade_rotation: float = 0.0
    aperture_ratio: float = 1.0
    polarizer: int = 0
    polarizer_angle: float = 0.0


@dataclass
class RenderSettings:
    """How to render; see ``opal_render_settings``.

    Attributes
    ----------
    width, height : int
        Pixels of the full frame.
    region : sequence of 4 ints, optional
        x0, y0, x1, y1 of the pixels rendered, y up; None is the whole frame.
    radius : float
        Of the first pass's photon kernel in metres; 0 lets the scene choose.
    passes : iterable of Pass
        What the film keeps beside Combined.
    volume_estimate : VolumeEstimate
        How photons in media are looked up.
    volume_photons : int
        Photons emitted a pass for media alone; 0 lets ``photons_per_pass`` serve surfaces and media together.
    volume_radius : float
        Of the first pass's kernel in media in metres; 0 takes ``radius``, and if that is 0 too, lets the photons choose.
    march_steps : int
        Steps along a ray of the estimate ``POINTS``.
    march_tolerance : float
        Relative difference between neighbouring steps above which one is halved; 0 halves none.
    adaptive : bool
        A pilot before the first pass shares out the camera paths over the picture by their noise, with ``samples_per_pass`` as their
        mean, and weighs photons against paths at the same cost. The same seed plans the same, so that passes add up.
    """

    width: int = 256
    height: int = 256
    region: Sequence[int] | None = None
    samples_per_pass: int = 1
    photons_per_pass: int = 100_000
    photons_carry: int = Carry.CAUSTICS
    gather: int = 64
    radius: float = 0.0
    radius_shrink: float = 2.0 / 3.0
    max_depth: int = 32
    transparent_depth: int = 32
    wavelength_first: float = 360.0
    wavelength_last: float = 830.0
    seed: int = 0
    filter: int = Filter.BLACKMAN_HARRIS
    filter_width: float = 1.5
    exposure: float = 1.0
    transparent_film: bool = False
    clamp_direct: float = 0.0
    clamp_indirect: float = 0.0
    motion_blur: bool = False
    spectral_bins: int = 0
    threads: int = 0
    passes: Sequence[int] = field(default_factory=tuple)
    volume_estimate: int = VolumeEstimate.BEAMS
    volume_photons: int = 0
    volume_radius: float = 0.0
    march_steps: int = 16
    march_tolerance: float = 0.5
    adaptive: bool = False
