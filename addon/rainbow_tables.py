# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the tables of rainbows are kept: Blender's folder for what extensions write."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

_PACKAGE = __package__.rpartition(".")[0]


def folder() -> Path | None:
    """The folder of tables, not made yet; None where Blender has none for Opal."""
    try:
        return Path(bpy.utils.extension_path_user(_PACKAGE, path="rainbows", create=False))
    except (ValueError, OSError):  # not installed as an extension, or nowhere to write
        return None


def store(warn: Any) -> Any:
    """The `TableStore` of that folder; `warn` takes a sentence about what is damaged or cannot be written."""
    from opal_kernels.table_store import TableStore

    return TableStore(folder(), warn=warn)
