# SPDX-License-Identifier: GPL-3.0-or-later
"""Twins: the node tree by which Cycles and EEVEE show what Opal's settings say.

A twin is managed as long as it is as Opal left it; a tree that an artist made or edited is never written over unless asked.
"""

from .manage import Result, follow, is_managed, update, update_world, worlds_and_materials

__all__ = ["Result", "follow", "is_managed", "update", "update_world", "worlds_and_materials"]
