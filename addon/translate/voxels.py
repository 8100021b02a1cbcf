# SPDX-License-Identifier: GPL-3.0-or-later
"""Grids of voxels out of Blender: OpenVDB files and sequences, volumes that nodes generate, smoke and fire domains.

A grid is dense within the box of its active voxels. Voxel (i, j, k) is a sample at (i, j, k) of index space, as OpenVDB has it;
Blender's smoke has samples in the middle of its cells, and its transform says so.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

_MEMORY_SHARE = 0.5  # of the free memory that one grid may take while it is read


@dataclass
class Voxels:
    """One grid.

    Attributes
    ----------
    values : ndarray
        (x, y, z) or (x, y, z, 3) float32.
    transform : ndarray
        (4, 4), index space to the object's.
    """

    values: np.ndarray
    transform: np.ndarray

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners (low, high) in object space of everything that is not 0: one voxel beyond the samples."""
        n = np.array(self.values.shape[:3], float)
        corners = np.array([[(-1.0, m)[i >> a & 1] for a, m in enumerate(n)] + [1.0] for i in range(8)])
        points = (corners @ self.transform.T)[:, :3]
        return points.min(axis=0), points.max(axis=0)

    def places(self) -> np.ndarray:
        """Where the samples lie, (n, 3) in object space, in the order of `values`."""
        index = np.stack(np.meshgrid(*(np.arange(m) for m in self.values.shape[:3]), indexing="ij"), -1).reshape(-1, 3)
        return index @ self.transform[:3, :3].T + self.transform[:3, 3]

    def at(self, other: Voxels) -> np.ndarray:
        """These values at another grid's samples: as they are on the same lattice, else trilinear."""
        same = self.values.shape[:3] == other.values.shape[:3] and np.allclose(self.transform, other.transform, atol=1e-6)
        if same:
            return self.values
        places = np.c_[other.places(), np.ones(int(np.prod(other.values.shape[:3])))]
        index = (places @ np.linalg.inv(self.transform).T)[:, :3] + 1
        padded = np.pad(self.values, [(1, 1)] * 3 + [(0, 0)] * (self.values.ndim - 3))
        top = np.array(padded.shape[:3]) - 1
        inside = ((index >= 0) & (index <= top)).all(axis=1)
        index = np.clip(index, 0, top - 1e-6)
        first = index.astype(int)
        part = index - first
        out = np.zeros((len(index), *self.values.shape[3:]), np.float32)
        for corner in np.ndindex(2, 2, 2):
            weight = np.prod(np.where(corner, part, 1 - part), axis=1) * inside
            found = padded[tuple((first + np.array(corner)).T)]
            out += found * weight.reshape(-1, *(1,) * (out.ndim - 1)).astype(np.float32)
        return out.reshape(*other.values.shape[:3], *self.values.shape[3:])


class Source(Protocol):
    """Where an object's grids come from; `problem` takes sentences for the report."""

    key: int
    names: tuple[str, ...]

    def read(self, name: str) -> Voxels | None:
        """A grid, or None where there is none of that name or it cannot be read."""


def source_of(obj: Any, problem: Callable[[str], None]) -> Source | None:
    """The grids of an evaluated object; None for ordinary meshes."""
    if obj.type == "VOLUME":
        return VolumeGrids(obj.data, problem)
    domain = gas_domain(obj)
    return SmokeGrids(obj, domain, problem) if domain is not None else None


def gas_domain(obj: Any) -> Any:
    """Settings of a smoke or fire domain, or None."""
    for modifier in obj.modifiers:
        if modifier.type == "FLUID" and modifier.fluid_type == "DOMAIN" and modifier.show_render:
            settings = modifier.domain_settings
            return settings if settings is not None and settings.domain_type == "GAS" else None
    return None


def density_by_scale(matrices: np.ndarray) -> np.ndarray:
    """What Blender multiplies the coefficients of a volume object by whose render space is Object: it looks the same at any scale.

    As in Cycles: one over the length of what the unit diagonal becomes, which does not change when the object turns. Meshes and
    smoke domains are as dense per metre at any scale.

    Parameters
    ----------
    matrices : ndarray
        (n, 3 or 4, 4), object to world.

    Returns
    -------
    ndarray
        (n,), rounded to 1e-4 of itself, so that copies of one scale stay together.
    """
    diagonal = np.asarray(matrices, float)[:, :3, :3].sum(axis=2) / np.sqrt(3.0)
    return np.exp(-np.round(np.log(np.linalg.norm(diagonal, axis=1)), 4))


def too_large(size: Any, channels: int = 1) -> str:
    """A sentence where a dense grid of this size does not fit into the free memory; empty where it does."""
    from opal_kernels import memory

    needed = float(np.prod(np.asarray(size, float))) * channels * 4
    free = memory.available_bytes()
    if free is None or needed <= free * _MEMORY_SHARE:
        return ""
    shape = " x ".join(str(int(n)) for n in size)
    return f"the grid of {shape} voxels needs {needed / 1e9:.1f} GB, more than is free; it is left out."


# ---- OpenVDB ----


