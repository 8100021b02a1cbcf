# SPDX-License-Identifier: GPL-3.0-or-later
"""What each kind of material is in Cycles' nodes, as plans.

Coefficients are those that Opal renders, by the unit, as Cycles takes them: extinction and albedo of media; a gem's absorption
-ln(colour) / depth. `metres`, wherever it is asked for, are metres per unit (`units`). What Cycles has no word for becomes its nearest: one index of refraction (at the D line) for a gem, and for drops the Henyey-Greenstein
function of their mean cosine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from .. import presets
from .plan import Plan

# Mean cosine of what water drops much larger than a wavelength scatter: 0.87 with the half that diffraction sends straight on
# (van de Hulst, "Light Scattering by Small Particles", 1957, section 10.62), 0.74 of refracted and reflected light alone.
_DROPS_WITH_DIFFRACTION, _DROPS = 0.87, 0.74
# No coefficient, 1/m, needs to be larger: light is gone in a micrometre.
_LARGEST = 1e6


def gem(settings: Any, metres: float = 1.0) -> Plan:
    """Glass of the stone's index at the D line, filled with its absorption.

    Parameters
    ----------
    settings : OpalGemProperties
    """
    plan = Plan()
    numbers = presets.read_out(settings)
    index = numbers.n_d if numbers is not None else 1.5
    plan.add("Boundary", "ShaderNodeBsdfGlass", 1, Color=(1, 1, 1, 1), Roughness=settings.roughness, IOR=index)
    plan.add("Output", "ShaderNodeOutputMaterial", 3)
    plan.join("Boundary", 0, "Output", "Surface")
    absorption = _absorption(settings, metres)
    if max(absorption) > 0:
        _coefficients(plan, absorption, (0, 0, 0))
        plan.join("Interior", 0, "Output", "Volume")
    return plan


def _absorption(settings: Any, metres: float) -> list[float]:
    """-ln(colour) / depth, by channel: of the color set, or of what white light becomes along the usual depth of a stone's curve."""
    sigma = presets.absorption_by_curve(settings)
    tint, depth = settings.absorption_color, settings.absorption_depth
    if sigma is not None:
        from opal_kernels import gem as gems

        if not sigma.any():
            return [0.0, 0.0, 0.0]
        tint, depth = gems.tint_along(sigma, gems.USUAL_DEPTH), gems.USUAL_DEPTH / metres
    return [min(_LARGEST * metres, -math.log(max(c, 1e-6)) / depth) for c in tint]


def filling(opal: Any, world: bool = False, metres: float = 1.0) -> Plan:
    """Medium or rain as a volume.

    Parameters
    ----------
    opal : OpalMaterialProperties or OpalWorldProperties
        Of kind ``MEDIUM`` or ``RAINBOW``.
    """
    plan = Plan()
    output = plan.add("Output", "ShaderNodeOutputWorld" if world else "ShaderNodeOutputMaterial", 3)
    extinction, albedo, phase, cosine = coefficients(opal, metres)
    scattering = [e * a for e, a in zip(extinction, albedo, strict=True)]
    absorption = [e - s for e, s in zip(extinction, scattering, strict=True)]
    _coefficients(plan, absorption, scattering, _emission(opal, metres), phase, cosine)
    density = _density(plan, opal, world, metres)
    if density is not None:
        for name in ("Absorption Coefficients", "Scatter Coefficients"):
            _scale(plan, name, density)
        source = density
        if opal.kind == "MEDIUM" and opal.medium.emission_grid:
            source = _grid(plan, "Emission Grid", opal.medium.emission_grid)
        _scale(plan, "Emission Coefficients", source)
    plan.join("Interior", 0, output, "Volume")
    return plan


