# SPDX-License-Identifier: GPL-3.0-or-later
"""Every cut by its public name: adding one is adding a row."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Callable
from dataclasses import dataclass

from . import cabochon, fancy_brilliant, heart, princess, rose, step_cut
from .brilliant import BrilliantProportions, round_brilliant
from .stone import Stone


@dataclass(frozen=True)
class Cut:
    """A way to cut a stone.

    Attributes
    ----------
    label, description : str
        For a menu.
    build : callable
        Takes proportions by keyword and returns a `Stone` of width 1.
    defaults : dict
        The proportions it takes, with their usual values; angles in radians.
    smooth : tuple of str
        Names of faces that stand for a curved surface.
    """

    label: str
    description: str
    build: Callable[..., Stone]
    defaults: dict[str, float]
    smooth: tuple[str, ...] = ()


def _by_keyword(label: str, description: str, build: Callable[..., Stone], smooth: tuple[str, ...] = ()) -> Cut:
    defaults = {name: parameter.default for name, parameter in inspect.signature(build).parameters.items()}
    return Cut(label, description, build, defaults, smooth)


def _round(**proportions: float) -> Stone:
    return round_brilliant(BrilliantProportions(**proportions))


CUTS: dict[str, Cut] = {
    "BRILLIANT": Cut(
        "Round Brilliant", "57 facets, 58 with a culet", _round, {f.name: f.default for f in dataclasses.fields(BrilliantProportions)}
    ),
    "PRINCESS": _by_keyword("Princess", "Square, with nested chevrons below", princess.princess),
    "EMERALD": _by_keyword("Emerald", "Rectangular step cut", step_cut.emerald_cut),
    "ASSCHER": _by_keyword("Asscher", "Square step cut with large corners", step_cut.asscher_cut),
    "OVAL": _by_keyword("Oval", "Brilliant on an ellipse", fancy_brilliant.oval),
    "PEAR": _by_keyword("Pear", "Brilliant with one tip", fancy_brilliant.pear),
    "MARQUISE": _by_keyword("Marquise", "Brilliant with two tips", fancy_brilliant.marquise),
    "CUSHION": _by_keyword("Cushion", "Brilliant on a square with round sides", fancy_brilliant.cushion),
    "HEART": _by_keyword("Heart", "Brilliant with a tip and a cleft", heart.heart),
    "TRILLION": _by_keyword("Trillion", "Brilliant on a triangle with round sides", fancy_brilliant.trillion),
    "ROSE": _by_keyword("Rose", "Flat base under 24 triangles", rose.rose_cut),
    "CABOCHON": _by_keyword("Cabochon", "Smooth dome on a flat base", cabochon.cabochon, smooth=("dome",)),
}
"""Cuts by identifier, in menu order."""
