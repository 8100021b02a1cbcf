# SPDX-License-Identifier: GPL-3.0-or-later
"""Following links through a node tree: reroutes, muted nodes and links, groups within groups.

A `Frame` is a tree as reached: the material's own, or a group's through the node that uses it, so that one group used twice
is two frames.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

MAX_GROUP_DEPTH = 64


@dataclass(frozen=True)
class Frame:
    """A node tree and how it was reached."""

    tree: Any
    parent: Frame | None = None
    group: Any = None  # the group node in the parent's tree

    @property
    def key(self) -> tuple:
        """Tells frames apart."""
        own = self.group.as_pointer() if self.group is not None else self.tree.as_pointer()
        return (*self.parent.key, own) if self.parent else (own,)

    @property
    def depth(self) -> int:
        """Groups around this frame."""
        return self.parent.depth + 1 if self.parent else 0


@dataclass(frozen=True)
class Source:
    """Where a socket's value comes from: output ``socket`` of ``node``, or, with ``node`` None, the unlinked input ``socket``."""

    frame: Frame
    node: Any
    socket: Any


class EndlessGroups(Exception):
    """A group contains itself."""


class Links:
    """The live link into each input, by tree: Blender's own `socket.links` walks through every link each time."""

    def __init__(self) -> None:
        self._trees: dict[int, dict[int, Any]] = {}

    def into(self, socket: Any) -> Any:
        """The link into an input, or None."""
        if not socket.is_linked:
            return None
        tree = socket.id_data
        key = tree.as_pointer()
        if key not in self._trees:
            live = (link for link in tree.links if link.is_valid and not link.is_muted)
            self._trees[key] = {link.to_socket.as_pointer(): link for link in live}
        return self._trees[key].get(socket.as_pointer())


def source_of(frame: Frame, socket: Any, links: Links) -> Source:
    """Follows an input socket to the node that computes it.

    Parameters
    ----------
    frame : Frame
        Where the socket's node is.
    socket : NodeSocket
        An input.
    links : Links
        Remembers links between calls, while the trees stay as they are.

    Raises
    ------
    EndlessGroups
        If groups are nested deeper than ``MAX_GROUP_DEPTH``.
    """
    seen: set[tuple] = set()
    while True:
        link = links.into(socket)
        if link is None:
            return Source(frame, None, socket)
        node, output = link.from_node, link.from_socket
        key = (frame.key, node.as_pointer(), output.identifier)
        if key in seen:  # reroutes in a ring
            return Source(frame, None, socket)
        seen.add(key)
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute:
            socket = _passed_through(node, output)
            if socket is None:
                return Source(frame, None, link.to_socket)
        elif node.type == "GROUP" and node.node_tree is not None:
            if frame.depth >= MAX_GROUP_DEPTH:
                raise EndlessGroups(node.name)
            inner = Frame(node.node_tree, frame, node)
            result = _group_output(node.node_tree)
            socket = None if result is None else _by_identifier(result.inputs, output.identifier)
            if socket is None:
                return Source(frame, None, link.to_socket)
            frame = inner
        elif node.type == "GROUP_INPUT":
            if frame.parent is None:
                return Source(frame, None, link.to_socket)
            outer = _by_identifier(frame.group.inputs, output.identifier)
            if outer is None:
                return Source(frame, None, link.to_socket)
            frame, socket = frame.parent, outer
        else:
            return Source(frame, node, output)


def _passed_through(node: Any, output: Any) -> Any:
    """The input that a muted node hands on to ``output``, or None."""
    for link in node.internal_links:
        if link.to_socket == output:
            return link.from_socket
    return None


def _group_output(tree: Any) -> Any:
    outputs = [n for n in tree.nodes if n.type == "GROUP_OUTPUT"]
    return next((n for n in outputs if n.is_active_output), outputs[0] if outputs else None)


def _by_identifier(sockets: Any, identifier: str) -> Any:
    return next((s for s in sockets if s.identifier == identifier), None)
