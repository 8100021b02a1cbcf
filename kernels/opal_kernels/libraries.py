# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the shared libraries are: Opal's own beside this package, Embree and Open Image Denoise in Blender's build.

Nothing is opened here and Blender is never imported: only paths are looked up. Blender carries its libraries in a
folder that its platform names (``lib`` beside a Linux executable or inside the ``bpy`` wheel, ``blender.shared`` on Windows,
``Contents/Resources/lib`` in a macOS application).
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Iterator
from pathlib import Path

OPAL_DIRECTORY_VARIABLE = "OPAL_LIBRARY_DIR"
EMBREE_VARIABLE = "OPAL_EMBREE"
DENOISE_VARIABLE = "OPAL_OPEN_IMAGE_DENOISE"

# File names of a library by platform, the one that a linker would ask for first.
_EMBREE_NAMES = {
    "linux": ("libembree4.so.4", "libembree4.so*"),
    "win32": ("embree4.dll",),
    "darwin": ("libembree4.4.dylib", "libembree4*.dylib"),
}
_DENOISE_NAMES = {
    "linux": ("libOpenImageDenoise.so.2", "libOpenImageDenoise.so*"),
    "win32": ("OpenImageDenoise.dll",),
    "darwin": ("libOpenImageDenoise.2.dylib", "libOpenImageDenoise.dylib"),
}


def opal_library(level: str) -> Path:
    """Path of Opal's library for a micro-architecture level.

    Parameters
    ----------
    level : str
        ``"v2"`` (x86-64-v2), ``"v3"`` (AVX2 and FMA) or ``"native"`` (other processors).

    Returns
    -------
    Path
        The file, whether it exists or not. The folder is ``$OPAL_LIBRARY_DIR`` or ``opal_kernels/lib``.
    """
    folder = Path(os.environ.get(OPAL_DIRECTORY_VARIABLE) or Path(__file__).parent / "lib")
    suffix = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
    return folder / f"libopal_{level}{suffix}"


def embree() -> str:
    """Embree 4 of the Blender that is running or installed: a path, or a soname for the loader to resolve.

    Returns
    -------
    str
        ``$OPAL_EMBREE`` if set, else what this process has mapped, else what lies in Blender's library folder, else the soname.
    """
    return _find(EMBREE_VARIABLE, _names(_EMBREE_NAMES)) or _names(_EMBREE_NAMES)[0]


def open_image_denoise() -> str | None:
    """Open Image Denoise 2 of the Blender that is running or installed; None where the build has none."""
    return _find(DENOISE_VARIABLE, _names(_DENOISE_NAMES))


def _names(table: dict[str, tuple[str, ...]]) -> tuple[str, ...]:
    return table.get(sys.platform, table["linux"])


def _find(variable: str, patterns: tuple[str, ...]) -> str | None:
    if override := os.environ.get(variable):
        return override
    if mapped := _mapped_into_this_process(patterns[0]):
        return mapped
    for folder in _blender_library_folders():
        for pattern in patterns:
            for path in sorted(folder.glob(pattern)):
                return str(path)
    return None


def _mapped_into_this_process(name: str) -> str | None:
    """Path of a mapped library on Linux; elsewhere None."""
    try:
        with open("/proc/self/maps", encoding="utf-8", errors="replace") as maps:
            for line in maps:
                path = line.rstrip("\n").rpartition(" ")[2]
                if path.rpartition("/")[2].startswith(name) and os.path.exists(path):
                    return path
    except OSError:
        pass
    return None


def _blender_library_folders() -> Iterator[Path]:
    """Folders in which a Blender build keeps its shared libraries, the running one's first."""
    for root in _blender_roots():
        for relative in ("lib", "blender.shared", "../Resources/lib", "."):
            folder = root / relative
            if folder.is_dir():
                yield folder


def _blender_roots() -> Iterator[Path]:
    bpy = sys.modules.get("bpy")
    if bpy is not None and getattr(bpy, "__file__", None):
        yield Path(bpy.__file__).parent
    binary = getattr(getattr(bpy, "app", None), "binary_path", "")
    if binary:
        yield Path(binary).resolve().parent
    if bpy is None:
        try:
            specification = importlib.util.find_spec("bpy")
        except (ImportError, ValueError):
            specification = None
        if specification is not None and specification.origin:
            yield Path(specification.origin).parent
