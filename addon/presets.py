# SPDX-License-Identifier: GPL-3.0-or-later
"""Gem species in the interface: the list, and what happens when one is chosen or a number is edited.

Choosing a species fills the numbers; editing a number makes the species Custom and keeps every other number. Numbers that
cannot be rendered are refused: the last ones that could are put back, and the sentence stands in the panel until the next edit.
"""

from __future__ import annotations

import dataclasses
import zlib
from typing import Any

from . import twin_updates, units

CUSTOM = "CUSTOM"

# Blender keeps the strings of a dynamic enumeration by reference only: they have to live here.
_items: list[tuple[str, str, str, int]] = []
_items_of_31_bits: list[tuple[str, str, str, int]] = []
# True while a file is read whose species have the numbers of layout 1.
_reading_31_bits = False
# True while this module writes properties itself, so that their callbacks stay silent.
_filling = False


def species_items(_owner: Any = None, _context: Any = None) -> list[tuple[str, str, str, int]]:
    """Items of `material.opal.gem.species`."""
    if not _items:
        from opal_kernels.optics import species

        _items.append((CUSTOM, "Custom", "The numbers below, as they are", 0))
        for name, row in species.table().items():
            note = f". {row.note}" if row.note else ""
            _items.append((name, row.label, f"{row.label}: index of refraction after {row.source}{note}", species_number(name)))
        _items_of_31_bits.extend((*item[:3], item[3] and zlib.crc32(item[0].encode()) & 0x7FFFFFFF) for item in _items)
    return _items_of_31_bits if _reading_31_bits else _items


def species_number(name: str) -> int:
    """What a species is saved as: a number made of its name, so that rows may come and go in the table.

    Keyframes hold single precision and are rounded by adding a half, which keeps whole numbers of 23 bits.
    """
    return zlib.crc32(name.encode()) & 0x7FFFFF


def renumber_species(gems: list[Any]) -> None:
    """Species of files of layout 1, which were saved as numbers of 31 bits, get those of this version."""
    global _filling, _reading_31_bits
    _reading_31_bits = True
    try:
        names = [gem.species for gem in gems]
    finally:
        _reading_31_bits = False
    _filling = True
    try:
        for gem, name in zip(gems, names, strict=True):
            if name:
                gem.species = name
    finally:
        _filling = False


def is_unknown(gem: Any) -> bool:
    """Whether a gem's species is none of this version's, such as one of a newer file."""
    from opal_kernels.optics import species

    return gem.species != CUSTOM and gem.species not in species.table()


def species_of(gem: Any) -> str:
    """The species by whose own tables a gem is rendered; CUSTOM where that is its numbers.

    Drivers and keyframes write numbers without the interface's callbacks: what differs from what the species filled in makes
    the stone Custom as an edit does.
    """
    if is_unknown(gem) or _index_differs(gem) or _absorption_differs(gem) or gem.last_good_source not in ("", gem.absorption_source):
        return CUSTOM
    return gem.species


def _index_differs(gem: Any) -> bool:
    return _index_numbers(gem) != tuple(gem.last_good) or gem.dispersion != gem.last_good_dispersion


def _absorption_differs(gem: Any) -> bool:
    return (*gem.absorption_color, gem.absorption_depth) != tuple(gem.last_good_absorption)


def settings_of(gem: Any, metres: float = 1.0) -> Any:
    """The `opal_kernels.gem.Settings` that a gem's properties show.

    Parameters
    ----------
    gem : OpalGemProperties
    metres : float
        Per unit (`units`), which the absorption depth is in; nothing else depends on it.
    """
    from opal_kernels.gem import Settings

    # A color that was driven away from a species' counts before the species' curve, as an edited one does.
    by_curve = gem.absorption_source == "CURVE" and (gem.species == CUSTOM or not _absorption_differs(gem))
    return Settings(
        dispersion=gem.dispersion,
        cauchy=(gem.cauchy_b, gem.cauchy_c),
        sellmeier_b=tuple(gem.sellmeier_b),
        sellmeier_c=tuple(gem.sellmeier_c),
        absorption_color=tuple(gem.absorption_color),
        absorption_depth=gem.absorption_depth * metres,
        absorption_curve=curve_of(gem) if by_curve else None,
    )


def curve_of(gem: Any) -> list[tuple[float, float]]:
    """Samples of a gem's absorption curve: wavelength (nm), absorption (1/mm)."""
    return [(sample.wavelength, sample.absorption) for sample in gem.absorption_curve]


