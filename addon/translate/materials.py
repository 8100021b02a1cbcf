# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials, each once: a gem as two spectra, anything else as the program that its node tree compiles to."""

from __future__ import annotations

from typing import Any

from opal_kernels import gem as gems
from opal_kernels.descriptions import Fresnel, Gem, MaterialFlag, wavelengths
from opal_kernels.optics import species
from opal_kernels.scene import Scene

from .. import presets
from ..nodes import compile_material, compile_missing, compile_volume, default_volume, has_surface, has_volume
from ..report import Report
from . import rainbow
from .volumes import Body, Volumes


class Materials:
    """The kernel scene's materials by Blender's.

    Parameters
    ----------
    scene : Scene
        Takes the materials, their spectra and images.
    context : NodeContext
        Handed to the node readers.
    report : Report
        Told what the node readers could not keep.
    rain : Rain
        Makes media of rainbows.
    absorption_scale : float
        Factor on the absorption of gems: below 1 they look like smaller stones.
    """

    def __init__(self, scene: Scene, context: Any, report: Report, rain: rainbow.Rain, absorption_scale: float = 1.0) -> None:
        self._scene, self._context, self._report, self._rain = scene, context, report, rain
        self._absorption_scale = absorption_scale
        self.volumes = Volumes(scene, report.add)
        self._numbers: dict[tuple[int, int, bool], int] = {}

    def number(self, material: Any, body: Body | None = None) -> int:
        """The kernels' number of an evaluated material; None gives what Blender shows without one.

        Parameters
        ----------
        material : bpy.types.Material or None
        body : Body, optional
            What the material covers, where it matters (`fills`): its grids and box, and whether it is closed.
        """
        key = (material.as_pointer() if material is not None else 0, body.key if body is not None else 0, body is None or body.closed)
        if key not in self._numbers:
            self._numbers[key] = self._add(material, body)
        return self._numbers[key]

    def _add(self, material: Any, body: Body | None) -> int:
        is_volume = body is not None and body.is_volume
        if material is None:
            return self._add_default_volume(body) if is_volume else self._add_program(compile_missing(self._context))
        settings = material.opal
        if body is not None and not body.closed:
            self._report.add(body.name, "The mesh is open, so it cannot hold a medium; only its surface is rendered.")
            body = None
            if settings.kind != "GEM":
                return self._add_program(compile_material(material, self._context))
        if settings.kind == "GEM":
            return self._add_gem(material.name, settings, body)
        if settings.kind in {"MEDIUM", "RAINBOW"}:
            return self._add_filling(material.name, settings, body or Body(material.name))
        medium = self._add_volume_nodes(material, body) if body is not None else -1
        if is_volume or (medium >= 0 and not has_surface(material)):
            return self._scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)
        return self._add_program(compile_material(material, self._context), medium)

    def _add_default_volume(self, body: Body) -> int:
        medium = self.volumes.add_compiled(default_volume(), body) if "density" in body.source.names else -1
        return self._scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)

    def _add_volume_nodes(self, material: Any, body: Body) -> int:
        compiled = compile_volume(material, self._context, body.source.names if body.source is not None else None)
        if compiled is None:
            return -1
        self._context.note(compiled.problems)
        return self.volumes.add_compiled(compiled, body)

    def _add_program(self, compiled: Any, medium: int = -1) -> int:
        self._context.note(compiled.problems)
        self._context.program_compiled(compiled.code)
        flags = MaterialFlag(0)
        if compiled.caster:
            flags |= MaterialFlag.CASTER
        if compiled.emissive:
            flags |= MaterialFlag.EMISSIVE
        if compiled.transparent_shadow:
            flags |= MaterialFlag.TRANSPARENT_SHADOW
        return self._scene.add_material(compiled, flags=flags, medium=medium)

    def _add_filling(self, name: str, settings: Any, body: Body) -> int:
        try:
            if settings.kind == "MEDIUM":
                medium = self.volumes.add_medium(settings.medium, body)
            else:
                medium = self._rain.add(settings.rainbow)
        except ValueError as error:
            self._report.add(name, f"{error} The body is rendered empty.")
            medium = -1
        return self._scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)

    def _add_gem(self, name: str, settings: Any, body: Body | None) -> int:
        gem = settings.gem
        index, absorption = gem_spectra(gem)
        if sentence := gems.refusal(presets.settings_of(gem)) if gem.species == presets.CUSTOM else "":
            self._report.add(name, sentence + " The gem is rendered with an index of 1.5.")
            index[:] = 1.5
        if sentence := gems.absorption_refusal(presets.settings_of(gem)) if gem.species == presets.CUSTOM else "":
            self._report.add(name, sentence + " The gem is rendered clear.")
        if absorption is not None:
            absorption = absorption * self._absorption_scale
        description = Gem(
            index_spectrum=self._scene.add_spectrum(index),
            absorption_spectrum=-1 if absorption is None else self._scene.add_spectrum(absorption),
            roughness=gem.roughness,
            fresnel=Fresnel[gem.fresnel],
            priority=gem.priority,
        )
        medium = self.volumes.add_medium(settings.medium, body) if settings.use_medium and body is not None else -1
        return self._scene.add_material(gem=description, flags=MaterialFlag.CASTER, medium=medium)


def fills(material: Any) -> bool:
    """Whether a material has to do with the inside of what it covers."""
    if material is None:
        return False
    settings = material.opal
    if settings.kind == "GEM":
        return settings.use_medium
    return settings.kind in {"MEDIUM", "RAINBOW"} or has_volume(material)


def gem_spectra(gem: Any) -> tuple[Any, Any]:
    """n and σa (1/m, or None) at 360 ... 830 nm of a gem: the species' own tables, or what its numbers say."""
    if gem.species == presets.CUSTOM:
        settings = presets.settings_of(gem)
        return gems.index(settings), None if gems.absorption_refusal(settings) else gems.absorption(settings)
    index, absorption = species.index(gem.species, wavelengths()), species.absorption(gem.species, wavelengths())
    return index, absorption if absorption.any() else None
