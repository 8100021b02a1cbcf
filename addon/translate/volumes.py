# SPDX-License-Identifier: GPL-3.0-or-later
"""Media of Opal's own settings and of volume node trees as media of the kernels' scene."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from opal_kernels import binding
from opal_kernels.descriptions import Attribute, Density, EmissionDensity, Medium, MediumLayer, Phase, PhaseKind
from opal_kernels.optics import colour, illuminants, uplift
from opal_kernels.scene import Scene

from ..nodes import Coefficient, CompiledVolume
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
    key : hashable
        The same for bodies that are alike.
    closed : bool
        Whether there is an inside.
    is_volume : bool
        It is a volume object, which has no surface.
    density : float
        What its coefficients are multiplied by: see `voxels.density_by_scale`.
    """

    def __init__(
        self,
        name: str,
        source: Source | None = None,
        box: Any = None,
        transform: Any = None,
        key: Any = 0,
        closed: bool = True,
        is_volume: bool = False,
        density: float = 1.0,
    ) -> None:
        self.name, self.source, self.box, self.key = name, source, box, key
        self.closed, self.is_volume, self.density = closed, is_volume, density
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
        `Report.add`.

    Attributes
    ----------
    metres : float
        Per unit: Opal's own settings are by the metre, node trees by the unit.
    """

    def __init__(self, scene: Scene, problem: Callable[..., None]) -> None:
        self._scene, self._problem = scene, problem
        self.metres = 1.0
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

    def _missing(self, body: Body, name: str, part: str = "") -> None:
        """Names a grid that is not there; one that could not be read has said so itself."""
        if body.source is None:
            text = "there are no grids in what is neither a volume object nor a smoke domain; it is rendered as nothing."
        elif not name:
            text = "no grid is named; it is rendered as nothing."
        elif name not in body.source.names:
            text = f"there is no grid named “{name}”; it is rendered as nothing."
        else:
            return
        self._problem(body.name, text, part, lost=True)

    def _density(self, body: Body, name: str, part: str = "") -> int:
        """1 + number of a grid of the body with one channel; 0, with a sentence, where it has none of that name.

        `part` is the setting that names it.
        """
        key = (body.source.key if body.source is not None else 0, name, False)
        if key not in self._grids:
            voxels = body.read(name)
            if voxels is None:
                self._missing(body, name, part)
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
            grid = self._density(body, settings.grid, "Grid")
            if not grid:
                return -1
            fields = {"density": Density.GRID, "density_grid": grid, **fields}
        by_unit = body.density * self.metres
        emission = emission_of(settings)
        if emission is not None:
            emission = by_unit * emission
        if emission is not None and settings.emission_grid:
            grid = self._density(body, settings.emission_grid, "Emission Grid")
            emission = emission if grid else None
            fields |= {"emission_density": EmissionDensity.GRID, "emission_density_grid": grid} if grid else {}
        extinction = by_unit * settings.extinction * uplift.reflectance(tuple(settings.extinction_color))
        phase = Phase(kind=PhaseKind[settings.phase], anisotropy=settings.anisotropy)
        return self._scene.add_medium(extinction, uplift.reflectance(tuple(settings.albedo)), phase, emission, **fields)

    # ---- Node trees ----

    def add_compiled(self, volume: CompiledVolume, body: Body) -> int:
        """Adds a volume that nodes describe; returns the medium's number, -1 where nothing of it is left.

        Every phase function scatters by coefficients of its own, so each makes a medium, and the kernels join them.
        """
        number = -1
        for medium in reversed(self._media(volume, body)):
            medium.also = 1 + number
            number = binding.scene_add_medium(self._scene.handle, medium)
            self._scene.set_medium_layer(number, MediumLayer.BASE)  # nodes that Cycles renders as well
        return number

    def _media(self, volume: CompiledVolume, body: Body) -> list[Medium]:
        media = []
        absorption = volume.absorption
        for lobe in volume.scattering:
            with_it = absorption if _in_the_same_places(lobe.coefficient, absorption) else Coefficient()
            medium = self._medium(volume, body, lobe.coefficient, with_it)
            if medium is None:
                continue
            if with_it.present:
                absorption = Coefficient()
            medium.phase = binding.scene_add_phase(self._scene.handle, lobe.phase)
            media.append(medium)
        if absorption.present and (medium := self._medium(volume, body, Coefficient(), absorption)) is not None:
            media.append(medium)
        glowing = media[0] if media else Medium()
        if self._add_emission(volume, body, glowing) and not media:
            media.append(glowing)
        return media

    def _medium(self, volume: CompiledVolume, body: Body, scattering: Coefficient, absorption: Coefficient) -> Medium | None:
        """What is scattered and absorbed in the same places; None where that is nothing."""
        medium = Medium()
        if any(c.program is not None for c in (scattering, absorption)):
            lattice = self._lattice(volume, body)
            medium.scattering_grid = self._baked(scattering, volume, body, lattice, "scattering")
            medium.absorption_grid = self._baked(absorption, volume, body, lattice, "absorption")
            return medium
        if grid := scattering.grid or absorption.grid:
            medium.density, medium.density_grid = Density.GRID, self._density(body, grid)
            if not medium.density_grid:
                return None
        scattered = body.density * uplift.reflectance(scattering.constant)
        medium.extinction = self._scene.add_spectrum(scattered + body.density * uplift.reflectance(absorption.constant))
        if scattering.present:
            medium.scattering = self._scene.add_spectrum(scattered)
        return medium

    def _add_emission(self, volume: CompiledVolume, body: Body, medium: Medium) -> bool:
        """Lets a medium glow; False where there is nothing that does."""
        emission = volume.emission
        if emission.program is not None or any(b.grid for b in volume.blackbodies) or (volume.blackbodies and emission.grid):
            medium.emission_grid = self._baked(emission, volume, body, self._lattice(volume, body), "emission")
            return medium.emission_grid != 0
        rgb = np.array(emission.constant) + sum((blackbody_rgb(b, b.temperature) for b in volume.blackbodies), np.zeros(3))
        if not rgb.any():
            return False
        medium.emission_density = EmissionDensity.EVERYWHERE
        if emission.grid:
            medium.emission_density = EmissionDensity.GRID
            medium.emission_density_grid = self._density(body, emission.grid)
            if not medium.emission_density_grid:
                return False
        medium.emission = self._scene.add_spectrum(body.density * uplift.emission(rgb))
        return True

    def _lattice(self, volume: CompiledVolume, body: Body) -> Voxels:
        """Where nodes are asked: the finest of the body's grids that they read, or a lattice over its box and a voxel more."""
        names = [*volume.grids, *(b.grid for b in volume.blackbodies if b.grid)]
        names += [c.grid for c in volume.coefficients if c.grid]
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
        values = body.density * values
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


def _in_the_same_places(a: Coefficient, b: Coefficient) -> bool:
    """Whether two coefficients can share a medium: both baked, or both a constant times the same density."""
    return a.present and b.present and (a.program is None) == (b.program is None) and a.grid == b.grid
