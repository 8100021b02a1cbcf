# SPDX-License-Identifier: GPL-3.0-or-later
"""The render passes: which option asks for one, what Blender calls it, what the kernels call it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from opal_kernels.descriptions import PASS_CHANNELS, Pass


@dataclass(frozen=True)
class RenderPass:
    """A row.

    Attributes
    ----------
    option : str
        Property of the view layer, or of ``view_layer.opal``.
    name : str
        As in Blender's render result and compositor.
    channels : str
        One letter a channel.
    socket : str
        Type of the compositor's socket.
    """

    option: str
    name: str
    channels: str
    socket: str
    source: Pass


TABLE = (
    RenderPass("use_pass_z", "Depth", "Z", "VALUE", Pass.DEPTH),
    RenderPass("use_pass_normal", "Normal", "XYZ", "VECTOR", Pass.NORMAL),
    RenderPass("use_pass_position", "Position", "XYZ", "VECTOR", Pass.POSITION),
    RenderPass("use_pass_emit", "Emission", "RGB", "COLOR", Pass.EMISSION),
    RenderPass("opal.use_pass_albedo", "Albedo", "RGB", "COLOR", Pass.ALBEDO),
    RenderPass("opal.use_pass_direct", "Direct", "RGB", "COLOR", Pass.DIRECT),
    RenderPass("opal.use_pass_indirect", "Indirect", "RGB", "COLOR", Pass.INDIRECT),
    RenderPass("opal.use_pass_caustics", "Caustics", "RGB", "COLOR", Pass.CAUSTICS),
    RenderPass("opal.use_pass_medium", "Medium", "RGB", "COLOR", Pass.MEDIUM),
)


def wanted(view_layer: Any) -> list[RenderPass]:
    """The passes that a view layer asks for, beside Combined."""
    return [row for row in TABLE if view_layer.path_resolve(row.option)]


assert all(len(row.channels) == PASS_CHANNELS[row.source] for row in TABLE)
