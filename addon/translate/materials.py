# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials, each once: a gem as two spectra, anything else as the program that its node tree compiles to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from opal_kernels import gem as gems
from opal_kernels.descriptions import Fresnel, Gem, MaterialFlag, wavelengths
from opal_kernels.optics import species
from opal_kernels.scene import Scene

from .. import presets, units
from ..identity import Named, key_of
from ..nodes import compile_material, compile_missing, compile_volume, default_volume, has_surface, has_volume
from ..report import Report
from . import rainbow
from .spectra import Spectra
from .volumes import Body, Volumes

# The setting that fills a body, by the material's kind; of any other kind it is the Volume socket.
_FILLED_BY = {"GEM": "Clouded", "MEDIUM": "Medium", "RAINBOW": "Rainbow"}


class NeedsRebuild(Exception):
    """A change that cannot be made in a scene that stands; it has to be built anew."""


@dataclass
class _Known:
    """A material that the kernels have.

    Attributes
    ----------
    content : tuple
        All that was handed over; the same again changes nothing.
    in_place : bool
        Whether it can be replaced where it is: a surface, or a gem without a medium.
    spectra : list of int
        To be given back when it is replaced.
    """

    number: int = -1
    kind: str = ""
    content: tuple = ()
    in_place: bool = True
    spectra: list[int] = field(default_factory=list)


class Materials:
    """The kernel scene's materials by Blender's.

    Parameters
    ----------
    scene : Scene
        Takes the materials and their images.
    context : NodeContext
        Handed to the node readers.
    report : Report
        Told what the node readers could not keep.
    rain : Rain
        Makes media of rainbows.
    spectra : Spectra
        Takes the gems' tables.
    """

    def __init__(self, scene: Scene, context: Any, report: Report, rain: rainbow.Rain, spectra: Spectra) -> None:
        self._scene, self._context, self._report, self._rain, self._spectra = scene, context, report, rain, spectra
        self._lengths = units.Lengths()
        self.volumes = Volumes(scene, report.add)
        self._known: dict[tuple[Any, int, bool], _Known] = {}

    def begin(self, lengths: units.Lengths) -> None:
        """How long a unit is in what is read from now on."""
        self._lengths, self.volumes.metres = lengths, lengths.media

    def number(self, material: Any, body: Body | None = None) -> int:
        """The kernels' number of an evaluated material; None gives what Blender shows without one.

        Parameters
        ----------
        material : bpy.types.Material or None
        body : Body, optional
            What the material covers, where it matters (`fills`): its grids and box, and whether it is closed.
        """
        key = (key_of(material), body.key if body is not None else 0, body is None or body.closed)
        if key not in self._known:
            known = _Known(kind=material.opal.kind if material is not None else "", in_place=body is None and not fills(material))
            description = self._describe(material, body, known)
            known.number = self._scene.add_material(**description)
            self._known[key] = known
        return self._known[key].number

    def refresh(self, material: Any, before_change: Callable[[], None]) -> bool:
        """Reads an evaluated material once more.

        Parameters
        ----------
        material : bpy.types.Material
        before_change : callable
            Called before the kernels' scene is touched.

        Returns
        -------
        bool
            Whether it has become another.

        Raises
        ------
        NeedsRebuild
            If it cannot be replaced where it is: it fills something, or has become another kind.
        """
        changed = False
        mine = key_of(material)
        for old in [known for key, known in self._known.items() if key[0] == mine]:
            if not old.in_place or fills(material) or material.opal.kind != old.kind:
                raise NeedsRebuild
            if old.kind == "GEM" and _gem_content(material.opal.gem, _gem_tables(material.opal.gem, self._lengths)) == old.content:
                continue
            self._report.forget(Named(material))
            new = _Known(old.number, old.kind)
            description = self._describe(material, None, new)
            if new.content != old.content:
                before_change()
                self._scene.update_material(old.number, **description)
                changed = True
            self._spectra.release(old.spectra)
            old.content, old.spectra = new.content, new.spectra
        return changed

    def _describe(self, material: Any, body: Body | None, known: _Known) -> dict[str, Any]:
        """Arguments of `Scene.add_material`."""
        is_volume = body is not None and body.is_volume
        if material is None:
            return self._default_volume(body) if is_volume else self._program(compile_missing(self._context), known)
        settings = material.opal
        if body is not None and not body.closed:
            sentence = (
                f"the mesh is open, so the material “{material.name}” has nothing to fill; only its surface is rendered. Close its holes."
            )
            self._report.add(body.name, sentence, _FILLED_BY.get(settings.kind, "Volume"), lost=True)
            body = None
            if settings.kind != "GEM":
                return self._program(compile_material(material, self._context), known)
        if settings.kind == "GEM":
            return self._gem(Named(material), settings, body, known)
        if settings.kind in {"MEDIUM", "RAINBOW"}:
            return self._filling(Named(material), settings, body or Body(material.name))
        medium = self._volume_nodes(material, body) if body is not None else -1
        if is_volume or (medium >= 0 and not has_surface(material)):
            return {"flags": MaterialFlag.NO_SURFACE, "medium": medium}
        return self._program(compile_material(material, self._context), known, medium)

    def _default_volume(self, body: Body) -> dict[str, Any]:
        medium = self.volumes.add_compiled(default_volume(), body) if "density" in body.source.names else -1
        return {"flags": MaterialFlag.NO_SURFACE, "medium": medium}

    def _volume_nodes(self, material: Any, body: Body) -> int:
        compiled = compile_volume(material, self._context, body.source.names if body.source is not None else None)
        if compiled is None:
            return -1
        self._context.note(compiled.problems)
        return self.volumes.add_compiled(compiled, body)

    def _program(self, compiled: Any, known: _Known, medium: int = -1) -> dict[str, Any]:
        self._context.note(compiled.problems)
        self._context.program_compiled(compiled.code)
        flags = MaterialFlag(0)
        if compiled.caster:
            flags |= MaterialFlag.CASTER
        if compiled.emissive:
            flags |= MaterialFlag.EMISSIVE
        if compiled.transparent_shadow:
            flags |= MaterialFlag.TRANSPARENT_SHADOW
        known.content = (*program_content(compiled), int(flags))
        return {"program": compiled, "flags": flags, "medium": medium}

    def _filling(self, name: str, settings: Any, body: Body) -> dict[str, Any]:
        try:
            if settings.kind == "MEDIUM":
                medium = self.volumes.add_medium(settings.medium, body)
            else:
                medium = self._rain.add(settings.rainbow)
        except ValueError as error:
            self._report.add(name, f"{str(error).rstrip('.')}; the body is rendered empty.", lost=True)
            medium = -1
        return {"flags": MaterialFlag.NO_SURFACE, "medium": medium}

    def _gem(self, name: str, settings: Any, body: Body | None, known: _Known) -> dict[str, Any]:
        gem = settings.gem
        for sentence in _gem_refusals(gem, self._lengths.settings):
            self._report.add(name, sentence)
        index, absorption = tables = _gem_tables(gem, self._lengths)
        known.spectra = [self._spectra.take(table) for table in (index, absorption) if table is not None]
        known.content = _gem_content(gem, tables)
        description = Gem(
            index_spectrum=known.spectra[0],
            absorption_spectrum=-1 if absorption is None else known.spectra[1],
            roughness=gem.roughness,
            fresnel=Fresnel[gem.fresnel],
            priority=gem.priority,
        )
        medium = self.volumes.add_medium(settings.medium, body) if settings.use_medium and body is not None else -1
        return {"gem": description, "flags": MaterialFlag.CASTER, "medium": medium}


