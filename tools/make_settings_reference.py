# SPDX-License-Identifier: GPL-3.0-or-later
"""Write docs/settings.md, the reference of Opal's settings, from the properties themselves.

    python tools/with_extension.py tools/make_settings_reference.py

`tests/addon/test_settings_reference.py` compares the committed file with what this makes, so that it cannot go stale.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bpy

FILE = Path(__file__).resolve().parent.parent / "docs" / "settings.md"
HEAD = """# Settings

Every setting of Opal, as scripts and drivers name it. This page is made from the properties by `tools/make_settings_reference.py`.
"""
UNITS = {"LENGTH": "m", "ROTATION": "°", "TIME_ABSOLUTE": "s", "TEMPERATURE": "K", "POWER": "W", "MASS": "kg", "WAVELENGTH": "nm"}


def groups() -> list[tuple[str, str, Any]]:
    """(title, data path, property group) of every group of settings, those within others after them."""
    owners = (
        ("Render", "scene.opal", bpy.types.Scene),
        ("View layer", "view_layer.opal", bpy.types.ViewLayer),
        ("Material", "material.opal", bpy.types.Material),
        ("World", "world.opal", bpy.types.World),
        ("Light", "light.opal", bpy.types.Light),
        ("Camera", "camera.opal", bpy.types.Camera),
    )
    found: list[tuple[str, str, Any]] = []

    def add(title: str, path: str, rna: Any) -> None:
        found.append((title, path, rna))
        for prop in rna.properties:
            if prop.identifier != "rna_type" and prop.type == "POINTER" and not prop.is_hidden:
                if prop.fixed_type.base and prop.fixed_type.base.identifier == "PropertyGroup":
                    add(f"{title}: {prop.name}", f"{path}.{prop.identifier}", prop.fixed_type)

    for title, path, owner in owners:
        prop = owner.bl_rna.properties.get("opal")
        if prop is not None:
            add(title, path, prop.fixed_type)
    return found


def number(value: float, prop: Any) -> str:
    """A number as a reader writes it, angles in degrees."""
    if prop.unit == "ROTATION":
        value = math.degrees(value)
    text = f"{value:.4g}" if prop.type == "FLOAT" else str(value)
    return "no limit" if abs(value) > 1e9 else text


def default(prop: Any) -> str:
    if prop.type == "BOOLEAN":
        return "on" if prop.default else "off"
    if prop.type == "ENUM" and not prop.enum_items_static:
        return ""  # made while Blender runs
    if prop.type == "ENUM":
        chosen = sorted(prop.default_flag) if prop.is_enum_flag else [prop.default]
        return ", ".join(f"`{name}`" for name in chosen if name)
    if prop.type == "STRING":
        return f"`{prop.default}`" if prop.default else ""
    if prop.is_array:
        return ", ".join(number(v, prop) for v in prop.default_array)
    return number(prop.default, prop)


def limits(prop: Any) -> str:
    if prop.type == "ENUM":
        return ", ".join(f"`{item.identifier}`" for item in prop.enum_items_static)
    if prop.type not in {"FLOAT", "INT"}:
        return ""
    unit = UNITS.get(prop.unit, "")
    low, high = number(prop.hard_min, prop), number(prop.hard_max, prop)
    text = f"from {low}" if high == "no limit" else f"{low} to {high}"
    return "" if low == high == "no limit" else f"{text} {unit}".strip()


def table(rna: Any) -> list[str]:
    lines = ["| setting | name | default | values | what it does |", "|---|---|---|---|---|"]
    for prop in rna.properties:
        if prop.identifier in {"rna_type", "name"} or prop.is_hidden or prop.type in {"POINTER", "COLLECTION"}:
            continue
        cells = (prop.name, f"`{prop.identifier}`", default(prop), limits(prop), prop.description)
        lines.append("| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in cells) + " |")
    return lines if len(lines) > 2 else []


def operators() -> list[str]:
    """The operators with what they do."""
    lines = ["| operator | name | what it does |", "|---|---|---|"]
    for name in sorted(dir(bpy.ops.opal)):
        rna = getattr(bpy.ops.opal, name).get_rna_type()
        lines.append(f"| `opal.{name}` | {rna.name} | {rna.description} |")
    return lines


def text() -> str:
    """The page."""
    parts = [HEAD]
    for title, path, rna in groups():
        if lines := table(rna):
            parts.append(f"## {title}\n\n`{path}`\n\n" + "\n".join(lines) + "\n")
    parts.append("## Operators\n\n" + "\n".join(operators()) + "\n")
    return "\n".join(parts)


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
    print(FILE)
