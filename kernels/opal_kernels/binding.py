# SPDX-License-Identifier: GPL-3.0-or-later
"""The C interface of ``include/opal.h`` by ctypes: one Python function for one C function, and nothing else.

Structures mirror the header field by field (``tests/kernels/test_binding_layout.py`` holds them to a C compiler's offsets).
Arrays are checked at the door: converted to the C type where that loses nothing, held to their shape, and refused
when a value is not finite where the kernels need finite ones. A failure is an `OpalError` with the kernels' sentence.
Foreign calls release the interpreter lock.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Iterable, Mapping, Sequence
from ctypes import POINTER, byref, c_char_p, c_double, c_float, c_int32, c_int64, c_uint32, c_uint64, c_void_p
from typing import Any

import numpy as np

from . import libraries
from .descriptions import PASS_CHANNELS, SPECTRUM_SIZE, Attribute, Pass

API_VERSION = 1
CANCELLED = -4


class OpalError(RuntimeError):
    """The kernels refused or failed; the message is one sentence."""


class Cancelled(OpalError):
    """The pass was cancelled; the film holds complete passes only."""


# ---- Structures, in the order of opal.h -------------------------------------------------------------------------------

_float_p = POINTER(c_float)
_int_p = POINTER(c_int32)


class TablesStruct(ctypes.Structure):
    _fields_ = [("observer", _float_p), ("d65", _float_p), ("basis", _float_p)]


class ImageStruct(ctypes.Structure):
    _fields_ = [
        ("width", c_int32),
        ("height", c_int32),
        ("channels", c_int32),
        ("pixel_type", c_int32),
        ("transfer", c_int32),
        ("reserved", c_int32),
        ("pixels", c_void_p),
    ]


class InstructionStruct(ctypes.Structure):
    _fields_ = [("op", c_int32), ("mode", c_int32), ("out", c_int32), ("in", c_int32 * 13)]


class ProgramStruct(ctypes.Structure):
    _fields_ = [
        ("code", POINTER(InstructionStruct)),
        ("n_instructions", c_int32),
        ("n_constants", c_int32),
        ("constants", _float_p),
        ("n_registers", c_int32),
        ("reserved", c_int32),
    ]


class GemStruct(ctypes.Structure):
    _fields_ = [
        ("index_spectrum", c_int32),
        ("absorption_spectrum", c_int32),
        ("roughness", c_float),
        ("fresnel", c_int32),
        ("priority", c_int32),
        ("reserved", c_int32),
    ]


class MaterialStruct(ctypes.Structure):
    _fields_ = [("surface", ProgramStruct), ("gem", POINTER(GemStruct)), ("flags", c_uint32), ("medium", c_int32)]


class PhaseStruct(ctypes.Structure):
    _fields_ = [
        ("kind", c_int32),
        ("anisotropy", c_float),
        ("n_wavelengths", c_int32),
        ("n_angles", c_int32),
        ("wavelengths", _float_p),
        ("angles", _float_p),
        ("values", _float_p),
    ]


class MediumStruct(ctypes.Structure):
    _fields_ = [("extinction", c_int32), ("scattering", c_int32), ("emission", c_int32), ("phase", c_int32)]


class AttributeStruct(ctypes.Structure):
    _fields_ = [
        ("name", c_int32),
        ("domain", c_int32),
        ("components", c_int32),
        ("reserved", c_int32),
        ("values", _float_p),
    ]


class MeshStruct(ctypes.Structure):
    _fields_ = [
        ("n_vertices", c_int32),
        ("n_triangles", c_int32),
        ("positions", _float_p),
        ("positions_end", _float_p),
        ("triangles", _int_p),
        ("corner_normals", _float_p),
        ("corner_tangents", _float_p),
        ("material_slots", _int_p),
        ("generated", _float_p),
        ("attributes", POINTER(AttributeStruct)),
        ("n_attributes", c_int32),
        ("reserved", c_int32),
    ]


class InstancesStruct(ctypes.Structure):
    _fields_ = [
        ("mesh", c_int32),
        ("count", c_int32),
        ("transforms", _float_p),
        ("transforms_end", _float_p),
        ("materials", _int_p),
        ("n_materials", c_int32),
        ("visibility", c_uint32),
        ("object_info", _float_p),
        ("holdout", c_int32),
        ("light_group", c_int32),
    ]


class LightStruct(ctypes.Structure):
    _fields_ = [
        ("type", c_int32),
        ("spectrum", c_int32),
        ("transform", c_float * 12),
        ("color", c_float * 3),
        ("power", c_float),
        ("radius", c_float),
        ("spot_angle", c_float),
        ("spot_blend", c_float),
        ("size_u", c_float),
        ("size_v", c_float),
        ("spread", c_float),
        ("visibility", c_uint32),
        ("cast_shadow", c_int32),
        ("normalize", c_int32),
        ("caustics", c_int32),
        ("soft_falloff", c_int32),
        ("reserved", c_int32),
        ("receivers", c_uint64),
    ]


class WorldStruct(ctypes.Structure):
    _fields_ = [
        ("program", ProgramStruct),
        ("visibility", c_uint32),
        ("map_width", c_int32),
        ("caustics", c_int32),
        ("reserved", c_int32),
    ]


class CameraStruct(ctypes.Structure):
    _fields_ = [
        ("type", c_int32),
        ("blades", c_int32),
        ("transform", c_float * 12),
        ("transform_end", c_float * 12),
        ("window", c_float * 4),
        ("clip_start", c_float),
        ("clip_end", c_float),
        ("aperture_radius", c_float),
        ("focus_distance", c_float),
        ("blade_rotation", c_float),
        ("aperture_ratio", c_float),
    ]


class SceneStatisticsStruct(ctypes.Structure):
    _fields_ = [
        ("triangles", c_int64),
        ("instances", c_int64),
        ("lights", c_int64),
        ("emissive_triangles", c_int64),
        ("memory_bytes", c_int64),
        ("build_seconds", c_double),
    ]


class RenderSettingsStruct(ctypes.Structure):
    _fields_ = [
        ("width", c_int32),
        ("height", c_int32),
        ("region", c_int32 * 4),
        ("samples_per_pass", c_int32),
        ("photons_per_pass", c_int32),
        ("photons_carry", c_int32),
        ("gather", c_int32),
        ("radius", c_float),
        ("radius_shrink", c_float),
        ("max_depth", c_int32),
        ("transparent_depth", c_int32),
        ("wavelength_first", c_float),
        ("wavelength_last", c_float),
        ("seed", c_uint32),
        ("filter", c_int32),
        ("filter_width", c_float),
        ("exposure", c_float),
        ("transparent_film", c_int32),
        ("clamp_direct", c_float),
        ("clamp_indirect", c_float),
        ("motion_blur", c_int32),
        ("spectral_bins", c_int32),
        ("threads", c_int32),
        ("passes", c_uint32),
    ]


class RenderStatisticsStruct(ctypes.Structure):
    _fields_ = [
        ("camera_rays", c_int64),
        ("path_rays", c_int64),
        ("shadow_rays", c_int64),
        ("photons_emitted", c_int64),
        ("photons_stored", c_int64),
        ("splats", c_int64),
        ("camera_seconds", c_double),
        ("photon_seconds", c_double),
        ("build_seconds", c_double),
        ("memory_bytes", c_int64),
    ]


# The C name of each structure, for the layout test.
STRUCTURES = {
    "opal_tables": TablesStruct,
    "opal_image_desc": ImageStruct,
    "opal_instruction": InstructionStruct,
    "opal_program": ProgramStruct,
    "opal_gem_desc": GemStruct,
    "opal_phase_desc": PhaseStruct,
    "opal_medium_desc": MediumStruct,
    "opal_material_desc": MaterialStruct,
    "opal_attribute_desc": AttributeStruct,
    "opal_mesh_desc": MeshStruct,
    "opal_instances_desc": InstancesStruct,
    "opal_light_desc": LightStruct,
    "opal_world_desc": WorldStruct,
    "opal_camera_desc": CameraStruct,
    "opal_scene_statistics": SceneStatisticsStruct,
    "opal_render_settings": RenderSettingsStruct,
    "opal_render_statistics": RenderStatisticsStruct,
}

_SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "opal_last_error": (c_char_p, []),
    "opal_api_version": (c_int32, []),
    "opal_cpu_level": (c_int32, []),
    "opal_scene_create": (c_void_p, [POINTER(TablesStruct), c_char_p, c_int32]),
    "opal_scene_destroy": (None, [c_void_p]),
    "opal_scene_add_image": (c_int32, [c_void_p, POINTER(ImageStruct)]),
    "opal_scene_add_spectrum": (c_int32, [c_void_p, _float_p]),
    "opal_scene_add_phase": (c_int32, [c_void_p, POINTER(PhaseStruct)]),
    "opal_scene_add_medium": (c_int32, [c_void_p, POINTER(MediumStruct)]),
    "opal_scene_set_world_medium": (c_int32, [c_void_p, c_int32]),
    "opal_scene_add_material": (c_int32, [c_void_p, POINTER(MaterialStruct)]),
    "opal_scene_update_material": (c_int32, [c_void_p, c_int32, POINTER(MaterialStruct)]),
    "opal_scene_add_mesh": (c_int32, [c_void_p, POINTER(MeshStruct), _int_p]),
    "opal_scene_add_instances": (c_int32, [c_void_p, POINTER(InstancesStruct)]),
    "opal_scene_set_transforms": (c_int32, [c_void_p, c_int32, c_int32, _float_p, _float_p]),
    "opal_scene_add_light": (c_int32, [c_void_p, POINTER(LightStruct)]),
    "opal_scene_clear_lights": (c_int32, [c_void_p]),
    "opal_scene_set_world": (c_int32, [c_void_p, POINTER(WorldStruct)]),
    "opal_scene_set_camera": (c_int32, [c_void_p, POINTER(CameraStruct)]),
    "opal_scene_commit": (c_int32, [c_void_p]),
    "opal_scene_get_statistics": (c_int32, [c_void_p, POINTER(SceneStatisticsStruct)]),
    "opal_scene_intersect": (c_int32, [c_void_p, c_int64, _float_p, _float_p, _float_p, _int_p, _int_p, _float_p]),
    "opal_render_create": (c_void_p, [c_void_p, POINTER(RenderSettingsStruct)]),
    "opal_render_destroy": (None, [c_void_p]),
    "opal_render_pass": (c_int32, [c_void_p, c_int32]),
    "opal_render_cancel": (None, [c_void_p]),
    "opal_render_progress": (c_float, [c_void_p]),
    "opal_film_read": (c_int32, [c_void_p, c_int32, _float_p]),
    "opal_film_noise": (c_float, [c_void_p]),
    "opal_render_get_statistics": (c_int32, [c_void_p, POINTER(RenderStatisticsStruct)]),
}

# ---- The library ------------------------------------------------------------------------------------------------------

_library: ctypes.CDLL | None = None
_library_lock = threading.Lock()


def library() -> ctypes.CDLL:
    """The compiled library for this processor, opened on first use.

    Raises
    ------
    OpalError
        If the file is missing, does not open, or speaks another version of the interface.
    """
    global _library
    with _library_lock:
        if _library is None:
            _library = _open_library()
        return _library


def _open_library() -> ctypes.CDLL:
    native = libraries.opal_library("native")
    if native.exists():
        return _declare(native)
    baseline = _declare(libraries.opal_library("v2"))
    fast = libraries.opal_library("v3")
    if baseline.opal_cpu_level() >= 3 and fast.exists():
        return _declare(fast)
    return baseline


def _declare(path: Any) -> ctypes.CDLL:
    if not path.exists():
        raise OpalError(f"Opal's compiled library is missing: looked for {path}.")
    try:
        opened = ctypes.CDLL(str(path))
    except OSError as error:
        raise OpalError(f"Opal's compiled library {path} does not open: {error}.") from error
    for name, (result, arguments) in _SIGNATURES.items():
        try:
            function = getattr(opened, name)
        except AttributeError as error:
            raise OpalError(f"{path} has no function {name}: it is not the library of this version of Opal.") from error
        function.restype, function.argtypes = result, arguments
    if (found := opened.opal_api_version()) != API_VERSION:
        raise OpalError(f"{path} speaks version {found} of Opal's interface, this package version {API_VERSION}.")
    return opened


def last_error() -> str:
    """The sentence of the last failure on this thread; empty when there was none."""
    return library().opal_last_error().decode("utf-8", "replace")


def cpu_level() -> int:
    """Micro-architecture level of this processor: 3 (AVX2, FMA), 2 (x86-64-v2), 0 elsewhere."""
    return library().opal_cpu_level()


def _checked(status: int) -> int:
    if status >= 0:
        return status
    message = last_error() or f"The kernels failed with status {status}."
    raise Cancelled(message) if status == CANCELLED else OpalError(message)


# ---- Arrays and structures --------------------------------------------------------------------------------------------


def as_array(name: str, values: Any, dtype: Any, shape: Sequence[int | None], finite: bool = True) -> np.ndarray:
    """A contiguous array of ``dtype`` and ``shape`` (None: any length), without a copy where none is needed.

    Raises
    ------
    OpalError
        Naming the argument, what was expected and what came.
    """
    array = np.asarray(values)
    if not (np.can_cast(array.dtype, dtype, "same_kind") or (np.dtype(dtype).kind == "f" and array.dtype.kind in "iub")):
        raise OpalError(f"{name} holds {array.dtype} values where {np.dtype(dtype)} is expected.")
    array = np.ascontiguousarray(array, dtype=dtype)
    if array.ndim != len(shape) or any(want is not None and want != got for want, got in zip(shape, array.shape, strict=True)):
        wanted = " x ".join("any" if n is None else str(n) for n in shape)
        raise OpalError(f"{name} has the shape {' x '.join(map(str, array.shape)) or 'of one value'} where {wanted} is expected.")
    if finite and array.dtype.kind == "f" and not np.isfinite(array).all():
        raise OpalError(f"{name} holds values that are not finite.")
    return array


def _floats(name: str, values: Any, shape: Sequence[int | None], finite: bool = True) -> np.ndarray:
    return as_array(name, values, np.float32, shape, finite)


def _pointer(array: np.ndarray | None, kind: Any = _float_p) -> Any:
    return None if array is None else array.ctypes.data_as(kind)


def _transforms(name: str, values: Any, count: int | None = None) -> np.ndarray:
    """Matrices as n x 12; accepts n x 3 x 4, n x 4 x 4 and n x 12."""
    array = np.asarray(values, dtype=np.float32)
    if array.ndim == 3 and array.shape[1:] in ((3, 4), (4, 4)):
        array = array[:, :3, :].reshape(len(array), 12)
    return _floats(name, array, (count, 12))


def _get(description: Any, name: str, default: Any = None) -> Any:
    if isinstance(description, Mapping):
        return description.get(name, default)
    return getattr(description, name, default)


def _fill(struct: Any, description: Any, skip: Iterable[str] = ()) -> Any:
    """Copies same-named values of a dataclass or mapping into a structure of numbers; "reserved" stays zero."""
    what = type(description).__name__
    for name, kind in struct._fields_:
        if name == "reserved" or name in skip:
            continue
        value = _get(description, name)
        if value is None:
            raise OpalError(f"{what} has no {name}.")
        if issubclass(kind, ctypes.Array):
            flat = np.asarray(value, dtype=np.float64 if kind._type_ is c_float else np.int64)
            if kind._length_ == 12 and flat.shape == (4, 4):
                flat = flat[:3]
            flat = flat.reshape(-1)
            if len(flat) != kind._length_ or not np.isfinite(flat).all():
                raise OpalError(f"{what}.{name} takes {kind._length_} finite numbers.")
            setattr(struct, name, kind(*flat.tolist()))
        elif kind is c_float:
            if not np.isfinite(value):
                raise OpalError(f"{what}.{name} is not finite.")
            setattr(struct, name, float(value))
        else:
            setattr(struct, name, int(value))
    return struct


def _program(description: Any, keep: list[Any]) -> ProgramStruct:
    """A program's structure; arrays it points to are put into ``keep``, which has to outlive the call."""
    code = as_array("program.code", _get(description, "code"), np.int32, (None, 16))
    constants = _floats("program.constants", _get(description, "constants"), (None, 4))
    keep += [code, constants]
    return ProgramStruct(
        code=code.ctypes.data_as(POINTER(InstructionStruct)),
        n_instructions=len(code),
        n_constants=len(constants),
        constants=_pointer(constants),
        n_registers=int(_get(description, "n_registers")),
    )


