# SPDX-License-Identifier: GPL-3.0-or-later
"""Lorenz-Mie's phase function on a logarithmic scale: why the report's rainbow was "spotty, dark, noise".

    PYTHONPATH=kernels python examples/charts/mie_logarithmic.py [--output mie_logarithmic.png]

One drop of a quarter of a millimetre has a forward peak ten million times the bow's height and a ripple finer than a table of whole
degrees can hold. Under the sun's disc and over sizes that differ by 5 per cent the ripple averages away, and the bow stands out.
"""

import argparse
from pathlib import Path

import numpy as np
from opal_kernels.charts import png
from opal_kernels.charts.canvas import Axes, Canvas
from opal_kernels.charts.rainbow_chart import encode
from opal_kernels.optics import rainbow
from opal_kernels.optics.rainbow import sun

RADIUS_UM, NM = 250.0, 550.0


def draw() -> np.ndarray:
    """Return the chart, linear Rec.709."""
    canvas = Canvas(1200, 620)
    axes = Axes(canvas, 80, 60, 1080, 490, (0.0, 180.0), (1e-5, 1e7), log=True)
    axes.frame(range(0, 181, 20), [10.0**e for e in range(-4, 7, 2)], "{:g}°".format, "{:.0e}".format)
    degrees = np.linspace(0, 180, 7201)
    single = rainbow.phase_function("MIE", RADIUS_UM, [NM], np.radians(degrees))[:, 0]
    smooth = rainbow.phase_function("MIE", RADIUS_UM, [NM], np.radians(degrees), 0.05, sun.MEAN_RADIUS_RAD)[:, 0]
    for row, colour in zip(single, ((0.05, 0.14, 0.3), (0.3, 0.1, 0.04)), strict=True):
        axes.curve(degrees, row, colour, 1.0)
    for row, colour in zip(smooth, ((0.25, 0.6, 1.0), (0.95, 0.4, 0.15)), strict=True):
        axes.curve(degrees[::4], row[::4], colour, 2.0)
    axes.legend(
        [
            ("perpendicular, sizes and sun averaged", (0.25, 0.6, 1.0)),
            ("parallel, sizes and sun averaged", (0.95, 0.4, 0.15)),
            ("perpendicular, one drop", (0.1, 0.28, 0.6)),
            ("parallel, one drop", (0.6, 0.2, 0.08)),
        ]
    )
    canvas.text(80, 24, "Lorenz-Mie, 0.25 mm, 550 nm: 1/sr against the scattering angle")
    return canvas.pixels


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=Path("renders/mie_logarithmic.png"))
    path = parser.parse_args().output
    path.parent.mkdir(parents=True, exist_ok=True)
    png.write(path, encode(draw()))
    print(path)
