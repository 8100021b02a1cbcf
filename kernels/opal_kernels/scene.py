# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene for the tracer, as a Python object: what `binding` does, with ownership and a context manager.

Building a scene is for one thread at a time; a committed scene serves one `Render` at a time.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from . import binding, data, libraries
from .descriptions import (
    Attribute,
    Camera,
    Gem,
    Light,
    MaterialFlag,
    Medium,
    Phase,
    Program,
    Ray,
    Transfer,
    World,
)


class Scene:
    """Meshes, materials, lights, a world and a camera.

    Parameters
    ----------
    threads : int
        0 takes every core.
    embree : str, optional
        File of Embree 4; None looks in the running or installed Blender (`libraries.embree`).

    Raises
    ------
    OpalError
        If the compiled library or Embree does not open.

    Examples
    --------
    >>> with Scene() as scene:
    ...     floor = scene.add_mesh([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]])
    ...     first = scene.add_instances(floor, [np.eye(4)])
    ...     scene.commit()
    """

    def __init__(self, threads: int = 0, embree: str | None = None) -> None:
        self._handle = 0
        observer, d65, basis = (data.array(name) for name in ("cie1931_observer", "d65", "uplift_basis"))
        self._handle = binding.scene_create(observer, d65, basis, embree or libraries.embree(), threads)

    @property
    def handle(self) -> int:
        """The kernels' handle.

        Raises
        ------
        OpalError
            If the scene is closed.
        """
        if not self._handle:
            raise binding.OpalError("The scene is closed.")
        return self._handle

    def close(self) -> None:
        """Frees the scene; every render of it has to be closed before. Closing twice is allowed."""
        handle, self._handle = self._handle, 0
        if handle:
            binding.scene_destroy(handle)

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()

    # ---- Data ----

    def add_image(self, pixels: np.ndarray, transfer: Transfer = Transfer.LINEAR) -> int:
        """Adds an image; see `binding.scene_add_image`."""
        return binding.scene_add_image(self.handle, pixels, transfer)

    def add_spectrum(self, values: Any) -> int:
        """Adds 471 values over 360 to 830 nm: an index, an absorption (1/m), a lamp's relative power."""
        return binding.scene_add_spectrum(self.handle, values)

    def set_spectrum(self, spectrum: int, values: Any) -> None:
        """Replaces a spectrum; `commit` afterwards."""
        binding.scene_set_spectrum(self.handle, spectrum, values)

    def add_material(
        self,
        program: Program | None = None,
        gem: Gem | None = None,
        flags: int = 0,
        medium: int = -1,
    ) -> int:
        """Adds a material; see `binding.scene_add_material`."""
        return binding.scene_add_material(self.handle, program, gem, flags, medium)

    def update_material(
        self,
        index: int,
        program: Program | None = None,
        gem: Gem | None = None,
        flags: int = 0,
        medium: int = -1,
    ) -> None:
        """Replaces a material; `commit` afterwards."""
        binding.scene_update_material(self.handle, index, program, gem, flags, medium)

    def add_grid(self, values: Any, transform: Any) -> int:
        """Adds a grid of voxels, dense; `binding.scene_add_grid` and `scene_set_grid_block` take it in parts.

        Parameters
        ----------
        values : array_like
            (x, y, z), or (x, y, z, 3) for colours; what is not finite or is negative becomes 0.
        transform : array_like
            (3, 4) or (4, 4), index space to the object's: where voxel (i, j, k) lies.

        Returns
        -------
        int
            The grid's number; media name it as 1 + number.
        """
        values = np.asarray(values, np.float32)
        grid = binding.scene_add_grid(self.handle, values.shape[:3], transform, 3 if values.ndim == 4 else 1)
        binding.scene_set_grid_block(self.handle, grid, values)
        return grid

    def add_medium(self, extinction: Any, albedo: Any = 1.0, phase: Phase | None = None, emission: Any = None, **fields: Any) -> int:
        """Adds a medium from spectra.

        Parameters
        ----------
        extinction : float or array_like
            σt in 1/m: one number or 471 values.
        albedo : float or array_like
            σs / σt, likewise.
        phase : Phase, optional
            None is isotropic.
        emission : float or array_like, optional
            Radiance per metre, likewise.
        **fields
            Further fields of `Medium`: density, grids, noise.

        Returns
        -------
        int
            The medium's number, for `add_material` and `set_world_medium`.
        """
        extinction = np.broadcast_to(np.asarray(extinction, np.float64), (471,))
        scattering = extinction * np.asarray(albedo, np.float64)
        medium = Medium(self.add_spectrum(extinction), self.add_spectrum(scattering), **fields)
        if emission is not None:
            medium.emission = self.add_spectrum(np.broadcast_to(np.asarray(emission, np.float64), (471,)))
        if phase is not None:
            medium.phase = binding.scene_add_phase(self.handle, phase)
        return binding.scene_add_medium(self.handle, medium)

    def set_medium_layer(self, medium: int, layer: int) -> None:
        """Says which compositing layer (`MediumLayer`) shows what a medium scatters."""
        binding.scene_set_medium_layer(self.handle, medium, int(layer))

    def set_world_medium(self, medium: int) -> None:
        """Fills the world with a medium; -1 takes it away."""
        binding.scene_set_world_medium(self.handle, medium)

    def add_gem(
        self, index: Any, absorption: Any = None, roughness: float = 0.0, fresnel: int = 0, priority: int = 0, medium: int = -1
    ) -> int:
        """Adds a dielectric from spectra.

        Parameters
        ----------
        index : float or array_like
            Index of refraction: one number or 471 values.
        absorption : float or array_like, optional
            σa in 1/m: one number or 471 values.
        roughness, fresnel, priority
            As in `Gem`.
        medium : int, optional
            The medium that clouds it.

        Returns
        -------
        int
            The material's number.
        """
        spectrum = np.full(471, index) if np.ndim(index) == 0 else index
        gem = Gem(self.add_spectrum(spectrum), -1, roughness, fresnel, priority)
        if absorption is not None:
            gem.absorption_spectrum = self.add_spectrum(np.full(471, absorption) if np.ndim(absorption) == 0 else absorption)
        return self.add_material(gem=gem, flags=MaterialFlag.CASTER, medium=medium)

    # ---- Geometry ----

    def add_mesh(
        self,
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
    ) -> int:
        """Adds a mesh and returns its number; shapes in `binding.scene_add_mesh`. Bad triangles are dropped silently."""
        return binding.scene_add_mesh(
            self.handle,
            positions,
            triangles,
            positions_start=positions_start,
            positions_end=positions_end,
            corner_normals=corner_normals,
            corner_tangents=corner_tangents,
            material_slots=material_slots,
            generated=generated,
            attributes=attributes,
        )[0]

    def add_instances(
        self,
        mesh: int,
        transforms: Any,
        materials: Sequence[int] = (),
        *,
        transforms_start: Any = None,
        transforms_end: Any = None,
        visibility: int = Ray.ALL,
        object_info: Any = None,
        holdout: bool = False,
        light_group: int = -1,
    ) -> int:
        """Adds copies of a mesh and returns the number of the first; shapes in `binding.scene_add_instances`."""
        return binding.scene_add_instances(
            self.handle,
            mesh,
            transforms,
            materials,
            transforms_start=transforms_start,
            transforms_end=transforms_end,
            visibility=visibility,
            object_info=object_info,
            holdout=holdout,
            light_group=light_group,
        )

    def set_transforms(self, first_instance: int, transforms: Any, transforms_start: Any = None, transforms_end: Any = None) -> None:
        """Moves instances; `commit` afterwards."""
        binding.scene_set_transforms(self.handle, first_instance, transforms, transforms_start, transforms_end)

    # ---- Light and camera ----

    def add_light(self, light: Light | None = None, **fields: Any) -> int:
        """Adds a lamp, given as a `Light` or by its fields, and returns its number."""
        return binding.scene_add_light(self.handle, light if light is not None else Light(**fields))

    def clear_lights(self) -> None:
        """Takes every lamp away."""
        binding.scene_clear_lights(self.handle)

    def set_world(self, world: World | None) -> None:
        """Sets the light from infinity; None is black."""
        binding.scene_set_world(self.handle, world)

    def set_camera(self, camera: Camera | None = None, **fields: Any) -> None:
        """Sets the camera, given as a `Camera` or by its fields."""
        binding.scene_set_camera(self.handle, camera if camera is not None else Camera(**fields))

    # ---- Use ----

    def commit(self) -> None:
        """Builds what changed since the last commit.

        Raises
        ------
        Cancelled
            If `cancel` was called; the scene has to be committed again before it is rendered.
        """
        binding.scene_commit(self.handle)

    def cancel(self) -> None:
        """Asks the commit that runs, or else the next one, to stop; from any thread."""
        binding.scene_cancel(self.handle)

    @property
    def statistics(self) -> dict[str, Any]:
        """Counts, memory (bytes), build time (s), and how often meshes, the top level and the tables of lights were built."""
        return binding.scene_get_statistics(self.handle)

    def intersect(self, origins: Any, directions: Any) -> dict[str, np.ndarray]:
        """Nearest hits of rays; see `binding.scene_intersect`."""
        return binding.scene_intersect(self.handle, origins, directions)
