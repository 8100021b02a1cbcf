# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a Blender unit is.

What Blender keeps as a length (subtype DISTANCE) is in units, and its interface shows it by the scene's Unit Scale. What is said by
the metre (absorption of species and curves, extinction and emission of media and rain) is converted by what is said here when it
meets geometry. Node trees and lamps are per unit, as in Cycles.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

# A stone of 6.5 mm, one carat of diamond, for the ball of 2 units in Blender's preview.
_PREVIEW_STONE = 0.0065 / 2.0


def metres_per_unit(scene: Any) -> float:
    """Metres per Blender unit in a scene; 1 where there is no scene, or no system of units in it."""
    units = scene.unit_settings if scene is not None else None
    return 1.0 if units is None or units.system == "NONE" else units.scale_length


def here(context: Any = None) -> float:
    """Metres per unit in the scene that is edited.

    Parameters
    ----------
    context : bpy.types.Context, optional
        As update callbacks are given it.
    """
    if context is None:
        import bpy

        context = bpy.context
    return metres_per_unit(getattr(context, "scene", None))


@dataclass(frozen=True)
class Lengths:
    """Metres per unit, to each of what is rendered.

    Attributes
    ----------
    settings : float
        Of lengths in the materials' own settings, which were made in the scene that is edited.
    media : float
        Of the geometry, to media and rain.
    stones : float
        Of the geometry, to gems.
    """

    settings: float = 1.0
    media: float = 1.0
    stones: float = 1.0


def of_scene(scene: Any) -> Lengths:
    """Of a scene that is rendered for itself."""
    return Lengths(*[metres_per_unit(scene)] * 3)


def of_preview() -> Lengths:
    """Of Blender's scene of a material preview: gems absorb as stones of usual size do, not as the boulders that it shows."""
    return Lengths(settings=here(), stones=_PREVIEW_STONE)