def _numbers(struct: Any) -> dict[str, Any]:
    return {name: getattr(struct, name) for name, _ in struct._fields_}


# ---- Scene ------------------------------------------------------------------------------------------------------------


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
    observer = _floats("observer", observer, (3, SPECTRUM_SIZE))
    d65 = _floats("d65", d65, (SPECTRUM_SIZE,))
    basis = _floats("basis", basis, (3, SPECTRUM_SIZE))
    tables = TablesStruct(_pointer(observer), _pointer(d65), _pointer(basis))
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
    struct = ImageStruct(
        width, height, channels, 0 if kind is np.uint8 else 1, int(transfer), 0, pixels.ctypes.data_as(c_void_p)
    )
    return _checked(library().opal_scene_add_image(scene, byref(struct)))


def scene_add_spectrum(scene: int, values: Any) -> int:
    """Adds a table of 471 values, 360 to 830 nm, and returns its number."""
    values = _floats("spectrum", values, (SPECTRUM_SIZE,))
    return _checked(library().opal_scene_add_spectrum(scene, _pointer(values)))


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
        wavelengths = _floats("wavelengths", phase.wavelengths, (None,))
        angles = _floats("angles", phase.angles, (None,))
        values = _floats("values", phase.values, (len(wavelengths), len(angles)))
        keep = [wavelengths, angles, values]
        struct.n_wavelengths, struct.n_angles = len(wavelengths), len(angles)
        struct.wavelengths, struct.angles, struct.values = map(_pointer, keep)
    return _checked(library().opal_scene_add_phase(scene, byref(struct)))