def _openvdb() -> Any:
    """Blender's own openvdb module, or None where its build has none."""
    import bpy

    try:
        bpy.utils.expose_bundled_modules()
    except AttributeError:  # a build without bundled modules
        pass
    try:
        import openvdb
    except ImportError:
        return None
    return openvdb


class VolumeGrids:
    """The grids of a Volume datablock: of its file at this frame, or saved to a passing file where nodes made them."""

    def __init__(self, volume: Any, problem: Callable[[str], None]) -> None:
        self.key = volume.as_pointer()
        self._problem = problem
        self._volume = volume
        self._read: dict[str, Voxels | None] = {}
        self._file: dict[str, Any] = {}
        self.names: tuple[str, ...] = ()
        if not volume.grids.load():
            problem(f"the volume cannot be read: {volume.grids.error_message or 'there is no file'}")
            return
        self.names = tuple(grid.name for grid in volume.grids)

    def read(self, name: str) -> Voxels | None:
        if name not in self._read:
            self._read[name] = self._load(name) if name in self.names else None
        return self._read[name]

    def _load(self, name: str) -> Voxels | None:
        vdb = _openvdb()
        if vdb is None:
            self._problem("this Blender was built without the openvdb module, so OpenVDB grids are not rendered.")
            return None
        try:
            grid = self._grid(vdb, name)
        except (OSError, RuntimeError, KeyError, TypeError) as error:
            self._problem(f"the grid “{name}” cannot be read: {error}")
            return None
        kind = type(grid).__name__
        if not hasattr(grid, "copyToArray") or "Points" in kind:
            self._problem(f"the grid “{name}” holds {kind}, which is not rendered.")
            return None
        if grid.activeVoxelCount() == 0:
            return Voxels(np.zeros((1, 1, 1), np.float32), self._matrix(name))
        low, high = (np.array(corner) for corner in grid.evalActiveVoxelBoundingBox())
        size = high - low + 1
        vector = kind.startswith("Vec3")
        if sentence := too_large(size, 3 if vector else 1):
            self._problem(f"“{name}”: {sentence}")
            return None
        values = np.zeros((*size, 3) if vector else tuple(size), np.float32)
        grid.copyToArray(values, ijk=tuple(int(i) for i in low))
        matrix = self._matrix(name)
        shift = np.eye(4)
        shift[:3, 3] = low
        return Voxels(values, matrix @ shift)

    def _matrix(self, name: str) -> np.ndarray:
        return np.array(next(g for g in self._volume.grids if g.name == name).matrix_object, float)

    def _grid(self, vdb: Any, name: str) -> Any:
        path = self._volume.grids.frame_filepath
        if self._volume.filepath and path and Path(path).exists():
            return vdb.read(path, name)
        with tempfile.TemporaryDirectory(prefix="opal_") as folder:
            saved = str(Path(folder) / "generated.vdb")
            if not self._volume.grids.save(filepath=saved):
                raise OSError(self._volume.grids.error_message or "its grids cannot be saved")
            return vdb.read(saved, name)


# ---- Smoke and fire ----

_SMOKE = {
    "density": ("density_grid", 1),
    "flame": ("flame_grid", 1),
    "heat": ("heat_grid", 1),
    "temperature": ("temperature_grid", 1),
    "color": ("color_grid", 4),
}


class SmokeGrids:
    """The grids of a gas domain at the present frame, straight from the evaluated object.

    Blender's arrays run fastest along x. An adaptive domain keeps a part of its cells: their size and place are read with them.
    """

    names = tuple(_SMOKE)

    def __init__(self, obj: Any, domain: Any, problem: Callable[[str], None]) -> None:
        self.key = obj.as_pointer()
        self._domain, self._problem = domain, problem
        self._box = np.array(obj.bound_box, float)

    def _transform(self, size: np.ndarray) -> np.ndarray:
        """Index space to the object's: cell i lies at (i + 1/2) / n of the box that the cells fill."""
        low, high = self._box.min(axis=0), self._box.max(axis=0)
        transform = np.eye(4)
        step = (high - low) / size
        transform[range(3), range(3)], transform[:3, 3] = step, low + 0.5 * step
        return transform

    def read(self, name: str) -> Voxels | None:
        if name not in _SMOKE:
            return None
        attribute, channels = _SMOKE[name]
        size = np.array(self._domain.domain_resolution, int)
        if self._domain.use_noise:
            size = size * int(self._domain.noise_scale)
        cells = int(np.prod(size))
        grid = getattr(self._domain, attribute)
        if cells == 0 or len(grid) == 0:
            return None
        if len(grid) != cells * channels:
            size = np.array(self._domain.domain_resolution, int)  # heat and the like keep the coarse cells
            cells = int(np.prod(size))
            if len(grid) != cells * channels:
                self._problem(f"the smoke's grid “{name}” has another size than its domain; it is left out.")
                return None
        if sentence := too_large(size, channels):
            self._problem(f"“{name}”: {sentence}")
            return None
        flat = np.empty(cells * channels, np.float32)
        grid.foreach_get(flat)
        values = flat.reshape(*size[::-1], channels).transpose(2, 1, 0, 3)
        values = values[..., :3] if channels == 4 else values[..., 0]
        return Voxels(np.ascontiguousarray(values), self._transform(size))