def set_curve(gem: Any, samples: Any) -> None:
    """Fills a gem's absorption curve, and makes it what the stone absorbs by; no edit of the interface.

    Parameters
    ----------
    samples : iterable of (float, float)
        Wavelength (nm) and absorption (1/mm), already known to be good.
    """
    global _filling
    filling, _filling = _filling, True
    try:
        gem.absorption_curve.clear()
        for nm, value in samples:
            sample = gem.absorption_curve.add()
            sample.wavelength, sample.absorption = nm, value
            sample.last_good = nm, value
        gem.absorption_source = gem.last_good_source = "CURVE"
        gem.refusal = ""
    finally:
        _filling = filling


def take_curve(gem: Any, samples: Any) -> None:
    """A measured curve takes the place of a gem's absorption, which is then no longer its species'."""
    global _filling
    _filling = True
    try:
        with twin_updates.one_edit(gem):
            set_curve(gem, samples)
            gem.species = CUSTOM
    finally:
        _filling = False


def read_out(gem: Any) -> Any:
    """The `opal_kernels.gem.ReadOut` of a gem; None where its numbers cannot be rendered."""
    from opal_kernels import gem as gems

    if (name := species_of(gem)) != CUSTOM:
        return gems.read_out_of_species(name)
    settings = settings_of(gem)
    return None if gems.refusal(settings) else gems.read_out(settings)


def index_chart(gem: Any) -> Any:
    """The `opal_kernels.charts.wavelength_curve.Chart` of a gem's n(λ); None where its numbers cannot be rendered."""
    from opal_kernels import gem as gems
    from opal_kernels.charts import wavelength_curve
    from opal_kernels.descriptions import wavelengths
    from opal_kernels.optics import species

    if (name := species_of(gem)) != CUSTOM:
        return wavelength_curve.index_chart(species.index(name, wavelengths()))
    settings = settings_of(gem)
    return None if gems.refusal(settings) else wavelength_curve.index_chart(gems.index(settings))


def absorption_by_curve(gem: Any) -> Any:
    """σa (1/m) at 360 ... 830 nm, shape (471,), of a gem that absorbs by its species' table or by a curve; None where its color says how."""
    import numpy as np
    from opal_kernels import gem as gems
    from opal_kernels.descriptions import wavelengths
    from opal_kernels.optics import species

    if (name := species_of(gem)) != CUSTOM:
        return species.absorption(name, wavelengths())
    settings = settings_of(gem)
    if settings.absorption_curve is None:
        return None
    sigma = None if gems.absorption_refusal(settings) else gems.absorption(settings)
    return np.zeros_like(wavelengths()) if sigma is None else sigma


def absorption_chart(gem: Any, metres: float = 1.0) -> Any:
    """The `opal_kernels.charts.wavelength_curve.Chart` of a gem's absorption; None for a clear stone. `metres` as in `settings_of`."""
    from opal_kernels import gem as gems
    from opal_kernels.charts import wavelength_curve

    settings = settings_of(gem, metres)
    sigma = None if gems.absorption_refusal(settings) else gems.absorption(settings)
    return None if sigma is None else wavelength_curve.absorption_chart(sigma)


def _write(gem: Any, settings: Any, metres: float) -> None:
    gem.dispersion = settings.dispersion
    gem.cauchy_b, gem.cauchy_c = settings.cauchy
    gem.sellmeier_b = settings.sellmeier_b
    gem.sellmeier_c = settings.sellmeier_c
    gem.absorption_color = settings.absorption_color
    gem.absorption_depth = settings.absorption_depth / metres
    gem.absorption_source = "COLOR"
    # The curve of a library override stays its library's; the species is rendered by its own table all the same.
    if settings.absorption_curve is not None and gem.id_data.override_library is None:
        set_curve(gem, settings.absorption_curve)


def _index_numbers(gem: Any) -> tuple[float, ...]:
    return (gem.cauchy_b, gem.cauchy_c, *gem.sellmeier_b, *gem.sellmeier_c)


def _keep(gem: Any) -> None:
    """Remembers a gem's numbers as the last good ones."""
    gem.last_good = _index_numbers(gem)
    gem.last_good_dispersion = gem.dispersion
    gem.last_good_absorption = (*gem.absorption_color, gem.absorption_depth)
    gem.last_good_source = gem.absorption_source
    gem.refusal = ""


