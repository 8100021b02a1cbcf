# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers of textures: images, environments and procedural patterns."""

from __future__ import annotations

import math

import bpy

from . import operations as ops
from .compiler import NodeView
from .inputs import coordinate, uv
from .operations import Op
from .program import ONE, ZERO, Table, Value, constant
from .registry import reads

MAGENTA = constant(1.0, 0.0, 1.0)  # what a missing image shows, as in Cycles


def position(n: NodeView, default: str = "GENERATED") -> Value:
    """The Vector input with the node's own (hidden) mapping applied; unlinked, the coordinate that textures take by default."""
    vector = n.linked("Vector")
    if vector is None:
        vector = uv(n, "") if default == "UV" else coordinate(n, default)
    mapping = n.node.texture_mapping
    location, rotation, scale = (tuple(getattr(mapping, k)) for k in ("translation", "rotation", "scale"))
    if any(location) or any(rotation) or scale != (1.0, 1.0, 1.0):
        kind = ops.MAPPING[mapping.vector_type]
        vector = n.emit(Op.MAPPING, kind, vector, constant(*location), constant(*rotation), constant(*scale))
    return vector


def _image(n: NodeView, vector: Value, projection: str, extension: str) -> dict[str, Value]:
    node, image = n.node, n.node.image
    flags = 0
    if n.output_used("Alpha") and _has_own_alpha(image):
        flags |= ops.IMAGE_UNASSOCIATE_ALPHA
    tiles, index = None, -1
    if image.source == "TILED":
        found = n.context.image_tiles(image)
        tiles = Table(tuple((float(number), float(i), 0.0, 0.0) for number, i in found)) if found else None
    else:
        index = n.context.image_index(image, node.image_user)
    if index < 0 and tiles is None:
        return {"Color": MAGENTA, "Alpha": ONE}
    blend = constant(getattr(node, "projection_blend", 0.0))
    rgba = n.emit(
        Op.IMAGE,
        ops.PROJECTION[projection],
        vector,
        index,
        ops.INTERPOLATION[node.interpolation],
        ops.EXTENSION[extension],
        flags,
        blend,
        tiles,
        len(tiles.rows) if tiles else 0,
    )
    return {"Color": rgba, "Alpha": n.builder.component(rgba, 3)}


def _has_own_alpha(image: object) -> bool:
    """Whether colours were multiplied by alpha on their way in, and have to be divided again where alpha is used apart."""
    return image.alpha_mode not in ("CHANNEL_PACKED", "NONE") and not image.colorspace_settings.is_data


@reads("ShaderNodeTexImage")
def image_texture(n: NodeView) -> dict[str, Value]:
    if n.node.image is None:
        n.problem("No image is chosen; it is magenta.", lost=True)
        return {"Color": MAGENTA, "Alpha": ONE}
    projection = n.node.projection
    return _image(n, position(n, "UV"), projection, n.node.extension)


@reads("ShaderNodeTexEnvironment")
def environment_texture(n: NodeView) -> dict[str, Value]:
    if n.node.image is None:
        n.problem("No image is chosen; it is magenta.", lost=True)
        return {"Color": MAGENTA}
    return _image(n, position(n, "POSITION"), n.node.projection, "REPEAT")


@reads("ShaderNodeTexChecker")
def checker(n: NodeView) -> dict[str, Value]:
    inputs = (position(n), n.value("Color1"), n.value("Color2"), n.value("Scale"))
    color, factor = n.emit_all(Op.CHECKER, 0, *inputs)
    return {"Color": color, "Fac": factor}


@reads("ShaderNodeTexNoise")
def noise(n: NodeView) -> dict[str, Value]:
    node = n.node
    names = ("W", "Scale", "Detail", "Roughness", "Lacunarity", "Offset", "Gain", "Distortion")
    flags = ops.NOISE_NORMALIZE if node.normalize else 0
    if n.output_used("Color"):
        flags |= ops.NOISE_COLOR
    dimensions = int(node.noise_dimensions[0])
    inputs = (position(n), *map(n.value, names), dimensions, flags)
    factor, color = n.emit_all(Op.NOISE, ops.NOISE[node.noise_type], *inputs)
    return {"Fac": factor, "Color": color}


