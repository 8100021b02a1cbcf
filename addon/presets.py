# SPDX-License-Identifier: GPL-3.0-or-later
"""Gem species in the interface: the list, and what happens when one is chosen or a number is edited.

Choosing a species fills the numbers; editing a number makes the species Custom and keeps every other number. Numbers that
cannot be rendered are refused: the last ones that could are put back, and the sentence stands in the panel until the next edit.
"""

from __future__ import annotations

import dataclasses
import zlib
from typing import Any

CUSTOM = "CUSTOM"

# Blender keeps the strings of a dynamic enumeration by reference only: they have to live here.
_items: list[tuple[str, str, str, int]] = []
# True while this module writes properties itself, so that their callbacks stay silent.
_filling = False


def species_items(_owner: Any = None, _context: Any = None) -> list[tuple[str, str, str, int]]:
    """Items of `material.opal.gem.species`."""
    if not _items:
        from opal_kernels.optics import species

        _items.append((CUSTOM, "Custom", "The numbers below, as they are", 0))
        for name, row in species.table().items():
            _items.append((name, row.label, f"{row.label}: index of refraction after {row.source}", species_number(name)))
    return _items


def species_number(name: str) -> int:
    """What a species is saved as: a number made of its name, so that rows may come and go in the table."""
    return zlib.crc32(name.encode()) & 0x7FFFFFFF


def settings_of(gem: Any) -> Any:
    """The `opal_kernels.gem.Settings` that a gem's properties show."""
    from opal_kernels.gem import Settings

    return Settings(
        dispersion=gem.dispersion,
        cauchy=(gem.cauchy_b, gem.cauchy_c),
        sellmeier_b=tuple(gem.sellmeier_b),
        sellmeier_c=tuple(gem.sellmeier_c),
        absorption_color=tuple(gem.absorption_color),
        absorption_depth=gem.absorption_depth,
        absorption_curve=curve_of(gem) if gem.absorption_source == "CURVE" else None,
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
        gem.absorption_source = "CURVE"
        gem.refusal = ""
    finally:
        _filling = filling


def take_curve(gem: Any, samples: Any) -> None:
    """A measured curve takes the place of a gem's absorption, which is then no longer its species'."""
    global _filling
    _filling = True
    try:
        set_curve(gem, samples)
        gem.species = CUSTOM
    finally:
        _filling = False


def read_out(gem: Any) -> Any:
    """The `opal_kernels.gem.ReadOut` of a gem; None where its numbers cannot be rendered."""
    from opal_kernels import gem as gems

    if gem.species != CUSTOM:
        return gems.read_out_of_species(gem.species)
    settings = settings_of(gem)
    return None if gems.refusal(settings) else gems.read_out(settings)


def index_chart(gem: Any) -> Any:
    """The `opal_kernels.charts.wavelength_curve.Chart` of a gem's n(λ); None where its numbers cannot be rendered."""
    from opal_kernels import gem as gems
    from opal_kernels.charts import wavelength_curve
    from opal_kernels.descriptions import wavelengths
    from opal_kernels.optics import species

    if gem.species != CUSTOM:
        return wavelength_curve.index_chart(species.index(gem.species, wavelengths()))
    settings = settings_of(gem)
    return None if gems.refusal(settings) else wavelength_curve.index_chart(gems.index(settings))


def absorption_chart(gem: Any) -> Any:
    """The `opal_kernels.charts.wavelength_curve.Chart` of a gem's absorption; None for a clear stone."""
    from opal_kernels import gem as gems
    from opal_kernels.charts import wavelength_curve

    settings = settings_of(gem)
    sigma = None if gems.absorption_refusal(settings) else gems.absorption(settings)
    return None if sigma is None else wavelength_curve.absorption_chart(sigma)


def _write(gem: Any, settings: Any) -> None:
    gem.dispersion = settings.dispersion
    gem.cauchy_b, gem.cauchy_c = settings.cauchy
    gem.sellmeier_b = settings.sellmeier_b
    gem.sellmeier_c = settings.sellmeier_c
    gem.absorption_color = settings.absorption_color
    gem.absorption_depth = settings.absorption_depth
    gem.absorption_source = "COLOR"
    if settings.absorption_curve is not None:
        set_curve(gem, settings.absorption_curve)


def _index_numbers(gem: Any) -> tuple[float, ...]:
    return (gem.cauchy_b, gem.cauchy_c, *gem.sellmeier_b, *gem.sellmeier_c)


def _keep(gem: Any) -> None:
    """Remembers the index's numbers as the last good ones."""
    gem.last_good = _index_numbers(gem)
    gem.last_good_dispersion = gem.dispersion
    gem.last_good_absorption = (*gem.absorption_color, gem.absorption_depth)
    gem.refusal = ""


def on_species(gem: Any, _context: Any = None) -> None:
    """Fills a gem's numbers from the species chosen."""
    global _filling
    if _filling or gem.species == CUSTOM:
        return
    from opal_kernels import gem as gems

    _filling = True
    try:
        _write(gem, gems.settings_of_species(gem.species, gem.absorption_depth))
        _keep(gem)
    finally:
        _filling = False


def on_index(gem: Any, _context: Any = None) -> None:
    """After an edit of the index: Custom if the numbers can be rendered, else the last good ones and a sentence."""
    global _filling
    if _filling:
        return
    from opal_kernels import gem as gems

    if _index_numbers(gem) == tuple(gem.last_good) and gem.dispersion == gem.last_good_dispersion:
        return  # Blender calls twice for one element of a vector
    _filling = True
    try:
        if sentence := gems.refusal(settings_of(gem)):
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


def on_absorption(gem: Any, _context: Any = None) -> None:
    """After an edit of colour or depth: the stone absorbs by them and is no longer its species', or the last good ones stay."""
    global _filling
    if _filling:
        return
    from opal_kernels import gem as gems

    if (*gem.absorption_color, gem.absorption_depth) == tuple(gem.last_good_absorption):
        return
    _filling = True
    try:
        settings = settings_of(gem)
        if sentence := gems.absorption_refusal(dataclasses.replace(settings, absorption_curve=None)):
            good = tuple(gem.last_good_absorption)
            gem.absorption_color, gem.absorption_depth = good[:3], good[3]
            gem.refusal = sentence
        else:
            gem.species, gem.absorption_source = CUSTOM, "COLOR"
            gem.last_good_absorption = (*gem.absorption_color, gem.absorption_depth)
            gem.refusal = ""
    finally:
        _filling = False


def on_absorption_source(gem: Any, _context: Any = None) -> None:
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
