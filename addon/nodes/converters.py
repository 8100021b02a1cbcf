# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers of nodes that work on numbers and colours: Math, Mix, Map Range, ramps and curves, separating and combining."""

from __future__ import annotations

from typing import Any

from . import operations as ops
from .compiler import NodeView
from .operations import Op
from .program import ONE, Table, Value, constant
from .registry import reads

TABLE_SIZE = 256  # entries of a baked ramp or curve, as in Cycles


def clamp01(n: NodeView, value: Value) -> Value:
    """A number limited to 0..1."""
    return n.emit(Op.CLAMP, 0, value, constant(0.0), ONE)


@reads("ShaderNodeMath")
def math(n: NodeView) -> dict[str, Value]:
    mode = ops.MATH[n.node.operation]
    result = n.emit(Op.MATH, mode, n.value("Value"), n.value("Value_001"), n.value("Value_002"))
    return {"Value": clamp01(n, result) if n.node.use_clamp else result}


@reads("ShaderNodeMix")
def mix(n: NodeView) -> dict[str, Value]:
    node = n.node
    flags = ops.MIX_CLAMP_FACTOR if node.clamp_factor else 0
    mode = ops.MIX["MIX"]
    kind = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(node.data_type)
    if kind is None:
        n.problem("Rotations cannot be mixed in a shader; the first one is taken.")
        return {"Result_Rotation": n.value("A_Rotation")}
    factor = "Factor_Float"
    if kind == "Vector" and node.factor_mode == "NON_UNIFORM":
        flags |= ops.MIX_VECTOR_FACTOR
        factor = "Factor_Vector"
    if kind == "Color":
        mode = ops.MIX[node.blend_type]
        flags |= ops.MIX_CLAMP_RESULT if node.clamp_result else 0
    result = n.emit(Op.MIX, mode, n.value(factor), n.value(f"A_{kind}"), n.value(f"B_{kind}"), flags)
    return {f"Result_{kind}": result}


@reads("ShaderNodeMixRGB")
def mix_rgb(n: NodeView) -> dict[str, Value]:
    flags = ops.MIX_CLAMP_FACTOR | (ops.MIX_CLAMP_RESULT if n.node.use_clamp else 0)
    mode = ops.MIX[n.node.blend_type]
    return {"Color": n.emit(Op.MIX, mode, n.value("Fac"), n.value("Color1"), n.value("Color2"), flags)}


@reads("ShaderNodeMapRange")
def map_range(n: NodeView) -> dict[str, Value]:
    node = n.node
    mode = ops.MAP_RANGE[node.interpolation_type]
    clamped = node.clamp and node.interpolation_type in ("LINEAR", "STEPPED")
    flags = ops.RANGE_CLAMP if clamped else 0
    if node.data_type == "FLOAT_VECTOR":
        inputs = ("Vector", "From_Min_FLOAT3", "From_Max_FLOAT3", "To_Min_FLOAT3", "To_Max_FLOAT3", "Steps_FLOAT3")
        flags |= ops.RANGE_VECTOR
        return {"Vector": n.emit(Op.MAP_RANGE, mode, *map(n.value, inputs), flags)}
    inputs = ("Value", "From Min", "From Max", "To Min", "To Max", "Steps")
    return {"Result": n.emit(Op.MAP_RANGE, mode, *map(n.value, inputs), flags)}


@reads("ShaderNodeClamp")
def clamp(n: NodeView) -> dict[str, Value]:
    mode = 1 if n.node.clamp_type == "RANGE" else 0
    return {"Result": n.emit(Op.CLAMP, mode, n.value("Value"), n.value("Min"), n.value("Max"))}


@reads("ShaderNodeHueSaturation")
def hue_saturation(n: NodeView) -> dict[str, Value]:
    inputs = map(n.value, ("Fac", "Color", "Hue", "Saturation", "Value"))
    return {"Color": n.emit(Op.HUE_SATURATION, 0, *inputs)}


@reads("ShaderNodeInvert")
def invert(n: NodeView) -> dict[str, Value]:
    return {"Color": n.emit(Op.INVERT, 0, n.value("Fac"), n.value("Color"))}


@reads("ShaderNodeGamma")
def gamma(n: NodeView) -> dict[str, Value]:
    return {"Color": n.emit(Op.GAMMA, 0, n.value("Color"), n.value("Gamma"))}


@reads("ShaderNodeBrightContrast")
def bright_contrast(n: NodeView) -> dict[str, Value]:
    return {"Color": n.emit(Op.BRIGHT_CONTRAST, 0, n.value("Color"), n.value("Bright"), n.value("Contrast"))}


@reads("ShaderNodeRGBToBW")
def rgb_to_bw(n: NodeView) -> dict[str, Value]:
    return {"Val": n.emit(Op.GREY, ops.GREY["LUMINANCE"], n.value("Color"))}


def _separated(n: NodeView, source: str, mode: str, names: tuple[str, ...]) -> dict[str, Value]:
    value = n.value(source)
    return {name: n.emit(Op.SEPARATE, ops.COLOR[mode], value, i) for i, name in enumerate(names)}


