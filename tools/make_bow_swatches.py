# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the colours of each rainbow preset's primary bow for `addon/bow_swatches.py`: computing them takes seconds, so they are kept.

PYTHONPATH=kernels python tools/make_bow_swatches.py
"""

import numpy as np
from opal_kernels.charts import rainbow_data
from opal_kernels.metrics import srgb

# Radius (micrometres) and relative spread of each preset's drops; Airy's theory, from 43 degrees of the antisolar point inwards.
DROPS = {
    "CLASSIC": (250, 0.05),
    "SUPERNUMERARY": (120, 0.03),
    "CLOUDBURST": (700, 0.25),
    "SHOWER": (171, 1.0),
    "FOGBOW": (10, 0.1),
    "CORONA": (8, 0.05),
    "TWINNED": (500, 0.03),
    "SEA_SPRAY": (200, 0.1),
    "GLASS_BEADS": (300, 0.05),
}
COLUMNS = 24


def row(radius: float, spread: float) -> str:
    """Display colours from outside to inside, six hexadecimal digits each."""
    bow = rainbow_data.bow("AIRY", radius, spread, sizes=12)
    width = 4.5 if radius > 50 else 14.0
    outside = 43.2 if radius > 50 else 46.0
    place = np.linspace(outside, outside - width, COLUMNS)
    rgb = np.stack([np.interp(place, bow.radius_deg, bow.rgb[:, c]) for c in range(3)], axis=-1)
    shown = srgb(np.clip(rgb / rgb.max(), 0, 1))
    return "".join(f"{round(255 * float(v)):02x}" for v in shown.ravel())


if __name__ == "__main__":
    for name, drops in DROPS.items():
        print(f'    "{name}": "{row(*drops)}",')
