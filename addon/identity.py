# SPDX-License-Identifier: GPL-3.0-or-later
"""What names a data-block for as long as it lives: addresses are used again once it is gone, and names change."""

from __future__ import annotations

from typing import Any


def key_of(block: Any) -> Any:
    """The same for an original data-block and every evaluated copy of it, and for no other one of this session.

    Parameters
    ----------
    block : bpy.types.ID or None

    Returns
    -------
    int or tuple
        Blender's number for the session; name and library where there is none (what a modifier made); 0 for None.
    """
    if block is None:
        return 0
    original = getattr(block, "original", None) or block
    number = getattr(original, "session_uid", 0)
    if number:
        return number
    library = getattr(original, "library", None)
    return original.name_full, library.filepath if library is not None else ""


class Named(str):
    """A data-block's name that knows which data-block it is of, so that a report can lead to it.

    Attributes
    ----------
    kind : str
        Blender's kind of data-block, such as ``OBJECT``.
    key : int or tuple
        See `key_of`.
    """

    kind: str
    key: Any

    def __new__(cls, block: Any) -> Named:
        original = getattr(block, "original", None) or block
        self = super().__new__(cls, original.name)
        self.kind, self.key = getattr(original, "id_type", ""), key_of(original)
        return self
