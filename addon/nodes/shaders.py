# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers of shader nodes: each emits the lobes that its node stands for."""

from __future__ import annotations

from . import operations as ops
from .compiler import NodeView
from .operations import Op
from .program import ONE, ZERO, Value, constant
from .registry import shades


def _multiscatter(n: NodeView) -> int:
    return int(n.node.distribution == "MULTI_GGX")


def _no_thin_film(n: NodeView) -> None:
    thickness = n.value("Thin Film Thickness")
    if thickness.number is None or thickness.number > 0:
        n.problem("Thin films are not shaded on this node; it is shown without.", lost=True)


def _tangent(n: NodeView, *amounts: Value) -> Value | None:
    """The Tangent input where something is anisotropic; unlinked, round the object's z axis."""
    if all(a.number == 0 for a in amounts):
        return None
    return n.linked("Tangent") or n.emit(Op.GEOMETRY, ops.GEOMETRY["TANGENT"])


@shades("ShaderNodeBsdfDiffuse")
def diffuse(n: NodeView, weight: Value) -> None:
    n.emit(Op.DIFFUSE, 0, weight, n.value("Color"), n.value("Roughness"), n.normal())


@shades("ShaderNodeBsdfTranslucent")
def translucent(n: NodeView, weight: Value) -> None:
    n.emit(Op.TRANSLUCENT, 0, weight, n.value("Color"), n.normal())


@shades("ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfGlossy")
def glossy(n: NodeView, weight: Value) -> None:
    anisotropy = n.value("Anisotropy")
    inputs = (n.value("Color"), n.value("Roughness"), anisotropy, n.value("Rotation"), n.normal(), _tangent(n, anisotropy))
    n.emit(Op.GLOSSY, 0, weight, *inputs, _multiscatter(n))


@shades("ShaderNodeBsdfMetallic")
def metallic(n: NodeView, weight: Value) -> None:
    physical = n.node.fresnel_type == "PHYSICAL_CONDUCTOR"
    colors = ("IOR", "Extinction") if physical else ("Base Color", "Edge Tint")
    anisotropy = n.value("Anisotropy")
    inputs = (*map(n.value, colors), n.value("Roughness"), anisotropy, n.value("Rotation"), n.normal(), _tangent(n, anisotropy))
    _no_thin_film(n)
    n.emit(Op.METALLIC, int(physical), weight, *inputs, _multiscatter(n))


@shades("ShaderNodeBsdfGlass")
def glass(n: NodeView, weight: Value) -> None:
    _no_thin_film(n)
    inputs = (n.value("Color"), n.value("Roughness"), n.value("IOR"), n.normal())
    n.emit(Op.GLASS, 0, weight, *inputs, _multiscatter(n))


@shades("ShaderNodeBsdfRefraction")
def refraction(n: NodeView, weight: Value) -> None:
    n.emit(Op.REFRACTION, 0, weight, n.value("Color"), n.value("Roughness"), n.value("IOR"), n.normal())


@shades("ShaderNodeBsdfTransparent")
def transparent(n: NodeView, weight: Value) -> None:
    n.emit(Op.TRANSPARENT, 0, weight, n.value("Color"))


@shades("ShaderNodeBsdfSheen")
def sheen(n: NodeView, weight: Value) -> None:
    if n.node.distribution == "ASHIKHMIN":
        n.problem("Ashikhmin's sheen is shaded as Microfiber.")
    n.emit(Op.SHEEN, 0, weight, n.value("Color"), n.value("Roughness"), n.normal())


@shades("ShaderNodeEmission", "ShaderNodeBackground")
def emission(n: NodeView, weight: Value) -> None:
    n.emit(Op.EMISSION, 0, weight, n.light("Color"), n.light("Strength"))


@shades("ShaderNodeHoldout")
def holdout(n: NodeView, weight: Value) -> None:
    n.emit(Op.HOLDOUT, 0, weight)


@shades("ShaderNodeSubsurfaceScattering")
def subsurface(n: NodeView, weight: Value) -> None:
    n.problem("Light does not travel under the surface; it is shaded as diffuse of the same colour.")
    n.emit(Op.DIFFUSE, 0, weight, n.value("Color"), ZERO, n.normal())


@shades("ShaderNodeBsdfToon")
def toon(n: NodeView, weight: Value) -> None:
    n.problem("Toon shading is shaded as diffuse of the same colour.")
    n.emit(Op.DIFFUSE, 0, weight, n.value("Color"), ZERO, n.normal())


@shades("ShaderNodeBsdfHair", "ShaderNodeBsdfHairPrincipled")
def hair(n: NodeView, weight: Value) -> None:
    n.problem("Hair is shaded as diffuse of the same colour.")
    n.emit(Op.DIFFUSE, 0, weight, n.value("Color"), ZERO, n.normal())


@shades("ShaderNodeEeveeSpecular")
def eevee_specular(n: NodeView, weight: Value) -> None:
    n.problem("Specular BSDF is EEVEE's own; its base colour is shaded as diffuse.")
    n.emit(Op.DIFFUSE, 0, weight, n.value("Base Color"), ZERO, n.normal())


@shades("ShaderNodeBsdfRayPortal")
def ray_portal(n: NodeView, weight: Value) -> None:
    n.problem("Ray portals are not followed; light goes straight through.")
    n.emit(Op.TRANSPARENT, 0, weight, n.value("Color"))


_VOLUMES = ("Absorption", "Coefficients", "Scatter", "Principled")


@shades(*(f"ShaderNodeVolume{kind}" for kind in _VOLUMES))
def volume(n: NodeView, weight: Value) -> None:
    n.problem("A volume shader is linked to a surface; it is left out.", lost=True)


@shades("ShaderNodeBsdfPrincipled")
def principled(n: NodeView, weight: Value) -> None:
    number = n.value
    pack, pack_color = n.builder.pack, n.builder.pack_color
    if number("Subsurface Weight").number != 0:
        n.problem("Light does not travel under the surface; subsurface is shaded as diffuse of the base colour.")
    if number("Thin Wall").number != 0:
        n.problem("Thin walls are not shaded; the surface bounds a solid.")
    _no_thin_film(n)
    anisotropic = number("Anisotropic")
    n.emit(
        Op.PRINCIPLED,
        _multiscatter(n),
        weight,
        number("Base Color"),
        n.normal(),
        _tangent(n, anisotropic),
        n.normal("Coat Normal"),
        pack_color(number("Specular Tint", ONE), number("Specular IOR Level", constant(0.5))),
        pack_color(number("Coat Tint", ONE), number("Coat Weight")),
        pack_color(number("Sheen Tint", ONE), number("Sheen Weight")),
        pack_color(n.light("Emission Color", ONE), n.light("Emission Strength")),
        pack(number("Metallic"), number("Roughness"), number("IOR"), number("Alpha", ONE)),
        pack(number("Diffuse Roughness"), number("Subsurface Weight"), anisotropic, number("Anisotropic Rotation")),
        pack(number("Transmission Weight"), number("Coat Roughness"), number("Coat IOR"), number("Sheen Roughness")),
        pack(number("Thin Film Thickness"), number("Thin Film IOR", constant(1.33))),
    )
