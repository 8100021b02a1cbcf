# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated meshes as arrays, by `foreach_get` alone: no Python loop runs over vertices, corners or faces.

Blender keeps per-corner data for polygons; the tracer wants it per triangle corner. `corner` below is the number of the
polygon's corner that each of the 3 corners of each triangle comes from, and everything per corner is picked through it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..nodes.context import RENDER_COLOR

# Attribute types that shaders can read: RNA name of the value, components.
_READERS = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int32, 1),
    "BOOLEAN": ("value", np.bool_, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "QUATERNION": ("value", np.float32, 4),
    "INT32_2D": ("value", np.int32, 2),
    "INT16_2D": ("value", np.int32, 2),
}
_DOMAINS = {"CORNER": 0, "POINT": 1, "FACE": 2}


@dataclass
class MeshArrays:
    """What `binding.scene_add_mesh` takes, under its names, and what could not be read."""

    positions: np.ndarray
    triangles: np.ndarray
    corner_normals: np.ndarray | None = None
    corner_tangents: np.ndarray | None = None
    material_slots: np.ndarray | None = None
    generated: np.ndarray | None = None
    motion: list[np.ndarray] = field(default_factory=list)  # positions at shutter open and close, where they were read
    attributes: list[tuple[int, int, np.ndarray]] = field(default_factory=list)  # name, domain, values
    problems: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class MeshNeeds:
    """What the materials of a mesh read beside its shape.

    Attributes
    ----------
    attributes : mapping
        Attribute name to the number programs use; an empty name stands for the UV map that renders,
        `RENDER_COLOR` for the colours that do.
    tangent_uv : str or None
        UV map whose tangents a normal map needs; an empty name stands for the one that renders.
    generated : bool
        Whether a program reads Generated coordinates.
    """

    attributes: Mapping[str, int] = field(default_factory=dict)
    tangent_uv: str | None = None
    generated: bool = True


def _read(collection: Any, name: str, count: int, components: int, dtype: Any) -> np.ndarray:
    values = np.empty(count * components, dtype)
    collection.foreach_get(name, values)
    return values.reshape(count, components) if components > 1 else values


def _attribute(mesh: Any, name: str, components: int, dtype: Any, property_name: str) -> np.ndarray:
    data = mesh.attributes[name].data
    return _read(data, property_name, len(data), components, dtype)


def _nothing() -> None:
    pass


def read_mesh(mesh: Any, needs: MeshNeeds | None = None, between: Callable[[], None] = _nothing) -> MeshArrays | None:
    """Arrays of an evaluated mesh.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        Evaluated, not in edit mode.
    needs : MeshNeeds, optional
        What else to read; None reads the shape alone.
    between : callable
        Called between the parts, each of which takes a while for millions of triangles; may raise to give up.

    Returns
    -------
    MeshArrays or None
        None for a mesh without faces.
    """
    needs = needs if needs is not None else MeshNeeds(generated=False)
    if len(mesh.polygons) == 0:
        return None
    mesh.calc_loop_triangles()
    between()
    n_triangles = len(mesh.loop_triangles)
    if n_triangles == 0:
        return None
    n_vertices, n_corners = len(mesh.vertices), len(mesh.loops)
    polygon_corners_only = n_corners == 3 * n_triangles and len(mesh.polygons) == n_triangles
    corner = (
        np.arange(n_corners, dtype=np.int32)
        if polygon_corners_only
        else _read(mesh.loop_triangles, "loops", n_triangles, 3, np.int32).reshape(-1)
    )
    polygon = _read(mesh.loop_triangle_polygons, "value", n_triangles, 1, np.int32)
    vertex = _attribute(mesh, ".corner_vert", 1, np.int32, "value")[corner]
    arrays = MeshArrays(positions=_attribute(mesh, "position", 3, np.float32, "vector"), triangles=vertex.reshape(n_triangles, 3))
    between()

    if mesh.normals_domain == "POINT":
        arrays.corner_normals = _read(mesh.vertex_normals, "vector", n_vertices, 3, np.float32)[vertex]
    elif mesh.normals_domain == "CORNER":
        arrays.corner_normals = _read(mesh.corner_normals, "vector", n_corners, 3, np.float32)[corner]
    between()

    slots = mesh.attributes.get("material_index")
    if slots is not None and slots.domain == "FACE":
        arrays.material_slots = _read(slots.data, "value", len(slots.data), 1, np.int32)[polygon]

    if needs.generated:
        arrays.generated = _generated(mesh, n_vertices)
    for name, number in needs.attributes.items():
        between()
        if (values := _shader_attribute(mesh, name, corner, polygon, arrays.problems)) is not None:
            arrays.attributes.append((number, *values))
    if needs.tangent_uv is not None:
        between()
        arrays.corner_tangents = _tangents(mesh, needs.tangent_uv, corner, arrays)
    return arrays