def scene_add_medium(scene: int, medium: Medium) -> int:
    """Adds a medium, made of spectra and a phase function of this scene, and returns its number."""
    return _checked(library().opal_scene_add_medium(scene, byref(_fill(MediumStruct(), medium))))


def scene_set_world_medium(scene: int, medium: int) -> None:
    """Fills the world with a medium; -1 takes it away."""
    _checked(library().opal_scene_set_world_medium(scene, medium))


def _material(program: Any, gem: Any, flags: int, keep: list[Any], medium: int = -1) -> MaterialStruct:
    struct = MaterialStruct(flags=int(flags), medium=medium + 1)
    if program is not None:
        struct.surface = _program(program, keep)
    if gem is not None:
        keep.append(_fill(GemStruct(), gem))
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
    return _checked(library().opal_scene_add_material(scene, byref(_material(program, gem, flags, keep, medium))))


def scene_update_material(
    scene: int, index: int, program: Any = None, gem: Any = None, flags: int = 0, medium: int = -1
) -> None:
    """Replaces a material."""
    keep: list[Any] = []
    _checked(library().opal_scene_update_material(scene, index, byref(_material(program, gem, flags, keep, medium))))


def scene_add_mesh(
    scene: int,
    positions: Any,
    triangles: Any,
    *,
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
    positions, positions_end : array_like
        (n, 3) vertices at shutter open and close. Not held to be finite: their triangles are dropped.
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
    positions = _floats("positions", positions, (None, 3), finite=False)
    triangles = as_array("triangles", triangles, np.int32, (None, 3))
    n, m = len(positions), len(triangles)
    if positions_end is not None:
        positions_end = _floats("positions_end", positions_end, (n, 3), finite=False)
    if corner_normals is not None:
        corner_normals = _floats("corner_normals", np.reshape(corner_normals, (-1, 9)), (m, 9), finite=False)
    if corner_tangents is not None:
        corner_tangents = _floats("corner_tangents", np.reshape(corner_tangents, (-1, 12)), (m, 12), finite=False)
    if material_slots is not None:
        material_slots = as_array("material_slots", material_slots, np.int32, (m,))
    if generated is not None:
        generated = _floats("generated", generated, (n, 3), finite=False)
    counts = (3 * m, n, m)
    structs = (AttributeStruct * len(attributes))()
    keep = []
    for struct, attribute in zip(structs, attributes, strict=True):
        values = np.asarray(attribute.values)
        values = _floats("attribute", values.reshape(len(values), -1), (counts[attribute.domain], None), finite=False)
        keep.append(values)
        struct.name, struct.domain, struct.components = attribute.name, int(attribute.domain), values.shape[1]
        struct.values = _pointer(values)
    mesh = MeshStruct(
        n_vertices=n,
        n_triangles=m,
        positions=_pointer(positions),
        positions_end=_pointer(positions_end),
        triangles=_pointer(triangles, _int_p),
        corner_normals=_pointer(corner_normals),
        corner_tangents=_pointer(corner_tangents),
        material_slots=_pointer(material_slots, _int_p),
        generated=_pointer(generated),
        attributes=structs if attributes else None,
        n_attributes=len(attributes),
    )
    dropped = c_int32(0)
    return _checked(library().opal_scene_add_mesh(scene, byref(mesh), byref(dropped))), dropped.value


def scene_add_instances(
    scene: int,
    mesh: int,
    transforms: Any,
    materials: Any = (),
    *,
    transforms_end: Any = None,
    visibility: int = 63,
    object_info: Any = None,
    holdout: bool = False,
    light_group: int = -1,
) -> int:
    """Adds copies of a mesh and returns the number of the first.

    Parameters
    ----------
    transforms, transforms_end : array_like
        (count, 3, 4), (count, 4, 4) or (count, 12): object to world at shutter open and close.
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
    transforms = _transforms("transforms", transforms)
    count = len(transforms)
    if transforms_end is not None:
        transforms_end = _transforms("transforms_end", transforms_end, count)
    materials = as_array("materials", np.asarray(materials, dtype=np.int32), np.int32, (None,))
    if object_info is not None:
        object_info = _floats("object_info", object_info, (count, 8))
    struct = InstancesStruct(
        mesh=mesh,
        count=count,
        transforms=_pointer(transforms),
        transforms_end=_pointer(transforms_end),
        materials=_pointer(materials, _int_p),
        n_materials=len(materials),
        visibility=int(visibility),
        object_info=_pointer(object_info),
        holdout=int(holdout),
        light_group=int(light_group),
    )
    return _checked(library().opal_scene_add_instances(scene, byref(struct)))


def scene_set_transforms(scene: int, first_instance: int, transforms: Any, transforms_end: Any = None) -> None:
    """Moves instances; shapes as in `scene_add_instances`."""
    transforms = _transforms("transforms", transforms)
    if transforms_end is not None:
        transforms_end = _transforms("transforms_end", transforms_end, len(transforms))
    _checked(
        library().opal_scene_set_transforms(
            scene, first_instance, len(transforms), _pointer(transforms), _pointer(transforms_end)
        )
    )


def scene_add_light(scene: int, light: Any) -> int:
    """Adds a `descriptions.Light` (or anything with its fields) and returns its number."""
    return _checked(library().opal_scene_add_light(scene, byref(_fill(LightStruct(), light))))


def scene_clear_lights(scene: int) -> None:
    """Takes every lamp away."""
    _checked(library().opal_scene_clear_lights(scene))


def scene_set_world(scene: int, world: Any) -> None:
    """Sets a `descriptions.World`; None, or one without a program, is black."""
    if world is None or _get(world, "program") is None:
        _checked(library().opal_scene_set_world(scene, None))
        return
    keep: list[Any] = []
    struct = _fill(WorldStruct(), world, skip=("program",))
    struct.program = _program(_get(world, "program"), keep)
    _checked(library().opal_scene_set_world(scene, byref(struct)))


def scene_set_camera(scene: int, camera: Any) -> None:
    """Sets a `descriptions.Camera`; without ``transform_end`` it stands still."""
    struct = _fill(CameraStruct(), camera, skip=("transform_end",))
    end = _get(camera, "transform_end")
    if end is None:
        struct.transform_end = struct.transform
    else:
        struct.transform_end = (c_float * 12)(*_transforms("camera.transform_end", np.asarray(end)[None, :3], 1)[0])
    _checked(library().opal_scene_set_camera(scene, byref(struct)))


def scene_commit(scene: int) -> None:
    """Builds what changed: acceleration structures, light tables, bounds of what makes caustics."""
    _checked(library().opal_scene_commit(scene))


def scene_get_statistics(scene: int) -> dict[str, Any]:
    """Counts, memory (bytes) and build time (s) of a committed scene."""
    struct = SceneStatisticsStruct()
    _checked(library().opal_scene_get_statistics(scene, byref(struct)))
    return _numbers(struct)


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
    origins = _floats("origins", origins, (None, 3))
    n = len(origins)
    directions = _floats("directions", directions, (n, 3))
    out = {
        "distance": np.empty(n, np.float32),
        "instance": np.empty(n, np.int32),
        "triangle": np.empty(n, np.int32),
        "barycentrics": np.empty((n, 2), np.float32),
    }
    _checked(
        library().opal_scene_intersect(
            scene,
            n,
            _pointer(origins),
            _pointer(directions),
            _pointer(out["distance"]),
            _pointer(out["instance"], _int_p),
            _pointer(out["triangle"], _int_p),
            _pointer(out["barycentrics"]),
        )
    )
    return out


# ---- Rendering --------------------------------------------------------------------------------------------------------


def render_create(scene: int, settings: Any) -> int:
    """A film and the state of a render, from `descriptions.RenderSettings`; free it with `render_destroy` once."""
    struct = _fill(RenderSettingsStruct(), settings, skip=("region", "passes"))
    struct.region = (c_int32 * 4)(*(_get(settings, "region") or (0, 0, struct.width, struct.height)))
    passes = _get(settings, "passes", ())
    struct.passes = 1
    for number in passes:
        struct.passes |= 1 << int(number)
    handle = library().opal_render_create(scene, byref(struct))
    if not handle:
        raise OpalError(last_error() or "The render could not be created.")
    return handle


def render_destroy(render: int) -> None:
    """Frees a render; not while a pass runs."""
    library().opal_render_destroy(render)


def render_pass(render: int, number: int) -> None:
    """Renders one pass and adds it to the film; blocks without the interpreter lock.

    Raises
    ------
    Cancelled
        If `render_cancel` was called from another thread.
    """
    _checked(library().opal_render_pass(render, number))


def render_cancel(render: int) -> None:
    """Asks the running pass to stop; from any thread."""
    library().opal_render_cancel(render)


def render_progress(render: int) -> float:
    """Fraction of the running pass that is done; from any thread."""
    return library().opal_render_progress(render)


def film_read(render: int, which: int, height: int, width: int, channels: int | None = None) -> np.ndarray:
    """An image of the film.

    Parameters
    ----------
    which : Pass
    height, width : int
        Of the rendered region.
    channels : int, optional
        Only for the spectral pass: its bins.

    Returns
    -------
    ndarray
        float32 of shape (height, width, channels), rows from the bottom up.
    """
    out = np.empty((height, width, channels or PASS_CHANNELS[Pass(which)]), np.float32)
    _checked(library().opal_film_read(render, int(which), _pointer(out)))
    return out


def film_noise(render: int) -> float:
    """Mean estimated error relative to brightness; negative before two passes."""
    return library().opal_film_noise(render)


def render_get_statistics(render: int) -> dict[str, Any]:
    """Rays, photons, seconds and bytes of a render so far."""
    struct = RenderStatisticsStruct()
    _checked(library().opal_render_get_statistics(render, byref(struct)))
    return _numbers(struct)
