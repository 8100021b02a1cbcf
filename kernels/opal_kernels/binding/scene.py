# SPDX-License-Identifier: GPL-3.0-or-later
"""The ``opal_scene_`` functions: one Python function for one C function."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from ctypes import byref, c_float, c_int32, c_void_p
from typing import Any

import numpy as np

from ..descriptions import SPECTRUM_SIZE, Attribute, Medium, Phase
from .arrays import as_array, as_floats, as_transforms, fill, get, numbers, pointer, program_struct
from .library import OpalError, checked, last_error, library
from .structures import (
    AttributeStruct,
    CameraStruct,
    GemStruct,
    GridFaultsStruct,
    GridStruct,
    ImageStruct,
    InstancesStruct,
    IntPointer,
    LightStruct,
    MaterialStruct,
    MediumStruct,
    MeshStruct,
    PhaseStruct,
    PlacesStruct,
    SceneStatisticsStruct,
    TablesStruct,
    WorldStruct,
)


def scene_create(observer: Any, d65: Any, basis: Any, embree_path: str | None = None, threads: int = 0) -> int:
    """An empty scene.

    Parameters
    ----------
    observer, basis : array_like
        (3, 471): CIE 1931 matching functions; uplift basis for red, green, blue.
    d65 : array_like
        (471,): relative power of D65.
    embree_path : str, optional
        File or soname; None searches the running process.
    threads : int
        0 takes every core.

    Returns
    -------
    int
        The handle, to be given to `scene_destroy` once.
    """
    observer = as_floats("observer", observer, (3, SPECTRUM_SIZE))
    d65 = as_floats("d65", d65, (SPECTRUM_SIZE,))
    basis = as_floats("basis", basis, (3, SPECTRUM_SIZE))
    tables = TablesStruct(pointer(observer), pointer(d65), pointer(basis))
    path = embree_path.encode() if embree_path else None
    handle = library().opal_scene_create(byref(tables), path, threads)
    if not handle:
        raise OpalError(last_error() or "The scene could not be created.")
    return handle


def scene_destroy(scene: int) -> None:
    """Frees a scene."""
    library().opal_scene_destroy(scene)


def scene_add_image(scene: int, pixels: np.ndarray, transfer: int = 0) -> int:
    """Adds an image.

    Parameters
    ----------
    pixels : ndarray
        uint8 or float32 of shape (height, width, 1, 3 or 4), rows from the bottom up.
    transfer : Transfer
        Decoding applied after interpolation.

    Returns
    -------
    int
        The image's number.
    """
    kind = np.uint8 if np.asarray(pixels).dtype == np.uint8 else np.float32
    pixels = as_array("pixels", pixels, kind, (None, None, None), finite=False)
    height, width, channels = pixels.shape
    struct = ImageStruct(width, height, channels, 0 if kind is np.uint8 else 1, int(transfer), 0, pixels.ctypes.data_as(c_void_p))
    return checked(library().opal_scene_add_image(scene, byref(struct)))


def scene_add_spectrum(scene: int, values: Any) -> int:
    """Adds a table of 471 values, 360 to 830 nm, and returns its number."""
    values = as_floats("spectrum", values, (SPECTRUM_SIZE,))
    return checked(library().opal_scene_add_spectrum(scene, pointer(values)))


def scene_set_spectrum(scene: int, spectrum: int, values: Any) -> None:
    """Replaces a table of `scene_add_spectrum`; `scene_commit` afterwards."""
    values = as_floats("spectrum", values, (SPECTRUM_SIZE,))
    checked(library().opal_scene_set_spectrum(scene, spectrum, pointer(values)))


def scene_add_phase(scene: int, phase: Phase) -> int:
    """Adds a phase function and returns its number.

    Parameters
    ----------
    phase : Phase
        A table's rows are normalised by the kernels; its wavelengths and angles have to ascend.
    """
    struct = PhaseStruct(kind=int(phase.kind), anisotropy=float(phase.anisotropy))
    keep = []
    if phase.values is not None:
        wavelengths = as_floats("wavelengths", phase.wavelengths, (None,))
        angles = as_floats("angles", phase.angles, (None,))
        shape: tuple[int, ...] = (len(wavelengths), len(angles))
        keep = [wavelengths, angles]
        if phase.elevations is not None:
            elevations, clocks = as_floats("elevations", phase.elevations, (None,)), as_floats("clocks", phase.clocks, (None,))
            shape = (len(elevations), len(clocks), *shape)
            struct.n_elevations, struct.n_clocks = len(elevations), len(clocks)
            struct.elevations, struct.clocks = pointer(elevations), pointer(clocks)
            keep += [elevations, clocks]
        values = as_floats("values", phase.values, shape)
        keep.append(values)
        struct.n_wavelengths, struct.n_angles = len(wavelengths), len(angles)
        struct.wavelengths, struct.angles, struct.values = map(pointer, (wavelengths, angles, values))
        if phase.polarization is not None:
            polarization = as_floats("polarization", phase.polarization, shape)
            keep.append(polarization)
            struct.polarization = pointer(polarization)
    return checked(library().opal_scene_add_phase(scene, byref(struct)))


def scene_add_medium(scene: int, medium: Medium) -> int:
    """Adds a medium, made of spectra and a phase function of this scene, and returns its number."""
    return checked(library().opal_scene_add_medium(scene, byref(fill(MediumStruct(), medium))))


def scene_add_grid(scene: int, size: Sequence[int], transform: Any, channels: int = 1) -> int:
    """Adds a grid of zeros and returns its number.

    Parameters
    ----------
    size : sequence of int
        Voxels along x, y and z.
    transform : array_like
        (3, 4) or (4, 4): index space to the space of the object that holds the medium. Voxel (i, j, k) is a sample at (i, j, k).
    channels : int
        1, or 3 for colours.

    Raises
    ------
    OpalError
        Naming the size, if the grid does not fit into memory.
    """
    matrix = np.asarray(transform, np.float64)[:3]
    if matrix.shape != (3, 4) or not np.isfinite(matrix).all():
        raise OpalError("The grid's transform takes 3 x 4 finite numbers.")
    struct = GridStruct((c_int32 * 3)(*map(int, size)), int(channels), (c_float * 12)(*matrix.ravel().tolist()))
    return checked(library().opal_scene_add_grid(scene, byref(struct)))


def scene_set_grid_block(scene: int, grid: int, values: Any, origin: Sequence[int] = (0, 0, 0)) -> tuple[int, int]:
    """Writes a block of a grid.

    Parameters
    ----------
    values : array_like
        (x, y, z) or, for colours, (x, y, z, 3). What is not finite or is negative becomes 0.
    origin : sequence of int
        The block's first voxel.

    Returns
    -------
    (int, int)
        How many values were not finite, and how many were negative.
    """
    values = np.asarray(values)
    values = as_floats("values", values, (None,) * values.ndim, finite=False)
    if values.ndim not in {3, 4}:
        raise OpalError("A block of voxels has three axes, or four with colours.")
    size = np.array(values.shape[:3], np.int32)
    first = np.array(origin, np.int32)
    faults = GridFaultsStruct()
    checked(
        library().opal_scene_set_grid_block(
            scene, grid, first.ctypes.data_as(IntPointer), size.ctypes.data_as(IntPointer), pointer(values), byref(faults)
        )
    )
    return int(faults.not_finite), int(faults.negative)


def scene_set_medium_layer(scene: int, medium: int, layer: int) -> None:
    """Says which compositing layer (`MediumLayer`) shows what a medium scatters."""
    checked(library().opal_scene_set_medium_layer(scene, medium, layer))


def scene_set_world_medium(scene: int, medium: int) -> None:
    """Fills the world with a medium; -1 takes it away."""
    checked(library().opal_scene_set_world_medium(scene, medium))


def _material(program: Any, gem: Any, flags: int, keep: list[Any], medium: int = -1) -> MaterialStruct:
    struct = MaterialStruct(flags=int(flags), medium=medium + 1)
    if program is not None:
        struct.surface = program_struct(program, keep)
    if gem is not None:
        keep.append(fill(GemStruct(), gem))
        struct.gem = ctypes.pointer(keep[-1])
    return struct


def scene_add_material(scene: int, program: Any = None, gem: Any = None, flags: int = 0, medium: int = -1) -> int:
    """Adds a material and returns its number.

    Parameters
    ----------
    program : Program, optional
        May be left out where ``gem`` is given.
    gem : Gem, optional
        Replaces the program by a dielectric boundary.
    flags : MaterialFlag
    medium : int
        What fills the inside of the closed mesh, or -1.
    """
    keep: list[Any] = []
    return checked(library().opal_scene_add_material(scene, byref(_material(program, gem, flags, keep, medium))))


def scene_update_material(scene: int, index: int, program: Any = None, gem: Any = None, flags: int = 0, medium: int = -1) -> None:
    """Replaces a material."""
    keep: list[Any] = []
    checked(library().opal_scene_update_material(scene, index, byref(_material(program, gem, flags, keep, medium))))


def scene_evaluate(
    scene: int,
    program: Any,
    positions: Any,
    *,
    generated: Any = None,
    transform: Any = None,
    object_info: Any = None,
    attributes: Sequence[Attribute] = (),
) -> np.ndarray:
    """What a program emits at places inside of an object.

    Parameters
    ----------
    program : Program
        Its emission is the answer.
    positions : array_like
        (n, 3), object space.
    generated : array_like, optional
        (n, 3) texture coordinates.
    transform : array_like, optional
        (3, 4) or (4, 4), object to world; None is the identity.
    object_info : array_like, optional
        (8,), as for `scene_add_instances`.
    attributes : sequence of Attribute
        One value a place.

    Returns
    -------
    ndarray
        (n, 3) float32, linear Rec.709.
    """
    positions = as_floats("positions", positions, (None, 3))
    n = len(positions)
    keep: list[Any] = [positions]
    places = PlacesStruct(n=n, positions=pointer(positions))
    if generated is not None:
        keep.append(as_floats("generated", generated, (n, 3)))
        places.generated = pointer(keep[-1])
    if transform is not None:
        keep.append(as_floats("transform", np.asarray(transform, np.float32)[:3].reshape(12), (12,)))
        places.transform = pointer(keep[-1])
    if object_info is not None:
        keep.append(as_floats("object_info", object_info, (8,)))
        places.object_info = pointer(keep[-1])
    structs = (AttributeStruct * len(attributes))()
    for struct, attribute in zip(structs, attributes, strict=True):
        values = np.asarray(attribute.values, np.float32)
        values = as_floats("attribute", values.reshape(n, -1) if n else values.reshape(0, 1), (n, None), finite=False)
        keep.append(values)
        struct.name, struct.domain, struct.components = attribute.name, 1, values.shape[1]
        struct.values = pointer(values)
    places.attributes, places.n_attributes = structs, len(attributes)
    out = np.zeros((n, 3), np.float32)
    checked(library().opal_scene_evaluate(scene, byref(program_struct(program, keep)), byref(places), pointer(out)))
    return out


def scene_add_mesh(
    scene: int,
    positions: Any,
    triangles: Any,
    *,
    positions_start: Any = None,
    positions_end: Any = None,
    corner_normals: Any = None,
    corner_tangents: Any = None,
    material_slots: Any = None,
    generated: Any = None,
    attributes: Sequence[Attribute] = (),
) -> tuple[int, int]:
    """Adds a mesh of triangles.

    Parameters
    ----------
    positions : array_like
        (n, 3) vertices; with motion, in the middle of the shutter. Not held to be finite: their triangles are dropped.
    positions_start, positions_end : array_like, optional
        (n, 3) vertices at shutter open and close: both or neither. They go straight from key to key.
    triangles : array_like
        (m, 3) vertex numbers.
    corner_normals, corner_tangents : array_like, optional
        (m, 3, 3) unit normals; (m, 3, 4) tangents with their sign. Without normals faces are flat.
    material_slots : array_like, optional
        (m,) slot of each triangle.
    generated : array_like, optional
        (n, 3) texture coordinates; None takes them from the bounds.
    attributes : sequence of Attribute

    Returns
    -------
    (int, int)
        The mesh's number, and how many triangles were dropped.
    """
    positions = as_floats("positions", positions, (None, 3), finite=False)
    triangles = as_array("triangles", triangles, np.int32, (None, 3))
    n, m = len(positions), len(triangles)
    if positions_start is not None:
        positions_start = as_floats("positions_start", positions_start, (n, 3), finite=False)
    if positions_end is not None:
        positions_end = as_floats("positions_end", positions_end, (n, 3), finite=False)
    if corner_normals is not None:
        corner_normals = as_floats("corner_normals", np.reshape(corner_normals, (-1, 9)), (m, 9), finite=False)
    if corner_tangents is not None:
        corner_tangents = as_floats("corner_tangents", np.reshape(corner_tangents, (-1, 12)), (m, 12), finite=False)
    if material_slots is not None:
        material_slots = as_array("material_slots", material_slots, np.int32, (m,))
    if generated is not None:
        generated = as_floats("generated", generated, (n, 3), finite=False)
    counts = (3 * m, n, m)
    structs = (AttributeStruct * len(attributes))()
    keep = []
    for struct, attribute in zip(structs, attributes, strict=True):
        values = np.asarray(attribute.values)
        values = as_floats("attribute", values.reshape(len(values), -1), (counts[attribute.domain], None), finite=False)
        keep.append(values)
        struct.name, struct.domain, struct.components = attribute.name, int(attribute.domain), values.shape[1]
        struct.values = pointer(values)
    mesh = MeshStruct(
        n_vertices=n,
        n_triangles=m,
        positions=pointer(positions),
        positions_start=pointer(positions_start),
        positions_end=pointer(positions_end),
        triangles=pointer(triangles, IntPointer),
        corner_normals=pointer(corner_normals),
        corner_tangents=pointer(corner_tangents),
        material_slots=pointer(material_slots, IntPointer),
        generated=pointer(generated),
        attributes=structs if attributes else None,
        n_attributes=len(attributes),
    )
    dropped = c_int32(0)
    return checked(library().opal_scene_add_mesh(scene, byref(mesh), byref(dropped))), dropped.value


def scene_add_instances(
    scene: int,
    mesh: int,
    transforms: Any,
    materials: Any = (),
    *,
    transforms_start: Any = None,
    transforms_end: Any = None,
    visibility: int = 63,
    object_info: Any = None,
    holdout: bool = False,
    light_group: int = -1,
) -> int:
    """Adds copies of a mesh and returns the number of the first.

    Parameters
    ----------
    transforms : array_like
        (count, 3, 4), (count, 4, 4) or (count, 12): object to world; with motion, in the middle of the shutter.
    transforms_start, transforms_end : array_like, optional
        The same at shutter open and close: both or neither. Turn, place and scale go from key to key each by themselves.
    materials : array_like
        Material number of each slot; -1 is the default grey.
    visibility : Ray
        Kinds of ray that see them.
    object_info : array_like, optional
        (count, 8): random 0..1, object index, colour RGBA, two unused.
    holdout : bool
        They cut the film's alpha.
    light_group : int
        Receiver set for light linking, -1 for every light.
    """
    transforms = as_transforms("transforms", transforms)
    count = len(transforms)
    if transforms_start is not None:
        transforms_start = as_transforms("transforms_start", transforms_start, count)
    if transforms_end is not None:
        transforms_end = as_transforms("transforms_end", transforms_end, count)
    materials = as_array("materials", np.asarray(materials, dtype=np.int32), np.int32, (None,))
    if object_info is not None:
        object_info = as_floats("object_info", object_info, (count, 8))
    struct = InstancesStruct(
        mesh=mesh,
        count=count,
        transforms=pointer(transforms),
        transforms_start=pointer(transforms_start),
        transforms_end=pointer(transforms_end),
        materials=pointer(materials, IntPointer),
        n_materials=len(materials),
        visibility=int(visibility),
        object_info=pointer(object_info),
        holdout=int(holdout),
        light_group=int(light_group),
    )
    return checked(library().opal_scene_add_instances(scene, byref(struct)))


def scene_set_transforms(
    scene: int, first_instance: int, transforms: Any, transforms_start: Any = None, transforms_end: Any = None
) -> None:
    """Moves instances; shapes as in `scene_add_instances`."""
    transforms = as_transforms("transforms", transforms)
    count = len(transforms)
    if transforms_start is not None:
        transforms_start = as_transforms("transforms_start", transforms_start, count)
    if transforms_end is not None:
        transforms_end = as_transforms("transforms_end", transforms_end, count)
    keys = map(pointer, (transforms, transforms_start, transforms_end))
    checked(library().opal_scene_set_transforms(scene, first_instance, count, *keys))


def scene_add_light(scene: int, light: Any) -> int:
    """Adds a `descriptions.Light` (or anything with its fields) and returns its number."""
    return checked(library().opal_scene_add_light(scene, byref(fill(LightStruct(), light))))


def scene_clear_lights(scene: int) -> None:
    """Takes every lamp away."""
    checked(library().opal_scene_clear_lights(scene))


def scene_set_world(scene: int, world: Any) -> None:
    """Sets a `descriptions.World`; None, or one without a program, is black."""
    if world is None or get(world, "program") is None:
        checked(library().opal_scene_set_world(scene, None))
        return
    keep: list[Any] = []
    struct = fill(WorldStruct(), world, skip=("program",))
    struct.program = program_struct(get(world, "program"), keep)
    checked(library().opal_scene_set_world(scene, byref(struct)))


def scene_set_camera(scene: int, camera: Any) -> None:
    """Sets a `descriptions.Camera`; at an end of the shutter that it does not give it stands as in the middle."""
    ends = ("transform_start", "transform_end")
    struct = fill(CameraStruct(), camera, skip=ends)
    for name in ends:
        end = get(camera, name)
        if end is None:
            setattr(struct, name, struct.transform)
        else:
            setattr(struct, name, (c_float * 12)(*as_transforms(f"camera.{name}", np.asarray(end)[None, :3], 1)[0]))
    checked(library().opal_scene_set_camera(scene, byref(struct)))


def scene_commit(scene: int) -> None:
    """Builds what changed: acceleration structures, light tables, bounds of what makes caustics; without the interpreter lock.

    Raises
    ------
    Cancelled
        If `scene_cancel` was called meanwhile or before; the next commit builds what this one left.
    """
    checked(library().opal_scene_commit(scene))


def scene_cancel(scene: int) -> None:
    """Asks the commit that runs, or else the next one, to stop; from any thread."""
    library().opal_scene_cancel(scene)


def scene_get_statistics(scene: int) -> dict[str, Any]:
    """Counts, memory (bytes), build time (s) and how often what was built, of a committed scene."""
    struct = SceneStatisticsStruct()
    checked(library().opal_scene_get_statistics(scene, byref(struct)))
    return numbers(struct)


def scene_intersect(scene: int, origins: Any, directions: Any) -> dict[str, np.ndarray]:
    """Nearest hits of n rays.

    Parameters
    ----------
    origins, directions : array_like
        (n, 3), metres and unit vectors.

    Returns
    -------
    dict
        ``distance`` (n,) with inf where nothing is hit, ``instance`` (n,), ``triangle`` (n,), ``barycentrics`` (n, 2).
    """
    origins = as_floats("origins", origins, (None, 3))
    n = len(origins)
    directions = as_floats("directions", directions, (n, 3))
    out = {
        "distance": np.empty(n, np.float32),
        "instance": np.empty(n, np.int32),
        "triangle": np.empty(n, np.int32),
        "barycentrics": np.empty((n, 2), np.float32),
    }
    checked(
        library().opal_scene_intersect(
            scene,
            n,
            pointer(origins),
            pointer(directions),
            pointer(out["distance"]),
            pointer(out["instance"], IntPointer),
            pointer(out["triangle"], IntPointer),
            pointer(out["barycentrics"]),
        )
    )
    return out