@reads("ShaderNodeTexVoronoi")
def voronoi(n: NodeView) -> dict[str, Value]:
    node = n.node
    names = ("W", "Scale", "Detail", "Roughness", "Lacunarity", "Smoothness", "Exponent", "Randomness")
    old_hash = int(bpy.app.version < (5, 0))
    settings = (int(node.voronoi_dimensions[0]), ops.VORONOI_METRIC[node.distance], int(node.normalize), old_hash)
    outputs = n.emit_all(Op.VORONOI, ops.VORONOI[node.feature], position(n), *map(n.value, names), *settings)
    distance, color, place, radius = outputs
    return {"Distance": distance, "Color": color, "Position": place, "W": n.builder.component(place, 3), "Radius": radius}


_DIRECTION = {"X": 0, "Y": 1, "Z": 2, "DIAGONAL": 3, "SPHERICAL": 3}


@reads("ShaderNodeTexWave")
def wave(n: NodeView) -> dict[str, Value]:
    node = n.node
    names = ("Scale", "Distortion", "Detail", "Detail Scale", "Detail Roughness", "Phase Offset")
    rings = node.wave_type == "RINGS"
    direction = _DIRECTION[node.rings_direction if rings else node.bands_direction]
    profile = ("SIN", "SAW", "TRI").index(node.wave_profile)
    factor = n.emit(Op.WAVE, 0, position(n), *map(n.value, names), int(rings), direction, profile)
    return {"Color": factor, "Fac": factor}


@reads("ShaderNodeTexMagic")
def magic(n: NodeView) -> dict[str, Value]:
    inputs = (position(n), n.value("Scale"), n.value("Distortion"), n.node.turbulence_depth)
    color, factor = n.emit_all(Op.MAGIC, 0, *inputs)
    return {"Color": color, "Fac": factor}


@reads("ShaderNodeTexBrick")
def brick(n: NodeView) -> dict[str, Value]:
    node = n.node
    names = ("Color1", "Color2", "Mortar", "Scale", "Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")
    pattern = Table(((node.offset, float(node.offset_frequency), node.squash, float(node.squash_frequency)),))
    color, factor = n.emit_all(Op.BRICK, 0, position(n), *map(n.value, names), pattern)
    return {"Color": color, "Fac": factor}


@reads("ShaderNodeTexGradient")
def gradient(n: NodeView) -> dict[str, Value]:
    factor = n.emit(Op.GRADIENT, ops.GRADIENT[n.node.gradient_type], position(n))
    return {"Color": factor, "Fac": factor}


@reads("ShaderNodeTexWhiteNoise")
def white_noise(n: NodeView) -> dict[str, Value]:
    dimensions = int(n.node.noise_dimensions[0])
    value, color = n.emit_all(Op.WHITE_NOISE, 0, n.value("Vector"), n.value("W"), dimensions)
    return {"Value": value, "Color": color}


@reads("ShaderNodeTexSky")
def sky(n: NodeView) -> dict[str, Value]:
    """No sky model: a clear sky's blue, brighter towards the horizon."""
    n.problem("Sky textures are not computed; a plain gradient of blue is shown. Use an environment image instead.", lost=True)
    up = n.emit(Op.MAP_RANGE, 0, n.builder.component(position(n), 2), ZERO, ONE, ZERO, ONE, None, ops.RANGE_CLAMP)
    horizon, zenith = constant(0.55, 0.7, 0.95), constant(0.12, 0.25, 0.6)
    return {"Color": n.emit(Op.MIX, ops.MIX["MIX"], up, horizon, zenith, 0)}


@reads("ShaderNodeTexIES")
def ies(n: NodeView) -> dict[str, Value]:
    n.problem("IES profiles are not read; the lamp shines evenly.", lost=True)
    return {"Fac": n.builder.math("MULTIPLY", n.value("Strength"), constant(1 / (4 * math.pi)))}