def program_content(compiled: Any) -> tuple:
    """What makes two programs the same."""
    return compiled.code.tobytes(), compiled.constants.tobytes(), compiled.n_registers


def _gem_refusals(gem: Any, metres: float) -> list[str]:
    """Sentences on numbers that no gem can have, and on a species that there is not; `metres` per unit of its settings."""
    if presets.species_of(gem) != presets.CUSTOM:
        return []
    settings = presets.settings_of(gem, metres)
    sentences = ["Its species is none that this version of Opal knows; it is rendered by its numbers."] if presets.is_unknown(gem) else []
    if sentence := gems.refusal(settings):
        sentences.append(sentence + " The gem is rendered with an index of 1.5.")
    if sentence := gems.absorption_refusal(settings):
        sentences.append(sentence + " The gem is rendered clear.")
    return sentences


def _gem_tables(gem: Any, lengths: units.Lengths) -> tuple[Any, Any]:
    """`gem_spectra` as rendered: an index of 1.5 for one that cannot be, and the absorption per unit."""
    index, absorption = gem_spectra(gem, lengths.settings)
    if presets.species_of(gem) == presets.CUSTOM and gems.refusal(presets.settings_of(gem)):
        index[:] = 1.5
    return index, None if absorption is None else absorption * lengths.stones


def _gem_content(gem: Any, tables: tuple[Any, Any]) -> tuple:
    """What makes two gems the same; `tables` are `_gem_tables`."""
    content = (None if table is None else table.tobytes() for table in tables)
    return (*content, gem.roughness, gem.fresnel, gem.priority)


def fills(material: Any) -> bool:
    """Whether a material has to do with the inside of what it covers."""
    if material is None:
        return False
    settings = material.opal
    if settings.kind == "GEM":
        return settings.use_medium
    return settings.kind in {"MEDIUM", "RAINBOW"} or has_volume(material)


def bounds_a_medium(material: Any) -> bool:
    """Whether a material fills what it covers and has no surface."""
    kind = material.opal.kind
    return kind in {"MEDIUM", "RAINBOW"} or (kind == "SURFACE" and has_volume(material) and not has_surface(material))


def gem_spectra(gem: Any, metres: float = 1.0) -> tuple[Any, Any]:
    """n and σa (1/m, or None) at 360 ... 830 nm of a gem: the species' own tables, or what its numbers say.

    Parameters
    ----------
    gem : OpalGemProperties
    metres : float
        Per unit of its settings (`units`).
    """
    name = presets.species_of(gem)
    if name == presets.CUSTOM:
        settings = presets.settings_of(gem, metres)
        return gems.index(settings), None if gems.absorption_refusal(settings) else gems.absorption(settings)
    index, absorption = species.index(name, wavelengths()), species.absorption(name, wavelengths())
    return index, absorption if absorption.any() else None
