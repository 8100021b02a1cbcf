# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials, each once: a gem as two spectra, anything else as the program that its node tree compiles to."""

from __future__ import annotations

from typing import Any

from opal_kernels import gem as gems
from opal_kernels.descriptions import Fresnel, Gem, MaterialFlag, wavelengths
from opal_kernels.optics import species
from opal_kernels.scene import Scene

from .. import presets
from ..nodes import compile_material, compile_missing
from ..report import Report
from . import media, rainbow


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
        self._numbers: dict[int, int] = {}

    def number(self, material: Any) -> int:
        """The kernels' number of an evaluated material; None gives what Blender shows without one."""
        key = material.as_pointer() if material is not None else 0
        if key not in self._numbers:
            self._numbers[key] = self._add(material)
        return self._numbers[key]

    def _add(self, material: Any) -> int:
        if material is None:
            return self._add_program(compile_missing(self._context))
        settings = material.opal
        if settings.kind == "GEM":
            return self._add_gem(material.name, settings.gem)
        if settings.kind in {"MEDIUM", "RAINBOW"}:
            return self._add_filling(material.name, settings)
        return self._add_program(compile_material(material, self._context))

    def _add_program(self, compiled: Any) -> int:
        self._context.note(compiled.problems)
        self._context.program_compiled(compiled.code)
        flags = MaterialFlag(0)
        if compiled.caster:
            flags |= MaterialFlag.CASTER
        if compiled.emissive:
            flags |= MaterialFlag.EMISSIVE
        if compiled.transparent_shadow:
            flags |= MaterialFlag.TRANSPARENT_SHADOW
        return self._scene.add_material(compiled, flags=flags)

    def _add_filling(self, name: str, settings: Any) -> int:
        try:
            if settings.kind == "MEDIUM":
                medium = media.add_medium(self._scene, settings.medium)
            else:
                medium = self._rain.add(settings.rainbow)
        except ValueError as error:
            self._report.add(name, f"{error} The body is rendered empty.")
            medium = -1
        return self._scene.add_material(flags=MaterialFlag.NO_SURFACE, medium=medium)

    def _add_gem(self, name: str, gem: Any) -> int:
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
        return self._scene.add_material(gem=description, flags=MaterialFlag.CASTER)


def gem_spectra(gem: Any) -> tuple[Any, Any]:
    """n and σa (1/m, or None) at 360 ... 830 nm of a gem: the species' own tables, or what its numbers say."""
    if gem.species == presets.CUSTOM:
        settings = presets.settings_of(gem)
        return gems.index(settings), None if gems.absorption_refusal(settings) else gems.absorption(settings)
    index, absorption = species.index(gem.species, wavelengths()), species.absorption(gem.species, wavelengths())
    return index, absorption if absorption.any() else None
