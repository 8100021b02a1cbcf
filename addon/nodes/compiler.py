# SPDX-License-Identifier: GPL-3.0-or-later
"""From a node tree to a program: which nodes matter, in which order, and with which weight.

Values are read on demand, backwards from the lobes. Shaders are gathered first: Mix and Add Shader only hand weights on, so
every shader node is met once, with the sum of what all ways to it leave.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from ..identity import Named
from . import operations as ops
from .context import NodeContext, Problem
from .operations import Op
from .program import ONE, ZERO, Input, ProgramBuilder, Table, Value, constant
from .registry import SHADER_READERS, VALUE_READERS, ShaderReader
from .tree import EndlessGroups, Frame, Links, Source, source_of

# Its square still is a number of single precision.
_BRIGHTEST = 1e18
_MIX, _ADD = "ShaderNodeMixShader", "ShaderNodeAddShader"


class NodeView:
    """A node as its reader sees it.

    Attributes
    ----------
    node
        The Blender node, for its settings.
    """

    def __init__(self, compiler: Compiler, frame: Frame, node: Any) -> None:
        self._compiler, self._frame, self.node = compiler, frame, node

    def _socket(self, name: str) -> Any:
        sockets = self.node.inputs
        return next((s for s in sockets if s.identifier == name), None) or next((s for s in sockets if s.name == name), None)

    def value(self, name: str, default: Value = ZERO) -> Value:
        """What an input gives: its link's value, turned into the socket's type, or its own setting.

        Parameters
        ----------
        name : str
            Identifier of the socket, or its name.
        default : Value
            For sockets that this Blender does not have.
        """
        socket = self._socket(name)
        return default if socket is None else self._compiler.input_value(self._frame, socket)

    def light(self, name: str, default: Value = ZERO) -> Value:
        """`value` of a colour or strength of light: what would overflow when it is multiplied is as bright as can be instead."""
        found = self.value(name, default)
        if found.constant is None or max(map(abs, found.constant[:3])) <= _BRIGHTEST:
            return found
        self.problem(f"“{name}” is too large to calculate with; {_BRIGHTEST:g} is taken for it.")
        return Value(tuple(min(max(x, -_BRIGHTEST), _BRIGHTEST) for x in found.constant))

    def linked(self, name: str) -> Value | None:
        """What is linked to an input, or None; for sockets whose default is not a number (Normal, Vector...)."""
        socket = self._socket(name)
        return None if socket is None else self._compiler.linked_value(self._frame, socket)

    def output_used(self, name: str) -> bool:
        """Whether an output is linked to anything."""
        return any(s.is_linked for s in self.node.outputs if name in (s.identifier, s.name))

    def own_output(self, name: str) -> Value:
        """What a node without inputs is set to give, as Value and RGB nodes are."""
        return self._compiler.setting(self.node.outputs[name])

    def normal(self, name: str = "Normal") -> Value | None:
        """A Normal input; None is the shading normal, tilted by the material's displacement where there is one."""
        return self.linked(name) or self._compiler.default_normal

    def emit(self, op: Op, mode: int = 0, *inputs: Input) -> Value:
        """See `ProgramBuilder.emit`."""
        return self._compiler.builder.emit(op, mode, *inputs)

    def emit_all(self, op: Op, mode: int, *inputs: Input) -> list[Value]:
        """See `ProgramBuilder.emit_all`."""
        return self._compiler.builder.emit_all(op, mode, *inputs)

    @property
    def builder(self) -> ProgramBuilder:
        """For its shorthands."""
        return self._compiler.builder

    @property
    def context(self) -> NodeContext:
        """For images, attributes and the camera."""
        return self._compiler.context

    @property
    def is_world(self) -> bool:
        """Whether a world is compiled: positions are directions there."""
        return self._compiler.is_world

    @property
    def owner(self) -> Any:
        """The material, world or lamp."""
        return self._compiler.owner

    def problem(self, message: str, lost: bool = False) -> None:
        """Tells the artist what is not read; `lost` if it is missing from the picture."""
        self._compiler.problem(self.node.label or self.node.name, message, lost)