@reads("ShaderNodeSeparateColor")
def separate_color(n: NodeView) -> dict[str, Value]:
    return _separated(n, "Color", n.node.mode, ("Red", "Green", "Blue"))


@reads("ShaderNodeSeparateRGB")
def separate_rgb(n: NodeView) -> dict[str, Value]:
    return _separated(n, "Image", "RGB", ("R", "G", "B"))


@reads("ShaderNodeSeparateHSV")
def separate_hsv(n: NodeView) -> dict[str, Value]:
    return _separated(n, "Color", "HSV", ("H", "S", "V"))


@reads("ShaderNodeSeparateXYZ")
def separate_xyz(n: NodeView) -> dict[str, Value]:
    return _separated(n, "Vector", "RGB", ("X", "Y", "Z"))


@reads("ShaderNodeCombineColor")
def combine_color(n: NodeView) -> dict[str, Value]:
    return {"Color": n.emit(Op.COMBINE, ops.COLOR[n.node.mode], *map(n.value, ("Red", "Green", "Blue")))}


@reads("ShaderNodeCombineRGB")
def combine_rgb(n: NodeView) -> dict[str, Value]:
    return {"Image": n.emit(Op.COMBINE, ops.COLOR["RGB"], *map(n.value, ("R", "G", "B")))}


@reads("ShaderNodeCombineHSV")
def combine_hsv(n: NodeView) -> dict[str, Value]:
    return {"Color": n.emit(Op.COMBINE, ops.COLOR["HSV"], *map(n.value, ("H", "S", "V")))}


@reads("ShaderNodeCombineXYZ")
def combine_xyz(n: NodeView) -> dict[str, Value]:
    return {"Vector": n.emit(Op.COMBINE, ops.COLOR["RGB"], *map(n.value, ("X", "Y", "Z")))}


@reads("ShaderNodeValToRGB")
def color_ramp(n: NodeView) -> dict[str, Value]:
    ramp = n.node.color_ramp
    rows = tuple(tuple(ramp.evaluate(i / (TABLE_SIZE - 1))) for i in range(TABLE_SIZE))
    mode = 0 if ramp.interpolation == "CONSTANT" else ops.TABLE_INTERPOLATE
    color = n.emit(Op.TABLE, mode, n.value("Fac"), Table(rows), TABLE_SIZE)
    return {"Color": color, "Alpha": n.builder.component(color, 3)}


def _curve_table(mapping: Any, curves: list[Any], first: Any = None) -> tuple[Table, float, float]:
    """Curves as a table over the range that they cover; ``first`` is applied before each of them."""
    mapping.update()
    every = curves + ([first] if first else [])
    low = min(0.0, *(c.points[0].location[0] for c in every))
    high = max(1.0, *(c.points[-1].location[0] for c in every))

    def row(i: int) -> tuple[float, float, float, float]:
        x = low + (high - low) * i / (TABLE_SIZE - 1)
        if first is not None:
            x = mapping.evaluate(first, x)
        values = [mapping.evaluate(c, x) for c in curves]
        return (*(values * 3)[:3], 1.0)

    return Table(tuple(row(i) for i in range(TABLE_SIZE))), low, high


def _apply_curves(n: NodeView, source: str, curves: list[Any], first: Any = None) -> Value:
    mapping = n.node.mapping
    table, low, high = _curve_table(mapping, curves, first)
    value = n.value(source)
    flags = 0
    to_range = (constant(low), constant(high), constant(0.0), ONE, constant(4.0))
    position = n.emit(Op.MAP_RANGE, ops.MAP_RANGE["LINEAR"], value, *to_range, flags | ops.RANGE_VECTOR)
    mode = ops.TABLE_INTERPOLATE | (ops.TABLE_COMPONENTS if len(curves) > 1 else 0)
    if mapping.extend == "EXTRAPOLATED":
        mode |= ops.TABLE_EXTRAPOLATE
    curved = n.emit(Op.TABLE, mode, position, table, TABLE_SIZE)
    factor = n.value("Fac") if n.node.bl_idname != "ShaderNodeFloatCurve" else n.value("Factor")
    return n.emit(Op.MIX, ops.MIX["MIX"], factor, value, curved, 0)


@reads("ShaderNodeRGBCurve")
def rgb_curves(n: NodeView) -> dict[str, Value]:
    curves = n.node.mapping.curves
    return {"Color": _apply_curves(n, "Color", list(curves[:3]), curves[3])}


@reads("ShaderNodeVectorCurve")
def vector_curves(n: NodeView) -> dict[str, Value]:
    return {"Vector": _apply_curves(n, "Vector", list(n.node.mapping.curves[:3]))}


@reads("ShaderNodeFloatCurve")
def float_curve(n: NodeView) -> dict[str, Value]:
    return {"Value": _apply_curves(n, "Value", [n.node.mapping.curves[0]])}
