# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts: stones from their proportions or from a GemCad file, as closed polyhedra.

`CUTS` lists them; `round_brilliant` and its proportions stand here by name because everybody asks for them.
"""

from .brilliant import BrilliantProportions, round_brilliant
from .polyhedron import Polyhedron, intersect_half_spaces
from .registry import CUTS, Cut
from .stone import FacetPlanes, Stone

__all__ = ["CUTS", "BrilliantProportions", "Cut", "FacetPlanes", "Polyhedron", "Stone", "intersect_half_spaces", "round_brilliant"]
