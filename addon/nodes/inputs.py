# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers of nodes without inputs to speak of: coordinates, attributes, geometry, object, camera, light path, constants."""

from __future__ import annotations

import numpy as np
from opal_kernels.optics import colour

from . import operations as ops
from .camera import camera_matrices
from .compiler import NodeView
from .context import RENDER_COLOR
from .operations import Op
from .program import ONE, ZERO, Table, Value, constant
from .registry import reads


@reads("ShaderNodeValue")
def value(n: NodeView) -> dict[str, Value]:
    return {"Value": n.own_output("Value")}


@reads("ShaderNodeRGB")
def rgb(n: NodeView) -> dict[str, Value]:
    return {"Color": n.own_output("Color")}


@reads("ShaderNodeTexCoord")
def texture_coordinate(n: NodeView) -> dict[str, Value]:
    outputs = {
        "Generated": coordinate(n, "GENERATED"),
        "Normal": coordinate(n, "NORMAL"),
        "UV": uv(n, ""),
        "Object": coordinate(n, "OBJECT"),
        "Reflection": coordinate(n, "REFLECTION"),
    }
    if n.node.from_instancer and (n.output_used("Generated") or n.output_used("UV")):
        n.problem("Coordinates from the instancer are not read; the object's own are taken.")
    if n.node.object is not None:
        rows = np.array(n.node.object.matrix_world.inverted_safe(), np.float64)[:3]
        table = Table(tuple(tuple(float(x) for x in row) for row in rows))
        outputs["Object"] = n.emit(Op.TRANSFORM, ops.TRANSFORM["POINT"], coordinate(n, "POSITION"), table)
    matrices = camera_matrices(n.context)
    if matrices is not None:
        position = coordinate(n, "POSITION")
        if n.is_world:
            position = n.emit(Op.VECTOR_MATH, ops.VECTOR_MATH["ADD"], position, constant(*matrices.position))
        outputs["Camera"] = n.emit(Op.TRANSFORM, ops.TRANSFORM["POINT"], position, Table(matrices.from_world))
        outputs["Window"] = n.emit(Op.TRANSFORM, ops.TRANSFORM["PROJECT"], position, Table(matrices.to_window))
    elif n.output_used("Camera") or n.output_used("Window"):
        n.problem("There is no camera for camera and window coordinates; they are zero.")
        outputs["Camera"] = outputs["Window"] = ZERO
    return outputs


def coordinate(n: NodeView, name: str) -> Value:
    """One of the coordinates that need nothing else."""
    return n.emit(Op.COORDINATE, ops.COORDINATE[name])


def uv(n: NodeView, name: str) -> Value:
    """A UV map; the empty name is the one that renders. Worlds have none."""
    return ZERO if n.is_world else n.emit(Op.ATTRIBUTE, ops.ATTRIBUTE["COLOR"], n.context.attribute_id(name), None)


@reads("ShaderNodeUVMap")
def uv_map(n: NodeView) -> dict[str, Value]:
    if n.node.from_instancer:
        n.problem("UV maps from the instancer are not read; the object's own is taken.")
    return {"UV": uv(n, n.node.uv_map)}


@reads("ShaderNodeAttribute")
def attribute(n: NodeView) -> dict[str, Value]:
    if n.node.attribute_type != "GEOMETRY":
        n.problem("Only attributes of the geometry are read; others are zero.", lost=True)
        return dict.fromkeys(("Color", "Vector", "Fac", "Alpha"), ZERO)
    return _attribute(n, n.node.attribute_name)


@reads("ShaderNodeVolumeInfo")
def volume_info(n: NodeView) -> dict[str, Value]:
    """Grids of smoke under their usual names."""
    names = {"Color": "color", "Density": "density", "Flame": "flame", "Temperature": "temperature"}
    return {output: _attribute(n, name)["Color" if output == "Color" else "Fac"] for output, name in names.items()}


@reads("ShaderNodeVertexColor")
def color_attribute(n: NodeView) -> dict[str, Value]:
    return _attribute(n, n.node.layer_name or RENDER_COLOR)


def _attribute(n: NodeView, name: str) -> dict[str, Value]:
    if not name or n.is_world:
        return dict.fromkeys(("Color", "Vector", "Fac", "Alpha"), ZERO)
    number = n.context.attribute_id(name)
    color = n.emit(Op.ATTRIBUTE, ops.ATTRIBUTE["COLOR"], number, None)
    return {
        "Color": color,
        "Vector": color,
        "Fac": n.emit(Op.ATTRIBUTE, ops.ATTRIBUTE["FACTOR"], number, None),
        "Alpha": n.emit(Op.ATTRIBUTE, ops.ATTRIBUTE["ALPHA"], number, None),
    }


@reads("ShaderNodeNewGeometry")
def geometry(n: NodeView) -> dict[str, Value]:
    outputs = {
        output: n.emit(Op.GEOMETRY, ops.GEOMETRY[name])
        for output, name in (
            ("Position", "POSITION"),
            ("Normal", "NORMAL"),
            ("Tangent", "TANGENT"),
            ("True Normal", "TRUE_NORMAL"),
            ("Incoming", "INCOMING"),
            ("Parametric", "PARAMETRIC"),
            ("Backfacing", "BACKFACING"),
        )
    }
    for output, instead in (("Pointiness", constant(0.5)), ("Random Per Island", ZERO)):
        outputs[output] = instead
        if n.output_used(output):
            n.problem(f"{output} is not computed; it is {instead.number:g} everywhere.")
    return outputs


