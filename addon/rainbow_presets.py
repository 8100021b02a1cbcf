# SPDX-License-Identifier: GPL-3.0-or-later
"""Bows with known drops: rows of numbers, and what choosing one fills in.

Sources: Lee, Appl. Opt. 37 (1998) 1506 (natural bows and their drops); Laven, Appl. Opt. 42 (2003) 436 (fogbow, corona, glory);
Marshall and Palmer, J. Meteorol. 5 (1948) 165 (rain of 5 mm/h: mean radius 0.171 mm, extinction 0.001 per metre); Haussmann, Appl.
Opt. 54 (2015) B117 (twinned bows from flattened drops).
"""

from __future__ import annotations

from typing import Any

_WATER = {"liquid": "WATER", "temperature": 20.0, "flattening": 0.0, "diffraction": False}
PRESETS: dict[str, tuple[str, str, dict[str, Any]]] = {
    "CLASSIC": (
        "Rainbow",
        "Even drops of half a millimetre across: strong colours and a few supernumerary arcs",
        {"theory": "AIRY", "radius": 0.25, "distribution": "LOG_NORMAL", "spread": 0.05, "extinction": 0.002},
    ),
    "SUPERNUMERARY": (
        "Supernumerary Arcs",
        "Small even drops: many pastel arcs inside the bow",
        {"theory": "AIRY", "radius": 0.12, "distribution": "LOG_NORMAL", "spread": 0.03, "extinction": 0.002},
    ),
    "CLOUDBURST": (
        "Cloudburst",
        "Large drops after a thunderstorm: narrow, vivid, no supernumerary arcs",
        {"theory": "AIRY", "radius": 0.7, "distribution": "GAMMA", "spread": 0.25, "extinction": 0.004},
    ),
    "SHOWER": (
        "Shower",
        "Rain of 5 mm an hour as it is measured, drops of all sizes",
        {"theory": "AIRY", "radius": 0.171, "distribution": "MARSHALL_PALMER", "spread": 1.0, "extinction": 0.001},
    ),
    "FOGBOW": (
        "Fogbow",
        "Fog droplets: a broad, almost white bow, and a glory about the antisolar point",
        {"theory": "MIE", "radius": 0.01, "distribution": "LOG_NORMAL", "spread": 0.1, "extinction": 0.02},
    ),
    "CORONA": (
        "Corona",
        "Even cloud droplets with the forward lobe kept: coloured rings about sun or moon",
        {"theory": "MIE", "radius": 0.008, "distribution": "LOG_NORMAL", "spread": 0.05, "extinction": 0.01, "diffraction": True},
    ),
    "TWINNED": (
        "Twinned Bow",
        "Small round and larger flattened drops together: two bows that part at the top",
        {"theory": "DROPLET", "radius": 0.5, "distribution": "TWO_SIZES", "spread": 0.03, "extinction": 0.003, "flattening": 1.0},
    ),
    "SEA_SPRAY": (
        "Sea Spray",
        "Salt water: a bow nearly a degree smaller than that of rain",
        {"theory": "AIRY", "radius": 0.2, "distribution": "LOG_NORMAL", "spread": 0.1, "extinction": 0.01, "liquid": "SEA_WATER"},
    ),
    "GLASS_BEADS": (
        "Glass Beads",
        "Beads of crown glass: a bow of 22 degrees",
        {"theory": "AIRY", "radius": 0.3, "distribution": "NORMAL", "spread": 0.05, "extinction": 0.05, "liquid": "CUSTOM", "index": 1.51},
    ),
}


def items() -> tuple[tuple[str, str, str], ...]:
    """Items of `material.opal.rainbow.preset`."""
    return (("CUSTOM", "Custom", "The numbers below, as they are"), *((name, label, text) for name, (label, text, _) in PRESETS.items()))


def on_preset(rainbow: Any, _context: Any = None) -> None:
    """Fills a rainbow's numbers from the preset chosen; a world keeps its extinction, for those below are of curtains, not of all the air."""
    row = PRESETS.get(rainbow.preset)
    if row is None:
        return
    for name, value in (_WATER | row[2]).items():
        if name != "extinction" or rainbow.id_data.id_type != "WORLD":
            setattr(rainbow, name, value)
