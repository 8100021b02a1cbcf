# SPDX-License-Identifier: GPL-3.0-or-later
"""What a person presses or a script calls."""

from __future__ import annotations

from . import (
    add_gem,
    add_rain,
    compare_cycles,
    composite,
    gem_report,
    import_absorption,
    import_gemcad,
    long_job,
    menus,
    merge,
    panels,
    presets,
    rainbow_chart,
    render_layers,
    select_reported,
    update_twins,
)

_MODULES = (
    long_job,
    add_gem,
    import_gemcad,
    import_absorption,
    gem_report,
    add_rain,
    rainbow_chart,
    render_layers,
    composite,
    compare_cycles,
    merge,
    select_reported,
    presets,
    update_twins,
    panels,
    menus,
)


def register() -> None:
    """Register every operator."""
    for module in _MODULES:
        module.register()


def unregister() -> None:
    """Take them away again, in the opposite order."""
    for module in reversed(_MODULES):
        module.unregister()