def absorber(opal: Any, world: bool = False, camera_passes: bool = False, metres: float = 1.0) -> Plan:
    """What takes the same light away as medium or rain and scatters none.

    Parameters
    ----------
    camera_passes : bool
        Rays from the camera are not dimmed: the picture is multiplied by the transmittance afterwards.
    """
    plan = Plan()
    output = plan.add("Output", "ShaderNodeOutputWorld" if world else "ShaderNodeOutputMaterial", 3)
    _coefficients(plan, coefficients(opal, metres)[0], (0, 0, 0))
    density = _density(plan, opal, world, metres)
    if camera_passes:
        plan.add("Ray", "ShaderNodeLightPath", -2)
        plan.add("Not Camera", "ShaderNodeMath", -1, {"operation": "SUBTRACT"})
        plan.nodes["Not Camera"].values = {0: 1.0}
        plan.join("Ray", "Is Camera Ray", "Not Camera", 1)
        if density is None:
            density = ("Not Camera", 0)
        else:
            plan.add("Dimming", "ShaderNodeMath", 0, {"operation": "MULTIPLY"})
            plan.join(*density, "Dimming", 0)
            plan.join("Not Camera", 0, "Dimming", 1)
            density = ("Dimming", 0)
    if density is not None:
        _scale(plan, "Absorption Coefficients", density)
    plan.join("Interior", 0, output, "Volume")
    return plan


def blocker() -> Plan:
    """A hole where the camera looks at a gem, and a black body for every other ray."""
    plan = Plan()
    plan.add("Ray", "ShaderNodeLightPath", 0)
    plan.add("Black", "ShaderNodeBsdfDiffuse", 0, Color=(0, 0, 0, 1))
    plan.add("Hole", "ShaderNodeHoldout", 0)
    plan.add("Either", "ShaderNodeMixShader", 1)
    plan.add("Output", "ShaderNodeOutputMaterial", 2)
    plan.join("Ray", "Is Camera Ray", "Either", 0)
    plan.join("Black", 0, "Either", 1)
    plan.join("Hole", 0, "Either", 2)
    plan.join("Either", 0, "Output", "Surface")
    return plan


def coefficients(opal: Any, metres: float = 1.0) -> tuple[Sequence[float], Sequence[float], str, float]:
    """Extinction (by the unit and by channel), albedo, Cycles' phase function and mean cosine."""
    if opal.kind == "RAINBOW":
        rain = opal.rainbow
        # With diffraction drops take twice the light that falls on them (van de Hulst, section 8.22).
        factor, cosine = (2.0, _DROPS_WITH_DIFFRACTION) if rain.diffraction else (1.0, _DROPS)
        return (metres * rain.extinction * factor,) * 3, (1.0, 1.0, 1.0), "HENYEY_GREENSTEIN", cosine
    medium = opal.medium
    extinction = [metres * medium.extinction * c for c in medium.extinction_color]
    if medium.phase == "RAYLEIGH":
        return extinction, medium.albedo, "RAYLEIGH", 0.0
    return extinction, medium.albedo, "HENYEY_GREENSTEIN", medium.anisotropy if medium.phase == "HENYEY_GREENSTEIN" else 0.0


def _emission(opal: Any, metres: float) -> Sequence[float]:
    if opal.kind != "MEDIUM" or opal.medium.emission_strength <= 0:
        return (0.0, 0.0, 0.0)
    medium = opal.medium
    color = medium.emission_color
    if medium.emission_source == "BLACKBODY":
        from opal_kernels.optics import colour, illuminants

        color = [max(0.0, float(c)) for c in colour.rec709(illuminants.blackbody(medium.emission_temperature))]
    return [metres * c * medium.emission_strength for c in color]


def _coefficients(
    plan: Plan,
    absorption: Sequence[float],
    scattering: Sequence[float],
    emission: Sequence[float] = (0.0, 0.0, 0.0),
    phase: str = "HENYEY_GREENSTEIN",
    cosine: float = 0.0,
) -> None:
    plan.add("Interior", "ShaderNodeVolumeCoefficients", 2, {"phase": phase})
    values = {
        "Absorption Coefficients": tuple(absorption),
        "Scatter Coefficients": tuple(scattering),
        "Emission Coefficients": tuple(emission),
    }
    if phase == "HENYEY_GREENSTEIN":
        values["Anisotropy"] = cosine
    plan.nodes["Interior"].values = values


def _scale(plan: Plan, socket: str, source: tuple[str, str | int]) -> None:
    """Multiplies one of the interior's coefficients by a density."""
    value = plan.nodes["Interior"].values.pop(socket)
    if not any(value):
        plan.nodes["Interior"].values[socket] = value
        return
    name = socket.split()[0]
    plan.add(name, "ShaderNodeVectorMath", 1, {"operation": "SCALE"})
    plan.nodes[name].values = {0: tuple(value)}
    plan.join(*source, name, "Scale")
    plan.join(name, 0, "Interior", socket)


