# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers of nodes that work on vectors: Vector Math, Mapping, rotations and transforms, bump and normal maps, displacement."""

from __future__ import annotations

from . import operations as ops
from .camera import camera_matrices
from .compiler import NodeView
from .operations import Op
from .program import ONE, ZERO, Table, Value, constant
from .registry import reads

_GIVES_NUMBER = {"DOT_PRODUCT", "DISTANCE", "LENGTH"}


@reads("ShaderNodeVectorMath")
def vector_math(n: NodeView) -> dict[str, Value]:
    operation = n.node.operation
    inputs = map(n.value, ("Vector", "Vector_001", "Vector_002", "Scale"))
    result = n.emit(Op.VECTOR_MATH, ops.VECTOR_MATH[operation], *inputs)
    return {"Value": result, "Vector": ZERO} if operation in _GIVES_NUMBER else {"Vector": result, "Value": ZERO}


@reads("ShaderNodeMapping")
def mapping(n: NodeView) -> dict[str, Value]:
    inputs = map(n.value, ("Vector", "Location", "Rotation", "Scale"))
    return {"Vector": n.emit(Op.MAPPING, ops.MAPPING[n.node.vector_type], *inputs)}


@reads("ShaderNodeVectorRotate")
def vector_rotate(n: NodeView) -> dict[str, Value]:
    inputs = map(n.value, ("Vector", "Center", "Axis", "Angle", "Rotation"))
    mode = ops.VECTOR_ROTATE[n.node.rotation_type]
    return {"Vector": n.emit(Op.VECTOR_ROTATE, mode, *inputs, int(n.node.invert))}


@reads("ShaderNodeNormal")
def normal(n: NodeView) -> dict[str, Value]:
    normalize = ops.VECTOR_MATH["NORMALIZE"]
    direction = n.emit(Op.VECTOR_MATH, normalize, constant(*n.node.outputs["Normal"].default_value))
    given = n.emit(Op.VECTOR_MATH, normalize, n.value("Normal"))
    return {"Normal": direction, "Dot": n.emit(Op.VECTOR_MATH, ops.VECTOR_MATH["DOT_PRODUCT"], direction, given)}


@reads("ShaderNodeVectorTransform")
def vector_transform(n: NodeView) -> dict[str, Value]:
    node = n.node
    mode = ops.TRANSFORM[node.vector_type]
    value = n.value("Vector")
    if node.convert_from == node.convert_to:
        return {"Vector": value}
    if "CAMERA" in (node.convert_from, node.convert_to) and camera_matrices(n.context) is None:
        n.problem("There is no camera to transform by; the vector is left as it is.")
        return {"Vector": value}
    if node.convert_from == "OBJECT":
        value = n.emit(Op.TO_WORLD, mode, value)
    elif node.convert_from == "CAMERA":
        value = _by_camera(n, mode, value, to_camera=False)
    if node.convert_to == "OBJECT":
        value = n.emit(Op.TO_OBJECT, mode, value)
    elif node.convert_to == "CAMERA":
        value = _by_camera(n, mode, value, to_camera=True)
    return {"Vector": value}


def _by_camera(n: NodeView, mode: int, value: Value, to_camera: bool) -> Value:
    matrices = camera_matrices(n.context)
    is_normal = mode == ops.TRANSFORM["NORMAL"]
    # Normals go by the transposed inverse.
    matrix = matrices.from_world if to_camera != is_normal else matrices.to_world
    return n.emit(Op.TRANSFORM, mode, value, Table(matrix))


@reads("ShaderNodeNormalMap")
def normal_map(n: NodeView) -> dict[str, Value]:
    node = n.node
    uv = n.context.attribute_id(node.uv_map) if node.space == "TANGENT" else -1
    flip = int(getattr(node, "convention", "OPENGL") == "DIRECTX")
    mode = ops.NORMAL_MAP[node.space]
    return {"Normal": n.emit(Op.NORMAL_MAP, mode, n.value("Color"), n.value("Strength"), uv, flip)}


@reads("ShaderNodeBump")
def bump(n: NodeView) -> dict[str, Value]:
    height = n.linked("Height")
    if height is None or height.constant is not None:
        return {"Normal": n.normal() or n.emit(Op.GEOMETRY, ops.GEOMETRY["NORMAL"])}
    inputs = (n.value("Strength"), n.value("Distance"), n.normal(), n.value("Filter Width", ONE), int(n.node.invert))
    return {"Normal": n.emit(Op.BUMP, 0, height, *inputs)}


@reads("ShaderNodeDisplacement")
def displacement(n: NodeView) -> dict[str, Value]:
    """The height alone: Opal shades displacement as bump, and does not move the surface."""
    height = n.builder.math("SUBTRACT", n.value("Height"), n.value("Midlevel"))
    return {"Displacement": n.builder.math("MULTIPLY", height, n.value("Scale"))}
