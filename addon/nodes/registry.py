# SPDX-License-Identifier: GPL-3.0-or-later
"""The readers: one function a node type, all of one signature, found by the node's `bl_idname`.

A value reader takes a `NodeView` and returns its outputs by identifier. A shader reader takes a `NodeView` and the weight
that Mix and Add Shader nodes leave it, and emits lobes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .compiler import NodeView
    from .program import Value

ValueReader = Callable[["NodeView"], "dict[str, Value]"]
ShaderReader = Callable[["NodeView", "Value"], None]

VALUE_READERS: dict[str, ValueReader] = {}
SHADER_READERS: dict[str, ShaderReader] = {}


def reads(*node_types: str) -> Callable[[ValueReader], ValueReader]:
    """Registers a reader of nodes that give values."""

    def register(reader: ValueReader) -> ValueReader:
        VALUE_READERS.update(dict.fromkeys(node_types, reader))
        return reader

    return register


def shades(*node_types: str) -> Callable[[ShaderReader], ShaderReader]:
    """Registers a reader of nodes that give shaders."""

    def register(reader: ShaderReader) -> ShaderReader:
        SHADER_READERS.update(dict.fromkeys(node_types, reader))
        return reader

    return register
