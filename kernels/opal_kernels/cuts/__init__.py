# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts: stones from their proportions, as closed polyhedra."""

from .brilliant import BrilliantProportions, round_brilliant
from .polyhedron import Polyhedron, intersect_half_spaces
from .stone import FacetPlanes, Stone

__all__ = ["BrilliantProportions", "FacetPlanes", "Polyhedron", "Stone", "intersect_half_spaces", "round_brilliant"]