class Compiler:
    """One tree on its way to a program."""

    def __init__(self, owner: Any, context: NodeContext, is_world: bool = False) -> None:
        self.owner, self.context, self.is_world = owner, context, is_world
        self.builder = ProgramBuilder()
        self.problems: list[Problem] = []
        self.default_normal: Value | None = None
        self._outputs: dict[tuple, dict[str, Value]] = {}
        self._open: set[tuple] = set()
        self._links = Links()

    def problem(self, node: str, message: str, lost: bool = False) -> None:
        """Adds a problem unless it is known."""
        problem = Problem(Named(self.owner), node, message, lost)
        if problem not in self.problems:
            self.problems.append(problem)

    # ---- Values ----

    def input_value(self, frame: Frame, socket: Any) -> Value:
        """The value of an input socket in the socket's type."""
        return self._value(self._source(frame, socket), socket)

    def linked_value(self, frame: Frame, socket: Any) -> Value | None:
        """The same, or None where nothing is linked."""
        source = self._source(frame, socket)
        if source.node is None and (source.socket is socket or getattr(source.socket, "hide_value", False)):
            return None
        return self._value(source, socket)

    def source(self, frame: Frame, socket: Any) -> Source:
        """The node that computes an input."""
        return self._source(frame, socket)

    def _source(self, frame: Frame, socket: Any) -> Source:
        try:
            return source_of(frame, socket, self._links)
        except EndlessGroups as group:
            self.problem(str(group), "This group contains itself; it is left out.", lost=True)
            return Source(frame, None, socket)

    def _value(self, source: Source, socket: Any) -> Value:
        if source.node is None:
            return _convert(self.builder, self.setting(source.socket), source.socket.type, socket.type)
        outputs = self._outputs_of(source)
        value = outputs.get(source.socket.identifier) or outputs.get(source.socket.name)
        if value is None:
            return _convert(self.builder, self.setting(socket), socket.type, socket.type)
        return _convert(self.builder, value, source.socket.type, socket.type)

    def setting(self, socket: Any) -> Value:
        """The value that an unlinked socket has by itself; what is not finite would turn whole pictures black, so it counts as 0."""
        value = _setting(socket)
        if all(map(math.isfinite, value.constant)):
            return value
        node = socket.node
        self.problem(node.label or node.name, f"“{socket.name}” is not a finite number; 0 is taken for it.", lost=True)
        return Value(tuple(x if math.isfinite(x) else 0.0 for x in value.constant))

    def _outputs_of(self, source: Source) -> dict[str, Value]:
        """What a node gives. Everything upstream is read first, without recursion, for chains of any length."""
        stack = [(source, False)]
        while stack:
            at, upstream_read = stack.pop()
            key = _node_key(at)
            if key in self._outputs:
                continue
            if upstream_read:
                self._outputs[key] = self._read(at)
                self._open.discard(key)
            elif key in self._open:
                self.problem(at.node.name, "The links form a ring here; it is cut.")
            else:
                self._open.add(key)
                stack.append((at, True))
                linked = (s for s in at.node.inputs if s.enabled and s.is_linked and s.type != "SHADER")
                upstream = (self._source(at.frame, s) for s in linked)
                stack.extend((s, False) for s in upstream if s.node is not None)
        return self._outputs.get(_node_key(source), {})

    def _read(self, source: Source) -> dict[str, Value]:
        view = NodeView(self, source.frame, source.node)
        reader = VALUE_READERS.get(source.node.bl_idname)
        if reader is None:
            view.problem(f"Opal does not read {source.node.bl_label} nodes; what it is linked to keeps its own value.", lost=True)
            return {}
        return reader(view)

    # ---- Shaders ----

    def shade(
        self,
        frame: Frame,
        socket: Any,
        readers: Mapping[str, ShaderReader] = SHADER_READERS,
        instead: str = "a grey diffuse surface is shown",
    ) -> None:
        """Hands everything that reaches a shader input to its reader, with its weight.

        Parameters
        ----------
        readers : mapping
            By node type; surfaces' readers emit lobes.
        instead : str
            What is done with nodes that have no reader.
        """
        first = self._source(frame, socket)
        if first.node is None:
            return
        order = list(self._shader_nodes(first))
        weights: dict[tuple, Value] = {_node_key(first): ONE}
        for source in order:
            weight = weights.get(_node_key(source), ZERO)
            if weight.constant is not None and weight.constant[:3] == (0.0, 0.0, 0.0):
                continue
            view = NodeView(self, source.frame, source.node)
            if source.node.bl_idname in (_MIX, _ADD):
                for child, part in self._parts(source, view, weight):
                    key = _node_key(child)
                    weights[key] = self.builder.math("ADD", weights[key], part) if key in weights else part
            elif reader := readers.get(source.node.bl_idname):
                reader(view, weight)
            else:
                view.problem(f"Opal does not read {source.node.bl_label} nodes here; {instead}.", lost=True)
                if not self.is_world and readers is SHADER_READERS:
                    self.builder.emit(Op.DIFFUSE, 0, weight, constant(0.8, 0.8, 0.8), ZERO, self.default_normal)

    def _shader_nodes(self, first: Source) -> Iterator[Source]:
        """Shader nodes from the output backwards: each after all that hand weight to it."""
        order: list[Source] = []
        done: set[tuple] = set()
        open_: set[tuple] = set()
        # Depth first without recursion, for mixes stacked by the hundred.
        stack: list[tuple[Source, bool]] = [(first, False)]
        while stack:
            source, left = stack.pop()
            key = _node_key(source)
            if left:
                open_.discard(key)
                done.add(key)
                order.append(source)
                continue
            if key in done or key in open_:
                if key in open_:
                    self.problem(source.node.name, "The links form a ring here; it is cut.")
                continue
            open_.add(key)
            stack.append((source, True))
            stack.extend((child, False) for child in self._children(source))
        return reversed(order)

    def _children(self, source: Source) -> list[Source]:
        if source.node.bl_idname not in (_MIX, _ADD):
            return []
        sources = [self._source(source.frame, s) for s in source.node.inputs if s.type == "SHADER"]
        return [s for s in sources if s.node is not None]

    def _parts(self, source: Source, view: NodeView, weight: Value) -> list[tuple[Source, Value]]:
        """What a Mix or Add Shader node hands on, and how much of it."""
        shaders = [self._source(source.frame, s) for s in source.node.inputs if s.type == "SHADER"]
        parts = [weight, weight]
        if source.node.bl_idname == _MIX:
            factor = self.builder.emit(Op.CLAMP, 0, view.value("Fac"), ZERO, ONE)
            parts = [
                self.builder.math("MULTIPLY", weight, self.builder.math("SUBTRACT", ONE, factor)),
                self.builder.math("MULTIPLY", weight, factor),
            ]
        return [(s, p) for s, p in zip(shaders, parts, strict=True) if s.node is not None]


