# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists what the interface says in English and a language does not say yet, and translations of what it no longer says.

    python tools/with_extension.py tools/list_untranslated.py [LANGUAGE]

Messages are found where Blender shows them: names and descriptions of properties, of their choices and of operators, labels of panels,
and the literal texts of layouts. Each has Blender's context of translation: that of operators for their names and buttons, else none.
"""

import ast
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy

ROOT = Path(__file__).resolve().parent.parent
NONE, OPERATOR = "*", "Operator"
Message = tuple[str, str]
OWNERS = (bpy.types.Scene, bpy.types.ViewLayer, bpy.types.Material, bpy.types.World, bpy.types.Light, bpy.types.Camera)
# Rows of tables: their names are translated, their tooltips only where they hold no citation.
TABLES = {"species", "preset"}


def groups() -> Iterator[Any]:
    """Every group of settings, those within others included."""
    found: dict[str, Any] = {}

    def add(rna: Any) -> None:
        if rna.identifier in found:
            return
        found[rna.identifier] = rna
        for prop in rna.properties:
            if prop.type in {"POINTER", "COLLECTION"} and prop.fixed_type.identifier.startswith("Opal"):
                add(prop.fixed_type)

    for owner in OWNERS:
        add(owner.bl_rna.properties["opal"].fixed_type)
    return iter(found.values())


def of_properties(rna: Any) -> Iterator[Message]:
    """Names and descriptions of a group's or an operator's own properties."""
    inherited = {"rna_type", "name", "filter_glob", "files", "directory", "filename_ext"}
    for prop in rna.properties:
        if prop.identifier in inherited or prop.is_hidden:
            continue
        yield NONE, prop.name
        yield NONE, prop.description
        if prop.type == "ENUM":
            for item in prop.enum_items_static:
                yield NONE, item.name
                if not (prop.identifier in TABLES and item.description.startswith(f"{item.name}. Source: ")):
                    yield NONE, item.description


def settings() -> set[Message]:
    """What the settings of scenes, layers, materials, worlds, lamps and cameras say."""
    return {message for rna in groups() for message in of_properties(rna) if message[1]}


def panels() -> set[Message]:
    """Labels of panels."""
    kinds = (getattr(bpy.types, name, None) for name in dir(bpy.types) if name.startswith("OPAL_") and "_PT_" in name)
    return {(NONE, kind.bl_label) for kind in kinds if kind is not None and kind.bl_label}


def operators() -> set[Message]:
    """Names and descriptions of operators, and their properties."""
    found = set()
    for name in dir(bpy.ops.opal):
        rna = getattr(bpy.ops.opal, name).get_rna_type()
        found |= {(OPERATOR, rna.name), (NONE, rna.description)} | {m for m in of_properties(rna) if m[1]}
    return found


def tables() -> set[Message]:
    """Choices that are read from the kernels when a menu opens: species, and cuts with their tooltips."""
    from importlib import import_module

    species = import_module("bl_ext.user_default.opal.addon.presets").species_items()
    cuts = import_module("bl_ext.user_default.opal.operators.add_gem").cut_items()
    return {(NONE, item[1]) for item in (*species, *cuts)} | {(NONE, item[2]) for item in (species[0], *cuts)}


def texts() -> set[Message]:
    """Literal texts that layouts and Blender's own menus draw."""
    from importlib import import_module

    entries = import_module("bl_ext.user_default.opal.operators.menus").ENTRIES.values()
    found = {(OPERATOR, text) for menu in entries for _name, text, _icon in menu if text}
    for path in (*ROOT.glob("addon/*.py"), *ROOT.glob("operators/*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
                continue
            for word in node.keywords:
                if word.arg in {"text", "heading"} and isinstance(word.value, ast.Constant) and word.value.value:
                    found.add((OPERATOR if node.func.attr == "operator" else NONE, word.value.value))
    return found


def every_message() -> set[Message]:
    """All of them."""
    return settings() | panels() | operators() | tables() | texts()


def dictionary(language: str) -> dict[Message, str]:
    """The extension's translations into a language."""
    from importlib import import_module

    return import_module("bl_ext.user_default.opal.addon.translations").DICTIONARY.get(language, {})


def main() -> int:
    language = sys.argv[-1] if len(sys.argv) > 1 and len(sys.argv[-1]) in {2, 5} else "de_DE"
    known, wanted = dictionary(language), every_message()
    for context, text in sorted(wanted - known.keys()):
        print(f"untranslated ({context}): {text}")
    for context, text in sorted(known.keys() - wanted):
        print(f"no longer said ({context}): {text}")
    print(f"{language}: {len(wanted & known.keys())} of {len(wanted)} messages")
    return 0


if __name__ == "__main__":
    main()
