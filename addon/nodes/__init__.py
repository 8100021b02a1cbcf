# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees to register programs for the tracer.

`registry` finds the reader of a node type, `compiler` decides what is read and with which weight, `program` makes it small.
One reader a node, in files by subject: `shaders`, `textures`, `converters`, `vectors`, `inputs`.
"""

from .compile import compile_light_nodes, compile_material, compile_missing, compile_world
from .context import CompiledProgram, NodeContext, Problem
from .volumes import Coefficient, CompiledVolume, compile_volume, default_volume, has_surface, has_volume

__all__ = [
    "Coefficient",
    "CompiledProgram",
    "CompiledVolume",
    "NodeContext",
    "Problem",
    "compile_light_nodes",
    "compile_material",
    "compile_missing",
    "compile_volume",
    "compile_world",
    "default_volume",
    "has_surface",
    "has_volume",
]