def _density(plan: Plan, opal: Any, world: bool, metres: float) -> tuple[str, str | int] | None:
    """The density field as an output of some node; None where it is 1 everywhere."""
    if world and (height := _scale_height(opal, metres)) > 0:
        return _height(plan, height, opal.base_height)
    if opal.kind != "MEDIUM" or opal.medium.density == "HOMOGENEOUS":
        return None
    if opal.medium.density == "GRID":
        return _grid(plan, "Grid", opal.medium.grid)
    return _noise(plan, opal.medium, world)


def _grid(plan: Plan, name: str, grid: str) -> tuple[str, str]:
    plan.add(name, "ShaderNodeAttribute", 0, {"attribute_name": grid})
    return name, "Fac"


def _noise(plan: Plan, medium: Any, world: bool) -> tuple[str, int]:
    """saturate(1/2 + contrast (n - 1/2)) of fractal noise n, as the kernels have it."""
    plan.add("Place", "ShaderNodeNewGeometry" if world else "ShaderNodeTexCoord", -4)
    plan.add("Size", "ShaderNodeVectorMath", -3, {"operation": "MULTIPLY_ADD"})
    plan.nodes["Size"].values = {1: (1 / medium.noise_scale,) * 3, 2: noise_offset(medium.noise_seed)}
    plan.add("Noise", "ShaderNodeTexNoise", -2, Scale=1.0, Detail=medium.noise_detail, Roughness=0.5, Lacunarity=2.0, Distortion=0.0)
    plan.add("Contrast", "ShaderNodeMath", -1, {"operation": "MULTIPLY_ADD", "use_clamp": True})
    plan.nodes["Contrast"].values = {1: medium.noise_contrast, 2: 0.5 - 0.5 * medium.noise_contrast}
    plan.join("Place", "Position" if world else "Object", "Size", 0)
    plan.join("Size", 0, "Noise", "Vector")
    plan.join("Noise", 0, "Contrast", 0)
    return "Contrast", 0


def _scale_height(opal: Any, metres: float) -> float:
    """The world's scale height as it is rendered, in units: rain that says none has one (translate/rainbow.py)."""
    if opal.kind == "RAINBOW" and opal.scale_height <= 0:
        from ..translate.rainbow import RAIN_HEIGHT

        return RAIN_HEIGHT / metres
    return opal.scale_height


def _height(plan: Plan, height: float, base: float) -> tuple[str, int]:
    """exp(-(z - base) / scale) above the base height, 1 below."""
    plan.add("Place", "ShaderNodeNewGeometry", -4)
    plan.add("Position", "ShaderNodeSeparateXYZ", -3)
    plan.add("Height", "ShaderNodeMath", -2, {"operation": "MULTIPLY_ADD"})
    plan.nodes["Height"].values = {1: -1 / height, 2: base / height}
    plan.add("Above", "ShaderNodeMath", -1, {"operation": "MINIMUM"})
    plan.nodes["Above"].values = {1: 0.0}
    plan.add("Falloff", "ShaderNodeMath", 0, {"operation": "EXPONENT"})
    plan.join("Place", "Position", "Position", 0)
    plan.join("Position", "Z", "Height", 0)
    plan.join("Height", 0, "Above", 0)
    plan.join("Above", 0, "Falloff", 0)
    return "Falloff", 0


def noise_offset(seed: int) -> tuple[float, float, float]:
    """Where in the noise a seed looks, in units of its largest lumps: as the kernels shift it (`medium_from` in api/media.cpp)."""
    return tuple((_hash32(seed, axis) & 0xFFFF) / 16.0 - 2048.0 for axis in (1, 2, 3))


def _hash32(a: int, b: int) -> int:
    """`hash32(a, b)` of kernels/src/core/sampler.h, after Wellons' lowbias32."""
    return _mixed(a ^ (_mixed(b) + 0x9E3779B9 + (a << 6) + (a >> 2)))


def _mixed(x: int) -> int:
    x &= 0xFFFFFFFF
    for shift, factor in ((16, 0x7FEB352D), (15, 0x846CA68B)):
        x = ((x ^ (x >> shift)) * factor) & 0xFFFFFFFF
    return x ^ (x >> 16)