def is_closed(mesh: Any) -> bool:
    """Whether every edge of an evaluated mesh has two faces, so that the mesh has an inside."""
    if len(mesh.polygons) == 0:
        return False
    edges = _attribute(mesh, ".corner_edge", 1, np.int32, "value")
    faces = np.bincount(edges, minlength=len(mesh.edges))
    return bool(((faces == 2) | (faces == 0)).all())


def box_of(mesh: Any) -> tuple[np.ndarray, np.ndarray]:
    """Corners (low, high) of a mesh that has vertices."""
    positions = _attribute(mesh, "position", 3, np.float32, "vector")
    return positions.min(axis=0).astype(float), positions.max(axis=0).astype(float)


def box_mesh(low: np.ndarray, high: np.ndarray) -> MeshArrays:
    """A closed box: what bounds the grids of a volume object."""
    corners = np.array([[(low, high)[i >> a & 1][a] for a in range(3)] for i in range(8)], np.float32)
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return MeshArrays(corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.int32))


def _generated(mesh: Any, n_vertices: int) -> np.ndarray:
    """Generated coordinates: the undeformed vertices in the mesh's texture space, 0 to 1."""
    undeformed = _read(mesh.vertices, "undeformed_co", n_vertices, 3, np.float32)
    center = np.array(mesh.texspace_location, np.float32)
    half = np.array(mesh.texspace_size, np.float32)
    half[half == 0] = 1
    return ((undeformed - center) / half * np.float32(0.5) + np.float32(0.5)).astype(np.float32)


def _render_uv_name(mesh: Any) -> str | None:
    for layer in mesh.uv_layers:
        if layer.active_render:
            return layer.name
    return mesh.uv_layers[0].name if len(mesh.uv_layers) else None


def _shader_attribute(mesh: Any, name: str, corner: np.ndarray, polygon: np.ndarray, problems: list[str]) -> tuple[int, np.ndarray] | None:
    """Domain and values of an attribute as float32, or None where the mesh has none of that name."""
    name = mesh.attributes.default_color_name if name == RENDER_COLOR else name or _render_uv_name(mesh)
    attribute = mesh.attributes.get(name) if name else None
    if attribute is None:
        return None
    reader = _READERS.get(attribute.data_type)
    if reader is None or attribute.domain not in _DOMAINS:
        kind = f"{attribute.data_type.lower()} on {attribute.domain.lower()}s"
        problems.append(f"the attribute “{name}” ({kind}) cannot be read by shaders")
        return None
    property_name, dtype, components = reader
    values = _read(attribute.data, property_name, len(attribute.data), components, dtype)
    if attribute.domain == "CORNER":
        values = values[corner]
    elif attribute.domain == "FACE":
        values = values[polygon]
    return _DOMAINS[attribute.domain], values.astype(np.float32, copy=False).reshape(len(values), components)


def _tangents(mesh: Any, uv_name: str, corner: np.ndarray, arrays: MeshArrays) -> np.ndarray | None:
    """MikkTSpace tangents by Blender (triangles and quads), else from the derivatives of the UV map a triangle."""
    name = uv_name or _render_uv_name(mesh)
    if name is None or name not in mesh.uv_layers:
        return None
    n_corners = len(mesh.loops)
    try:
        mesh.calc_tangents(uvmap=name)
    except RuntimeError:  # polygons of more than four corners
        uv = _read(mesh.uv_layers[name].uv, "vector", n_corners, 2, np.float32)[corner].reshape(-1, 3, 2)
        return triangle_tangents(arrays.positions[arrays.triangles], uv)
    tangents = np.empty((len(corner), 4), np.float32)
    tangents[:, :3] = _read(mesh.loops, "tangent", n_corners, 3, np.float32)[corner]
    tangents[:, 3] = _read(mesh.loops, "bitangent_sign", n_corners, 1, np.float32)[corner]
    mesh.free_tangents()
    return tangents.reshape(-1, 3, 4)


def triangle_tangents(corners: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Tangents that are constant over a triangle: dp/du, and the sign of the UV map's winding.

    Parameters
    ----------
    corners : ndarray
        (m, 3, 3) positions.
    uv : ndarray
        (m, 3, 2) texture coordinates.

    Returns
    -------
    ndarray
        (m, 3, 4): unit tangent and sign, the same at the 3 corners; (1, 0, 0, 1) where the map is degenerate.
    """
    edge1, edge2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    d1, d2 = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    winding = d1[:, 0] * d2[:, 1] - d2[:, 0] * d1[:, 1]
    direction = (edge1 * d2[:, 1:2] - edge2 * d1[:, 1:2]) * np.sign(winding)[:, None]
    length = np.linalg.norm(direction, axis=1)
    out = np.zeros((len(corners), 4), np.float32)
    out[:, 0] = out[:, 3] = 1
    good = length > 0
    out[good, :3] = direction[good] / length[good, None]
    out[good, 3] = np.sign(winding[good])
    return np.repeat(out[:, None, :], 3, axis=1)
