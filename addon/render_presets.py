# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of `scene.opal`: some that come with Opal, and the artist's own as JSON in the extension's own folder.

Blender's presets are Python files in its scripts' folder, run as they are. An extension writes only into its own folder
(`bpy.utils.extension_path_user`), and numbers need no program: so Opal keeps its own list in the same menu.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import bpy

_PACKAGE = __package__.rpartition(".")[0]

# What a preset says; paths, the seed and the farm's settings belong to a file.
SETTINGS = (
    "passes samples_per_pass use_adaptive_sampling photons_per_pass photons_carry gather radius radius_shrink volume_estimate "
    "volume_photons_per_pass volume_radius march_steps march_tolerance max_depth transparent_depth clamp_direct clamp_indirect time_limit "
    "noise_threshold denoise pixel_filter filter_width"
).split()

# What is not named is as in a new file.
BUILT_IN: dict[str, dict[str, Any]] = {
    "Preview": {"passes": 8, "samples_per_pass": 2, "photons_per_pass": 50_000, "max_depth": 16, "denoise": True},
    "Final": {"passes": 256, "samples_per_pass": 4, "photons_per_pass": 500_000, "noise_threshold": 0.005},
    "Caustics": {"passes": 512, "samples_per_pass": 1, "photons_per_pass": 2_000_000, "gather": 32},
    "Fog and Beams": {"passes": 256, "photons_carry": "ALL", "volume_estimate": "BEAMS", "volume_photons_per_pass": 5_000},
}


class PresetError(Exception):
    """A preset cannot be read, written or found; the message is one sentence."""


def folder(create: bool = False) -> Path:
    """Where the artist's presets lie."""
    try:
        return Path(bpy.utils.extension_path_user(_PACKAGE, path="presets/render", create=create))
    except (ValueError, OSError) as error:
        raise PresetError(f"Opal's folder for presets cannot be made: {error}.") from error


def own() -> dict[str, Path]:
    """The artist's presets by name."""
    try:
        return {path.stem: path for path in sorted(folder().glob("*.json"))}
    except (PresetError, OSError):
        return {}


def apply(opal: Any, name: str) -> list[str]:
    """Sets everything that a preset says, the rest of `SETTINGS` to the default; names of what it says wrongly.

    Raises
    ------
    PresetError
        If there is no such preset, or its file is damaged.
    """
    values = BUILT_IN.get(name)
    if values is None:
        values = _read(name)
    wrong = [key for key in values if key not in SETTINGS]
    for key in SETTINGS:
        opal.property_unset(key)
        if key not in values:
            continue
        try:
            setattr(opal, key, values[key])
        except (TypeError, ValueError, OverflowError):
            wrong.append(key)
    return wrong


def _read(name: str) -> dict[str, Any]:
    path = own().get(name)
    if path is None:
        raise PresetError(f"There is no preset named “{name}”.")
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise PresetError(f"The preset {path} cannot be read: {getattr(error, 'strerror', None) or error}.") from error
    if not isinstance(values, dict):
        raise PresetError(f"The preset {path} cannot be read: it does not hold settings by name.")
    return values


def save(opal: Any, name: str) -> Path:
    """Writes the settings under a name; PresetError where it is taken by Opal's own or cannot be written."""
    clean = "".join(letter if letter.isalnum() or letter in " -_()" else "_" for letter in name).strip()
    if not clean.strip(" _"):
        raise PresetError("Give the preset a name.")
    if clean in BUILT_IN:
        raise PresetError(f"“{clean}” comes with Opal: give the preset another name.")
    path = folder(create=True) / f"{clean}.json"
    values = {key: getattr(opal, key) for key in SETTINGS}
    try:
        path.write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    except OSError as error:
        raise PresetError(f"The preset {path} cannot be written: {error.strerror or error}.") from error
    return path


def remove(name: str) -> None:
    """Deletes one of the artist's presets."""
    path = own().get(name)
    if path is None:
        raise PresetError(f"“{name}” comes with Opal or is gone: it cannot be removed.")
    try:
        path.unlink()
    except OSError as error:
        raise PresetError(f"The preset {path} cannot be removed: {error.strerror or error}.") from error
