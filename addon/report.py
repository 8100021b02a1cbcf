# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render could not do as asked, one sentence a thing, kept for the panel until the next render of that scene.

The list lives as long as the session: it describes a render, not the file. It holds names and numbers, never Blender's data.
"""

from __future__ import annotations

from typing import Any, NamedTuple


class Entry(NamedTuple):
    """A sentence about something named.

    Attributes
    ----------
    owner : str
        Name of the object, material or image; empty for the scene as a whole.
    message : str
        What could not be done and what was done instead.
    part : str
        The node or the setting of the owner that the message is about; empty for all of it.
    lost : bool
        Whether it is missing from the picture; what is not is only shown in another way.
    kind : str
        Blender's kind of data-block of the owner, empty where it is not known.
    key : int or tuple
        `identity.key_of` the owner.
    """

    owner: str
    message: str
    part: str = ""
    lost: bool = False
    kind: str = ""
    key: Any = 0

    def __str__(self) -> str:
        return ": ".join(text for text in (self.owner, self.part, self.message) if text)


class Report:
    """Entries without repetition, in the order they came."""

    def __init__(self) -> None:
        self.entries: dict[Entry, None] = {}

    def add(self, owner: str, message: str, part: str = "", lost: bool = False) -> None:
        """Adds an entry; an `identity.Named` owner can be selected from the panel."""
        self.entries[Entry(str(owner), message, part, lost, getattr(owner, "kind", ""), getattr(owner, "key", 0))] = None

    def forget(self, owner: Any) -> None:
        """Takes back what was said of an owner (`identity.Named`), which is read once more."""
        self.entries = {entry: None for entry in self.entries if (entry.kind, entry.key) != (owner.kind, owner.key)}

    def summary(self, limit: int = 3) -> str:
        """One line for Blender's status bar; empty where there is nothing to say."""
        lines = [str(entry) for entry in self.entries]
        if not lines:
            return ""
        rest = f"; {len(lines) - limit} more are listed in the Opal panel" if len(lines) > limit else ""
        return "Not everything could be rendered as set: " + "; ".join(lines[:limit]) + rest


_reports: dict[int, Report] = {}


def start(scene: Any) -> Report:
    """A new report for a scene; the last one is forgotten."""
    report = _reports[scene.original.session_uid] = Report()
    return report


def of(scene: Any) -> Report:
    """The report of the scene's last render, empty if there was none."""
    return _reports.get(scene.original.session_uid) or Report()


def clear() -> None:
    """Forgets every report."""
    _reports.clear()