@reads("ShaderNodeObjectInfo")
def object_info(n: NodeView) -> dict[str, Value]:
    outputs = {
        output: n.emit(Op.OBJECT_INFO, ops.OBJECT[name])
        for output, name in (
            ("Location", "LOCATION"),
            ("Color", "COLOR"),
            ("Alpha", "ALPHA"),
            ("Object Index", "INDEX"),
            ("Random", "RANDOM"),
        )
    }
    outputs["Material Index"] = constant(getattr(n.owner, "pass_index", 0))
    return outputs


@reads("ShaderNodeCameraData")
def camera_data(n: NodeView) -> dict[str, Value]:
    matrices = camera_matrices(n.context)
    if matrices is None:
        n.problem("There is no camera; its data are zero.")
        return dict.fromkeys(("View Vector", "View Z Depth", "View Distance"), ZERO)
    seen = n.emit(Op.TRANSFORM, ops.TRANSFORM["POINT"], coordinate(n, "POSITION"), Table(matrices.from_world))
    return {
        "View Vector": n.emit(Op.VECTOR_MATH, ops.VECTOR_MATH["NORMALIZE"], seen),
        "View Z Depth": n.builder.component(seen, 2),
        "View Distance": n.emit(Op.VECTOR_MATH, ops.VECTOR_MATH["LENGTH"], seen),
    }


_PATH_OUTPUTS = {
    "Is Camera Ray": "IS_CAMERA",
    "Is Shadow Ray": "IS_SHADOW",
    "Is Diffuse Ray": "IS_DIFFUSE",
    "Is Glossy Ray": "IS_GLOSSY",
    "Is Reflection Ray": "IS_REFLECTION",
    "Is Transmission Ray": "IS_TRANSMISSION",
    "Is Volume Scatter Ray": "IS_SCATTER",
    "Ray Length": "LENGTH",
    "Ray Depth": "DEPTH",
}


@reads("ShaderNodeLightPath")
def light_path(n: NodeView) -> dict[str, Value]:
    outputs = {output: n.emit(Op.LIGHT_PATH, ops.PATH[name]) for output, name in _PATH_OUTPUTS.items()}
    for socket in n.node.outputs:
        if socket.name not in outputs:
            outputs[socket.name] = ZERO
            if socket.is_linked:
                n.problem(f"{socket.name} is not known to Opal; it is 0.", lost=True)
    return outputs


@reads("ShaderNodeFresnel")
def fresnel(n: NodeView) -> dict[str, Value]:
    return {"Fac": n.emit(Op.FRESNEL, 0, n.value("IOR"), n.normal())}


@reads("ShaderNodeLayerWeight")
def layer_weight(n: NodeView) -> dict[str, Value]:
    blend, normal = n.value("Blend"), n.normal()
    return {"Fresnel": n.emit(Op.LAYER_WEIGHT, 0, blend, normal), "Facing": n.emit(Op.LAYER_WEIGHT, 1, blend, normal)}


@reads("ShaderNodeTangent")
def tangent(n: NodeView) -> dict[str, Value]:
    node = n.node
    if node.direction_type == "UV_MAP":
        return {"Tangent": n.emit(Op.TANGENT, 3, n.context.attribute_id(node.uv_map))}
    return {"Tangent": n.emit(Op.TANGENT, "XYZ".index(node.axis), -1)}


def _along(n: NodeView, value: Value, low: float, high: float, rows: np.ndarray) -> Value:
    """A table of colours over a range, looked up between its entries."""
    table = Table(tuple((float(r), float(g), float(b), 1.0) for r, g, b in rows))
    where = n.emit(Op.MAP_RANGE, ops.MAP_RANGE["LINEAR"], value, constant(low), constant(high), ZERO, ONE, None, ops.RANGE_CLAMP)
    return n.emit(Op.TABLE, ops.TABLE_INTERPOLATE, where, table, len(rows))


@reads("ShaderNodeBlackbody")
def blackbody(n: NodeView) -> dict[str, Value]:
    """A black body's chromaticity; Planck's law where the temperature is a number, a table of it where it is not."""
    temperature = n.value("Temperature")
    low, high = 800.0, 12000.0  # K
    if temperature.number is not None:
        rgb = np.maximum(colour.blackbody_rec709(min(max(temperature.number, low), high)), 0)
        return {"Color": constant(*map(float, rgb))}
    rows = np.array([colour.blackbody_rec709(k) for k in np.linspace(low, high, 257)])
    return {"Color": _along(n, temperature, low, high, np.maximum(rows, 0))}


@reads("ShaderNodeWavelength")
def wavelength(n: NodeView) -> dict[str, Value]:
    """The colour of a wavelength (nm), scaled as Blender does so that no component passes 1; the gamut's outside is cut off."""
    observer = np.asarray(colour.observer(), np.float64)
    observer = observer if observer.shape[0] == 3 else observer.T
    rows = np.maximum(colour.rec709_from_xyz() @ observer[:, 20:421], 0).T / 2.52  # 380 .. 780 nm
    rows[[0, -1]] = 0
    return {"Color": _along(n, n.value("Wavelength"), 380.0, 780.0, rows)}
