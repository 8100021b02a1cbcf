# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs, enables, disables and uninstalls the zip in this process; prints what Blender held after each step as JSON.

    BLENDER_USER_RESOURCES=EMPTY_FOLDER python tests/addon/install_cycle.py ZIP

A process of its own, because a module once imported and a class once registered leave traces that a test would see.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import bpy

PACKAGE = "bl_ext.user_default.opal"
MARK = "RESULT "


def _types() -> dict[str, type]:
    found = {}
    for name in dir(bpy.types):
        try:
            found[name] = getattr(bpy.types, name)
        except AttributeError:
            continue
    return found


def _functions_of_opal(functions) -> list[str]:
    return [f"{f.__module__}.{f.__qualname__}" for f in functions if getattr(f, "__module__", "").startswith(PACKAGE)]


def snapshot() -> dict[str, list[str]]:
    """Everything registered with Blender, by name (an engine is not among bpy.types)."""
    types = _types()
    rna = {name: kind.bl_rna for name, kind in types.items() if hasattr(kind, "bl_rna")}
    return {
        "classes": sorted(types),
        "engines": sorted(
            getattr(e, "bl_idname", "") for e in bpy.types.RenderEngine.__subclasses__() if getattr(e, "is_registered", False)
        ),
        "properties": sorted(f"{name}.{p}" for name, r in rna.items() for p in r.properties.keys()),
        "handlers": sorted(
            f for n in dir(bpy.app.handlers) if isinstance(h := getattr(bpy.app.handlers, n), list) for f in _functions_of_opal(h)
        ),
        "menus": sorted(f for kind in types.values() for f in _functions_of_opal(getattr(getattr(kind, "draw", None), "_draw_funcs", ()))),
        "panels": sorted(name for name, kind in types.items() if "OPAL" in getattr(kind, "COMPAT_ENGINES", ())),
        "modules": sorted(m for m in sys.modules if m.startswith("opal_kernels")),
        "arrays": sorted(m for m, module in list(sys.modules.items()) if m.startswith(PACKAGE) and hasattr(module, "np")),
        "addons": sorted(bpy.context.preferences.addons.keys()),
    }


def files() -> list[str]:
    """The profile's files that are Opal's or its wheel's."""
    root = Path(bpy.utils.resource_path("USER"))
    return sorted(str(p.relative_to(root)) for p in root.rglob("*") if p.is_file() and "opal" in str(p.relative_to(root)).lower())


def main() -> None:
    result = {}

    def note(step: str) -> None:
        result[step] = snapshot() | {"files": files()}

    bpy.ops.extensions.package_install_files  # noqa: B018  (the installer's own classes load before the first look)
    note("before")
    bpy.ops.extensions.package_install_files(filepath=sys.argv[-1], repo="user_default", enable_on_install=False)
    note("installed")
    bpy.ops.preferences.addon_enable(module=PACKAGE)
    note("enabled")
    bpy.ops.preferences.addon_disable(module=PACKAGE)
    note("disabled")
    bpy.ops.preferences.addon_enable(module=PACKAGE)
    note("enabled again")
    repos = bpy.context.preferences.extensions.repos
    index = next(i for i, repo in enumerate(repos) if repo.module == "user_default")
    bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="opal")
    note("uninstalled")
    print(MARK + json.dumps(result))


if __name__ == "__main__":
    main()
