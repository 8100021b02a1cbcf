# SPDX-License-Identifier: GPL-3.0-or-later
"""Every setting of a material or world tells the twin when it is edited.

The callbacks are put on the declarations of the property groups before they are registered, after whatever callback a setting
has of its own. The twins' module loads with the first edit.
"""

from __future__ import annotations

import typing
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

_MARK = "_opal_twin_follows"


def attach(group: Any) -> None:
    """Makes every visible setting of a property group update the twin of the material or world that owns it."""
    if _MARK in group.__dict__:
        return
    setattr(group, _MARK, True)
    own = group.__annotations__
    declarations = {name: row for name, row in typing.get_type_hints(group).items() if name in own}
    for declared in declarations.values():
        keywords = getattr(declared, "keywords", None)
        if keywords is None or "type" in keywords or "HIDDEN" in keywords.get("options", ()):
            continue
        keywords["update"] = _both(keywords.get("update"))
    group.__annotations__ = declarations


_running = False


@contextmanager
def one_edit(settings: Any, context: Any = None) -> Iterator[None]:
    """What is set while it lasts is one edit: the twin of what owns the settings follows once, at its end."""
    global _running
    if _running:
        yield
        return
    _running = True
    try:
        yield
    finally:
        _running = False
    from . import twins

    twins.follow(settings, context)


def _both(own: Callable[[Any, Any], None] | None) -> Callable[[Any, Any], None]:
    def update(settings: Any, context: Any) -> None:
        # A callback that fills in other settings (a species sets a curve of hundreds of points) makes one edit, not hundreds.
        with one_edit(settings, context):
            if own is not None:
                own(settings, context)

    return update
