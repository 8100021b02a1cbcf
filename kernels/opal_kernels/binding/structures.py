# SPDX-License-Identifier: GPL-3.0-or-later
"""The structures of ``include/opal.h``, field by field and in its order.

``tests/kernels/test_binding_layout.py`` holds them to a C compiler's offsets.
"""

from __future__ import annotations

import ctypes
from ctypes import POINTER, c_double, c_float, c_int32, c_int64, c_uint32, c_uint64, c_void_p

FloatPointer = POINTER(c_float)
IntPointer = POINTER(c_int32)


class TablesStruct(ctypes.Structure):
    _fields_ = [("observer", FloatPointer), ("d65", FloatPointer), ("basis", FloatPointer)]


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
        ("constants", FloatPointer),
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
        ("wavelengths", FloatPointer),
        ("angles", FloatPointer),
        ("values", FloatPointer),
        ("polarization", FloatPointer),
        ("n_elevations", c_int32),
        ("n_clocks", c_int32),
        ("elevations", FloatPointer),
        ("clocks", FloatPointer),
    ]


class MediumStruct(ctypes.Structure):
    _fields_ = [
        ("extinction", c_int32),
        ("scattering", c_int32),
        ("emission", c_int32),
        ("phase", c_int32),
        ("density", c_int32),
        ("density_grid", c_int32),
        ("emission_density", c_int32),
        ("emission_density_grid", c_int32),
        ("scattering_grid", c_int32),
        ("absorption_grid", c_int32),
        ("emission_grid", c_int32),
        ("noise_seed", c_uint32),
        ("noise_scale", c_float),
        ("noise_detail", c_float),
        ("noise_contrast", c_float),
        ("scale_height", c_float),
        ("base_height", c_float),
        ("also", c_int32),
    ]


class GridStruct(ctypes.Structure):
    _fields_ = [("size", c_int32 * 3), ("channels", c_int32), ("transform", c_float * 12)]


class GridFaultsStruct(ctypes.Structure):
    _fields_ = [("not_finite", c_int64), ("negative", c_int64)]


class AttributeStruct(ctypes.Structure):
    _fields_ = [
        ("name", c_int32),
        ("domain", c_int32),
        ("components", c_int32),
        ("reserved", c_int32),
        ("values", FloatPointer),
    ]


class PlacesStruct(ctypes.Structure):
    _fields_ = [
        ("n", c_int64),
        ("positions", FloatPointer),
        ("generated", FloatPointer),
        ("transform", FloatPointer),
        ("object_info", FloatPointer),
        ("attributes", POINTER(AttributeStruct)),
        ("n_attributes", c_int32),
        ("reserved", c_int32),
    ]


class MeshStruct(ctypes.Structure):
    _fields_ = [
        ("n_vertices", c_int32),
        ("n_triangles", c_int32),
        ("positions", FloatPointer),
        ("positions_start", FloatPointer),
        ("positions_end", FloatPointer),
        ("triangles", IntPointer),
        ("corner_normals", FloatPointer),
        ("corner_tangents", FloatPointer),
        ("material_slots", IntPointer),
        ("generated", FloatPointer),
        ("attributes", POINTER(AttributeStruct)),
        ("n_attributes", c_int32),
        ("reserved", c_int32),
    ]


class InstancesStruct(ctypes.Structure):
    _fields_ = [
        ("mesh", c_int32),
        ("count", c_int32),
        ("transforms", FloatPointer),
        ("transforms_start", FloatPointer),
        ("transforms_end", FloatPointer),
        ("materials", IntPointer),
        ("n_materials", c_int32),
        ("visibility", c_uint32),
        ("object_info", FloatPointer),
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
        ("transform_start", c_float * 12),
        ("transform_end", c_float * 12),
        ("window", c_float * 4),
        ("clip_start", c_float),
        ("clip_end", c_float),
        ("aperture_radius", c_float),
        ("focus_distance", c_float),
        ("blade_rotation", c_float),
        ("aperture_ratio", c_float),
        ("polarizer", c_int32),
        ("polarizer_angle", c_float),
    ]


class SceneStatisticsStruct(ctypes.Structure):
    _fields_ = [
        ("triangles", c_int64),
        ("instances", c_int64),
        ("lights", c_int64),
        ("emissive_triangles", c_int64),
        ("memory_bytes", c_int64),
        ("build_seconds", c_double),
        ("mesh_builds", c_int64),
        ("top_builds", c_int64),
        ("light_builds", c_int64),
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
        ("volume_estimate", c_int32),
        ("volume_photons", c_int32),
        ("volume_radius", c_float),
        ("march_steps", c_int32),
        ("march_tolerance", c_float),
        ("adaptive", c_int32),
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
        ("volume_photons_emitted", c_int64),
        ("volume_photons_stored", c_int64),
        ("search_seconds", c_double),
        ("photon_bytes", c_int64),
        ("energy_emitted", c_double),
        ("energy_stored", c_double),
        ("energy_absorbed", c_double),
        ("energy_escaped", c_double),
        ("pilot_seconds", c_double),
        ("gems_passed_over", c_int64),
        ("media_passed_over", c_int64),
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
    "opal_grid_desc": GridStruct,
    "opal_grid_faults": GridFaultsStruct,
    "opal_material_desc": MaterialStruct,
    "opal_attribute_desc": AttributeStruct,
    "opal_places_desc": PlacesStruct,
    "opal_mesh_desc": MeshStruct,
    "opal_instances_desc": InstancesStruct,
    "opal_light_desc": LightStruct,
    "opal_world_desc": WorldStruct,
    "opal_camera_desc": CameraStruct,
    "opal_scene_statistics": SceneStatisticsStruct,
    "opal_render_settings": RenderSettingsStruct,
    "opal_render_statistics": RenderStatisticsStruct,
}
