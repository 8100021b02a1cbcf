# SPDX-License-Identifier: GPL-3.0-or-later
"""A node tree as data, and the tree made to be like it.

A plan is built up by `Plan.add` and `Plan.join`. Applying it changes values in place where the tree already has its nodes, so that
dragging a slider rebuilds nothing.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from typing import Any

# Properties of nodes that say how they look or where they stand, not what they do.
_LOOKS = {"rna_type", "location_absolute", "color_tag", "warning_propagation"}


@dataclass
class Node:
    """One node: its type, its properties and the values of its inputs by name."""

    kind: str
    settings: dict[str, Any] = field(default_factory=dict)
    values: dict[str, Any] = field(default_factory=dict)
    column: int = 0


@dataclass
class Plan:
    """Nodes by name, and links (from node, output, to node, input); sockets by name or position."""

    nodes: dict[str, Node] = field(default_factory=dict)
    links: list[tuple[str, str | int, str, str | int]] = field(default_factory=list)

    def add(self, name: str, kind: str, column: int, settings: dict[str, Any] | None = None, **values: Any) -> str:
        """Adds a node; values go to inputs of that name, with _ for a space. Returns the node's name."""
        self.nodes[name] = Node(kind, settings or {}, {key.replace("_", " "): value for key, value in values.items()}, column)
        return name

    def join(self, source: str, output: str | int, target: str, socket: str | int) -> None:
        """Adds a link."""
        self.links.append((source, output, target, socket))

    def apply(self, tree: Any, prefix: str = "") -> list[Any]:
        """Makes the nodes, with names after a prefix, and sets their values; returns them. Other nodes are left alone."""
        made = {}
        rows: dict[int, int] = {}
        for name, row in self.nodes.items():
            node = tree.nodes.get(prefix + name)
            if node is None or node.bl_idname != row.kind:
                node = tree.nodes.new(row.kind)
                node.name = prefix + name
                node.location = (220 * row.column, -260 * rows.get(row.column, 0))
            rows[row.column] = rows.get(row.column, 0) + 1
            made[name] = node
            for key, value in row.settings.items():
                if getattr(node, key) != value:
                    setattr(node, key, value)
            for key, value in row.values.items():
                _set(node.inputs[key], value)
        for source, output, target, socket in self.links:
            to = made[target].inputs[socket]
            start = made[source].outputs[output]
            if not (to.is_linked and to.links[0].from_socket == start):
                tree.links.new(start, to)
        return list(made.values())


def _set(socket: Any, value: Any) -> None:
    old = socket.default_value
    same = tuple(old) == tuple(value) if hasattr(old, "__len__") and not isinstance(old, str) else old == value
    if not same:
        socket.default_value = value


def fingerprint(tree: Any) -> str:
    """A hash of what a tree does: nodes, their settings, unlinked values and links; not of where they stand."""
    nodes = {node.name: _described(node) for node in tree.nodes if node.bl_idname not in {"NodeFrame", "NodeReroute"}}
    links = sorted((link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier) for link in tree.links)
    text = json.dumps([nodes, links], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _described(node: Any) -> list[Any]:
    base = node.bl_rna.base.properties if node.bl_rna.base is not None else {}
    settings = {}
    for prop in node.bl_rna.properties:
        name = prop.identifier
        if name in base or name in _LOOKS or prop.type in {"COLLECTION", "POINTER"}:
            continue
        settings[name] = _plain(getattr(node, name))
    values = {s.identifier: _plain(s.default_value) for s in node.inputs if not s.is_linked and hasattr(s, "default_value")}
    return [node.bl_idname, node.mute, settings, values]


def _plain(value: Any) -> Any:
    if isinstance(value, (bool, int, str)) or value is None:
        return value
    if isinstance(value, float):
        return f"{value:.6g}"
    try:
        return [_plain(v) for v in value]
    except TypeError:
        return getattr(value, "name_full", str(type(value).__name__))