def _node_key(source: Source) -> tuple:
    return (*source.frame.key, source.node.as_pointer())


def _setting(socket: Any) -> Value:
    """The value that an unlinked socket has by itself."""
    value = getattr(socket, "default_value", None)
    if value is None or isinstance(value, str):
        return ZERO
    if isinstance(value, (int, float)):
        return constant(float(value))
    lanes = tuple(value)[:4]
    return constant(*lanes) if len(lanes) in (3, 4) else constant(*(lanes + (0.0,) * (3 - len(lanes))))


def _convert(builder: ProgramBuilder, value: Value, from_type: str, to_type: str) -> Value:
    """A value of one socket type in another, as Blender converts it."""
    numbers = ("VALUE", "INT", "BOOLEAN")
    if to_type in numbers and from_type == "RGBA":
        value = builder.emit(Op.GREY, ops.GREY["LUMINANCE"], value)
    elif to_type in numbers and from_type not in numbers:
        value = builder.emit(Op.GREY, ops.GREY["AVERAGE"], value)
    if to_type == "INT" and from_type not in ("INT", "BOOLEAN"):
        value = builder.emit(Op.MATH, ops.MATH["TRUNC"], value)
    elif to_type == "BOOLEAN" and from_type != "BOOLEAN":
        value = builder.emit(Op.MATH, ops.MATH["GREATER_THAN"], value, ZERO)
    return value


__all__ = ["Compiler", "NodeView", "Table"]
