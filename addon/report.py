# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render could not do as asked, one sentence a thing, kept for the panel until the next render of that scene.

The list lives as long as the session: it describes a render, not the file.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Entry:
    """A sentence about something named.

    Attributes
    ----------
    owner : str
        Name of the object, material or image; empty for the scene as a whole.
    message : str
        What could not be done and what was done instead.
    """

    owner: str
    message: str

    def __str__(self) -> str:
        return f"{self.owner}: {self.message}" if self.owner else self.message


@dataclass
class Report:
    """Entries without repetition, in the order they came."""

    entries: dict[Entry, None] = field(default_factory=dict)

    def add(self, owner: str, message: str) -> None:
        self.entries[Entry(owner, message)] = None

    def forget(self, owner: str) -> None:
        """Takes back what was said of an owner, which is read once more."""
        self.entries = {entry: None for entry in self.entries if entry.owner != owner}

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
    return _reports.get(scene.original.session_uid, Report())


def clear() -> None:
    """Forgets every report."""
    _reports.clear()
