# SPDX-License-Identifier: GPL-3.0-or-later
"""The layers by name: what operators and panels offer without loading what renders them (`layers`)."""

from __future__ import annotations

# Those that are added to the base carry their pass's name.
ADDED = ("CAUSTICS", "GEMS", "MEDIA", "RAINBOW")
ITEMS = (
    ("CAUSTICS", "Caustics", "Light that gems, glass and mirrors throw on ordinary surfaces, and light that media throw there"),
    ("GEMS", "Gems", "Gems and what is seen through them, with the alpha of what they cover"),
    ("MEDIA", "Media", "What media scatter or give off towards the camera"),
    ("RAINBOW", "Rainbow", "What rain sends to the camera"),
    ("TRANSMITTANCE", "Transmittance", "What media and rain let through of what lies behind them; multiplies the base"),
    ("FULL", "Full Picture", "The whole of Opal's render"),
)
LABELS = {identifier: name for identifier, name, _ in ITEMS}


def image_name(identifier: str) -> str:
    """The image that holds a layer."""
    return f"Opal {LABELS[identifier]}"
