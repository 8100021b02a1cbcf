# SPDX-License-Identifier: GPL-3.0-or-later
"""Media of Opal's own settings and of volume node trees as media of the kernels' scene."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from opal_kernels import binding
from opal_kernels.descriptions import Attribute, Density, EmissionDensity, Medium, MediumLayer, Phase, PhaseKind
from opal_kernels.optics import colour, illuminants, uplift
from opal_kernels.optics import phase_functions as phases
from opal_kernels.scene import Scene

from ..nodes import CompiledVolume
from .voxels import Source, Voxels

# Voxels along the longest side of a mesh whose medium is computed by nodes.
BAKED_VOXELS = 96
# Cycles' Principled Volume: radiance of a blackbody by temperature, Stefan and Boltzmann, in its own unit.
_STEFAN_BOLTZMANN = 5.670373e-8 * 1e-6 / np.pi


class Body:
    """What a medium fills: its grids, or the box of its mesh.

    Parameters
    ----------
    name : str
        Of the object.
    source : Source, optional
        Its grids.
    box : (ndarray, ndarray)
        Corners of the mesh in object space.
    transform : ndarray
        (3, 4) or (4, 4), object to world, of its first copy.
    key : int
        The same for bodies that are alike.
    closed : bool
        Whether there is an inside.
    is_volume : bool
        It is a volume object, which has no surface.
    """

    def __init__(
        self,
        name: str,
        source: Source | None = None,
        box: Any = None,
        transform: Any = None,
        key: int = 0,
        closed: bool = True,
        is_volume: bool = False,
    ) -> None:
        self.name, self.source, self.box, self.key = name, source, box, key
        self.closed, self.is_volume = closed, is_volume
        self.transform = np.eye(4)[:3] if transform is None else np.asarray(transform, float)[:3]
        self.used: list[Voxels] = []  # grids that a medium was made of

    def read(self, name: str) -> Voxels | None:
        """One of its grids, or None."""
        return self.source.read(name) if self.source is not None else None

    def bounds(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Corners of the box that holds every grid in use; None where none is."""
        boxes = [voxels.bounds() for voxels in self.used]
        if not boxes:
            return None
        return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)


