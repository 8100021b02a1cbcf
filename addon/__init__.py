# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal in Blender: the engine, its settings and its panels. The kernels load with the first render, not here."""

from __future__ import annotations

from . import (
    blender_panels,
    engine,
    light_panels,
    light_properties,
    material_panels,
    media_panels,
    panels,
    preset_panels,
    properties,
    rainbow_panels,
    report,
    report_list,
    translations,
    undo_steps,
    versions,
)

_MODULES = (
    properties,
    light_properties,
    engine,
    preset_panels,
    panels,
    report_list,
    material_panels,
    media_panels,
    rainbow_panels,
    light_panels,
    blender_panels,
    undo_steps,
    versions,
    translations,
)


def register() -> None:
    for module in _MODULES:
        module.register()


def unregister() -> None:
    for module in reversed(_MODULES):
        module.unregister()
    report.clear()
