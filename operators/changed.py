# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings changed for a while and put back, whatever happens meanwhile."""

from __future__ import annotations

from types import TracebackType
from typing import Any


class Changed:
    """Remembers what it sets; leaving the ``with`` block puts everything back in the opposite order."""

    def __init__(self) -> None:
        self._before: list[tuple[Any, str, Any]] = []

    def set(self, owner: Any, **values: Any) -> None:
        """Sets attributes; what the owner does not have is passed over."""
        for name, value in values.items():
            if not hasattr(owner, name):
                continue
            before = getattr(owner, name)
            if before != value:
                setattr(owner, name, value)
                self._before.append((owner, name, before))

    def keep(self, owner: Any, *names: str) -> None:
        """Remembers attributes that will change with others, to be put back after those."""
        self._before += [(owner, name, getattr(owner, name)) for name in names if hasattr(owner, name)]

    def __enter__(self) -> Changed:
        return self

    def __exit__(self, _kind: type[BaseException] | None, _error: BaseException | None, _trace: TracebackType | None) -> None:
        while self._before:
            owner, name, before = self._before.pop()
            try:
                setattr(owner, name, before)
            except (ReferenceError, TypeError):
                continue  # its owner is gone, or what it named is: nothing to put back
