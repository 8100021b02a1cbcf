# SPDX-License-Identifier: GPL-3.0-or-later
"""Media as media of the kernels' scene."""

from __future__ import annotations

from typing import Any

from opal_kernels.descriptions import Phase, PhaseKind
from opal_kernels.optics import uplift
from opal_kernels.scene import Scene


def add_medium(scene: Scene, medium: Any) -> int:
    """Adds what `OpalMediumProperties` says; returns the medium's number."""
    phase = Phase(kind=PhaseKind[medium.phase], anisotropy=medium.anisotropy)
    emission = None
    if medium.emission_strength > 0.0 and max(medium.emission_color) > 0.0:
        emission = uplift.emission(tuple(medium.emission_color)) * medium.emission_strength
    return scene.add_medium(medium.extinction, uplift.reflectance(tuple(medium.albedo)), phase, emission)
