# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal for Blender: the extension's entry."""


def register() -> None:
    """Add the engine, its properties and panels, then the operators that use them."""
    from . import addon, operators

    addon.register()
    operators.register()


def unregister() -> None:
    """Take everything away again, in the opposite order."""
    from . import addon, operators

    operators.unregister()
    addon.unregister()