class Volumes:
    """Adds media to a scene.

    Parameters
    ----------
    scene : Scene
    problem : callable
        Takes a name and a sentence.
    """

    def __init__(self, scene: Scene, problem: Callable[[str, str], None]) -> None:
        self._scene, self._problem = scene, problem
        self._grids: dict[tuple[int, str, bool], int] = {}

    # ---- Grids ----

    def add_voxels(self, voxels: Voxels, name: str) -> int:
        """Adds a grid; returns 1 + its number. Values that are no densities are counted in the report."""
        values = voxels.values
        grid = binding.scene_add_grid(self._scene.handle, values.shape[:3], voxels.transform, 3 if values.ndim == 4 else 1)
        not_finite, negative = binding.scene_set_grid_block(self._scene.handle, grid, values)
        if not_finite:
            self._problem(name, f"{not_finite} voxels are not finite numbers and are taken as empty")
        if negative:
            self._problem(name, f"{negative} voxels are negative and are taken as empty")
        return 1 + grid

    def _missing(self, body: Body, name: str) -> None:
        """Names a grid that is not there; one that could not be read has said so itself."""
        if body.source is None or name not in body.source.names:
            self._problem(body.name, f"There is no grid named “{name}”; it is rendered as nothing.")

    def _density(self, body: Body, name: str) -> int:
        """1 + number of a grid of the body with one channel; 0, with a sentence, where it has none of that name."""
        key = (body.source.key if body.source is not None else 0, name, False)
        if key not in self._grids:
            voxels = body.read(name)
            if voxels is None:
                self._missing(body, name)
                self._grids[key] = 0
            else:
                body.used.append(voxels)
                single = voxels if voxels.values.ndim == 3 else Voxels(voxels.values.mean(axis=-1), voxels.transform)
                self._grids[key] = self.add_voxels(single, f"{body.name}, grid “{name}”")
        elif (voxels := body.read(name)) is not None and all(voxels is not used for used in body.used):
            body.used.append(voxels)
        return self._grids[key]

    # ---- Opal's own settings ----

    def add_medium(self, settings: Any, body: Body, **fields: Any) -> int:
        """Adds what `OpalMediumProperties` says; returns the medium's number, -1 for nothing."""
        if settings.density == "NOISE":
            fields = {
                "density": Density.NOISE,
                "noise_scale": settings.noise_scale,
                "noise_detail": settings.noise_detail,
                "noise_contrast": settings.noise_contrast,
                "noise_seed": settings.noise_seed,
                **fields,
            }
        elif settings.density == "GRID":
            grid = self._density(body, settings.grid)
            if not grid:
                return -1
            fields = {"density": Density.GRID, "density_grid": grid, **fields}
        emission = emission_of(settings)
        if emission is not None and settings.emission_grid:
            grid = self._density(body, settings.emission_grid)
            emission = emission if grid else None
            fields |= {"emission_density": EmissionDensity.GRID, "emission_density_grid": grid} if grid else {}
        extinction = settings.extinction * uplift.reflectance(tuple(settings.extinction_color))
        phase = Phase(kind=PhaseKind[settings.phase], anisotropy=settings.anisotropy)
        return self._scene.add_medium(extinction, uplift.reflectance(tuple(settings.albedo)), phase, emission, **fields)

    # ---- Node trees ----

    def add_compiled(self, volume: CompiledVolume, body: Body) -> int:
        """Adds a volume that nodes describe; returns the medium's number, -1 where nothing of it is left."""
        medium = Medium()
        self._add_coefficients(volume, body, medium)
        self._add_emission(volume, body, medium)
        if volume.phases:
            medium.phase = binding.scene_add_phase(self._scene.handle, mixture(volume.phases))
        empty = (medium.extinction, medium.emission) == (-1, -1)
        if empty and not (medium.scattering_grid or medium.absorption_grid or medium.emission_grid):
            return -1
        number = binding.scene_add_medium(self._scene.handle, medium)
        self._scene.set_medium_layer(number, MediumLayer.BASE)  # nodes that Cycles renders as well
        return number

    def _add_coefficients(self, volume: CompiledVolume, body: Body, medium: Medium) -> None:
        parts = [c for c in (volume.scattering, volume.absorption) if c.present]
        if not parts:
            return
        if any(c.program is not None for c in parts) or len({c.grid for c in parts}) > 1:
            lattice = self._lattice(volume, body)
            for kind in ("scattering", "absorption"):
                setattr(medium, f"{kind}_grid", self._baked(getattr(volume, kind), volume, body, lattice, kind))
            return
        scattering = uplift.reflectance(volume.scattering.constant)
        extinction = scattering + uplift.reflectance(volume.absorption.constant)
        if parts[0].grid:
            medium.density, medium.density_grid = Density.GRID, self._density(body, parts[0].grid)
            if not medium.density_grid:
                return
        medium.extinction = self._scene.add_spectrum(extinction)
        medium.scattering = self._scene.add_spectrum(scattering)

    def _add_emission(self, volume: CompiledVolume, body: Body, medium: Medium) -> None:
        emission = volume.emission
        if emission.program is not None or any(b.grid for b in volume.blackbodies) or (volume.blackbodies and emission.grid):
            medium.emission_grid = self._baked(emission, volume, body, self._lattice(volume, body), "emission")
            return
        rgb = np.array(emission.constant) + sum((blackbody_rgb(b, b.temperature) for b in volume.blackbodies), np.zeros(3))
        if not rgb.any():
            return
        medium.emission_density = EmissionDensity.EVERYWHERE
        if emission.grid:
            medium.emission_density = EmissionDensity.GRID
            medium.emission_density_grid = self._density(body, emission.grid)
            if not medium.emission_density_grid:
                return
        medium.emission = self._scene.add_spectrum(uplift.emission(rgb))

    def _lattice(self, volume: CompiledVolume, body: Body) -> Voxels:
        """Where nodes are asked: the finest of the body's grids that they read, or a lattice over its box and a voxel more."""
        names = [*volume.grids, *(b.grid for b in volume.blackbodies if b.grid)]
        names += [c.grid for c in (volume.scattering, volume.absorption, volume.emission) if c.grid]
        read = [voxels for name in names if (voxels := body.read(name)) is not None]
        if not read and body.source is not None:
            read = [voxels for name in body.source.names if (voxels := body.read(name)) is not None]
        if read:
            finest = max(read, key=lambda voxels: int(np.prod(voxels.values.shape[:3])))
            body.used.append(finest)
            return finest
        low, high = (np.asarray(c, float) for c in body.box)
        size = np.maximum(high - low, 1e-6)
        counts = np.maximum(2, np.ceil(size / size.max() * BAKED_VOXELS)).astype(int)
        step = size / (counts - 1)
        transform = np.eye(4)
        transform[range(3), range(3)], transform[:3, 3] = step, low - step
        return Voxels(np.zeros(tuple(counts + 2), np.float32), transform)

    def _baked(self, coefficient: Any, volume: CompiledVolume, body: Body, lattice: Voxels, kind: str) -> int:
        """1 + number of a grid of colours: a coefficient at each voxel; 0 where it is nothing."""
        blackbodies = volume.blackbodies if kind == "emission" else []
        if not coefficient.present and not blackbodies:
            return 0
        shape = lattice.values.shape[:3]
        if coefficient.program is not None:
            values = self._evaluate(coefficient.program, volume, body, lattice)
        else:
            factor = np.ones(shape, np.float32)
            if coefficient.grid:
                grid = body.read(coefficient.grid)
                factor = grid.at(lattice) if grid is not None else np.zeros(shape, np.float32)
            values = factor[..., None] * np.array(coefficient.constant, np.float32)
        for b in blackbodies:
            temperature = np.full(shape, b.temperature, np.float32)
            if b.grid and (grid := body.read(b.grid)) is not None:
                temperature = b.temperature * np.maximum(grid.at(lattice), 0)
            values = values + blackbody_grid(b, temperature)
        return self.add_voxels(Voxels(np.ascontiguousarray(values, np.float32), lattice.transform), f"{body.name}, {kind}")

    def _evaluate(self, program: Any, volume: CompiledVolume, body: Body, lattice: Voxels) -> np.ndarray:
        places = lattice.places()
        low, high = lattice.bounds() if body.box is None else (np.asarray(c, float) for c in body.box)
        generated = (places - low) / np.maximum(high - low, 1e-12)
        attributes, known = [], np.zeros(len(places), bool)
        for name, number in volume.grids.items():
            grid = body.read(name)
            if grid is None:
                if body.source is not None:
                    self._missing(body, name)
                continue
            values = grid.at(lattice).reshape(len(places), -1)
            known |= (values != 0).any(axis=1)
            attributes.append((number, values))
        ask = np.ones(len(places), bool)
        if attributes and not self._ask(program, body, places[:: max(1, len(places) // 64)], None, []).any():
            ask = known  # where grids are empty there is nothing
        chosen = [Attribute(number, 1, values[ask]) for number, values in attributes]
        out = np.zeros((len(places), 3), np.float32)
        out[ask] = self._ask(program, body, places[ask], generated[ask], chosen)
        return np.maximum(out, 0).reshape(*lattice.values.shape[:3], 3)

    def _ask(self, program: Any, body: Body, places: np.ndarray, generated: Any, attributes: list[Attribute]) -> np.ndarray:
        return binding.scene_evaluate(
            self._scene.handle, program, places, generated=generated, transform=body.transform, attributes=attributes
        )


def emission_of(settings: Any) -> np.ndarray | None:
    """Radiance per metre (471,) of `OpalMediumProperties`, or None."""
    if not settings.emission_strength > 0.0:
        return None
    if settings.emission_source == "BLACKBODY":
        return settings.emission_strength * illuminants.blackbody(settings.emission_temperature)
    if not max(settings.emission_color) > 0.0:
        return None
    return uplift.emission(tuple(settings.emission_color)) * settings.emission_strength


def blackbody_rgb(b: Any, kelvin: float) -> np.ndarray:
    """Radiance per metre of Cycles' Principled Volume at one temperature, linear Rec.709."""
    intensity = _STEFAN_BOLTZMANN * ((1 - b.intensity) + b.intensity * kelvin**4)
    return intensity * np.maximum(colour.blackbody_rec709(float(np.clip(kelvin, 800.0, 12_000.0))), 0) * np.array(b.tint)


def blackbody_grid(b: Any, kelvin: np.ndarray) -> np.ndarray:
    """The same at many temperatures, from a table over them; nothing at 0 K."""
    top = float(kelvin.max())
    if not top > 0:
        return np.zeros((*kelvin.shape, 3), np.float32)
    nodes = np.linspace(0, top, 257)
    rows = np.array([blackbody_rgb(b, t) for t in nodes])
    rows[0] = 0
    return np.stack([np.interp(kelvin, nodes, rows[:, c]) for c in range(3)], -1).astype(np.float32)


def mixture(weighted: list[tuple[float, Phase]]) -> Phase:
    """One phase function for several: itself where they are one, else a table of their mean by scattering."""
    first = weighted[0][1]
    if all((p.kind, p.anisotropy) == (first.kind, first.anisotropy) and p.values is first.values for _, p in weighted):
        return first
    angles = phases.table_angles()
    cosine = np.cos(angles)
    values = sum(weight * _values(phase, angles, cosine) for weight, phase in weighted)
    return Phase(PhaseKind.TABLE, wavelengths=[550.0], angles=angles, values=(values / sum(w for w, _ in weighted))[None])


def _values(phase: Phase, angles: np.ndarray, cosine: np.ndarray) -> np.ndarray:
    if phase.kind == PhaseKind.TABLE:
        return np.interp(angles, phase.angles, np.asarray(phase.values)[0])
    if phase.kind == PhaseKind.RAYLEIGH:
        return phases.rayleigh(cosine)
    return phases.henyey_greenstein(cosine, phase.anisotropy if phase.kind == PhaseKind.HENYEY_GREENSTEIN else 0.0)