def _index_refusal(gem: Any) -> str:
    """Why a gem's index cannot be: by the formula in use, or by the other one if its numbers were edited; empty where it can."""
    from opal_kernels import gem as gems

    settings, numbers, good = settings_of(gem), _index_numbers(gem), tuple(gem.last_good)
    edited = [name for name, part in (("CAUCHY", slice(0, 2)), ("SELLMEIER", slice(2, 8))) if numbers[part] != good[part]]
    refusals = (gems.refusal(dataclasses.replace(settings, dispersion=name)) for name in (gem.dispersion, *edited))
    return next((sentence for sentence in refusals if sentence), "")


def _take_usual_depth(gem: Any, metres: float) -> None:
    """The depth of a gem's color, until somebody sets it: the same whatever a unit is."""
    from opal_kernels import gem as gems

    if not gem.is_property_set("absorption_depth"):
        gem.absorption_depth = gems.USUAL_DEPTH / metres


def on_species(gem: Any, context: Any = None) -> None:
    """Fills a gem's numbers from the species chosen."""
    global _filling
    if _filling or gem.species == CUSTOM:
        return
    from opal_kernels import gem as gems

    _filling = True
    try:
        metres = units.here(context)
        _take_usual_depth(gem, metres)
        _write(gem, gems.settings_of_species(gem.species, gem.absorption_depth * metres), metres)
        _keep(gem)
    finally:
        _filling = False


def on_index(gem: Any, _context: Any = None) -> None:
    """After an edit of the index: Custom if the numbers can be rendered, else the last good ones and a sentence."""
    global _filling
    if _filling or not _index_differs(gem):  # Blender calls twice for one element of a vector
        return
    _filling = True
    try:
        if sentence := _index_refusal(gem):
            good = tuple(gem.last_good)
            gem.dispersion = gem.last_good_dispersion
            gem.cauchy_b, gem.cauchy_c = good[:2]
            gem.sellmeier_b, gem.sellmeier_c = good[2:5], good[5:8]
            gem.refusal = sentence
        else:
            gem.species = CUSTOM
            _keep(gem)
    finally:
        _filling = False


def on_absorption(gem: Any, context: Any = None) -> None:
    """After an edit of colour or depth: the stone absorbs by them and is no longer its species', or the last good ones stay."""
    global _filling
    if _filling or not _absorption_differs(gem):
        return
    from opal_kernels import gem as gems

    _filling = True
    try:
        metres = units.here(context)
        settings = settings_of(gem, metres)
        if sentence := gems.absorption_refusal(dataclasses.replace(settings, absorption_curve=None)):
            good = tuple(gem.last_good_absorption)
            gem.absorption_color, gem.absorption_depth = good[:3], good[3]
            gem.refusal = sentence
        else:
            gem.species, gem.absorption_source = CUSTOM, "COLOR"
            _take_usual_depth(gem, metres)
            gem.last_good_absorption = (*gem.absorption_color, gem.absorption_depth)
            gem.last_good_source = "COLOR"
            gem.refusal = ""
    finally:
        _filling = False


def on_absorption_source(gem: Any, context: Any = None) -> None:
    """After the choice of colour or curve: an empty curve is refused."""
    global _filling
    if _filling:
        return
    from opal_kernels import gem as gems

    _filling = True
    try:
        sentence = gems.absorption_refusal(settings_of(gem))
        if sentence:
            gem.absorption_source = "COLOR"
        else:
            gem.species = CUSTOM
            gem.last_good_source = gem.absorption_source
            _take_usual_depth(gem, units.here(context))
            gem.last_good_absorption = (*gem.absorption_color, gem.absorption_depth)
        gem.refusal = sentence
    finally:
        _filling = False


def on_sample(sample: Any, _context: Any = None) -> None:
    """After an edit of one sample of an absorption curve: the last good one stays where the new one cannot be."""
    global _filling
    if _filling or (sample.wavelength, sample.absorption) == tuple(sample.last_good):
        return
    from opal_kernels import gem as gems

    gem = sample.id_data.opal.gem
    _filling = True
    try:
        one = dataclasses.replace(settings_of(gem), absorption_curve=[(sample.wavelength, sample.absorption)])
        sentence = gems.absorption_refusal(one)
        if sentence:
            sample.wavelength, sample.absorption = sample.last_good
        else:
            sample.last_good = sample.wavelength, sample.absorption
            if gem.absorption_source == "CURVE":
                gem.species = CUSTOM
        gem.refusal = sentence
    finally:
        _filling = False
