# SPDX-License-Identifier: GPL-3.0-or-later
"""A lesson: Airy's intensity by too few terms of De Morgan's power series, beside the right one.

    PYTHONPATH=kernels python examples/charts/too_few_terms.py [--output too_few_terms.png]

The series converges everywhere, but each supernumerary arc needs more terms than the last; with too few the intensity leaves the page.
"""

import argparse
from pathlib import Path

import numpy as np
from opal_kernels.charts import png, rainbow_data
from opal_kernels.charts.canvas import Axes, Canvas
from opal_kernels.charts.rainbow_chart import encode
from opal_kernels.optics.rainbow import airy_function

COLOURS = ((0.85, 0.2, 0.08), (0.85, 0.5, 0.08), (0.6, 0.7, 0.15), (0.15, 0.55, 0.9))


def draw() -> np.ndarray:
    """Return the chart, linear Rec.709."""
    canvas = Canvas(1000, 560)
    axes = Axes(canvas, 70, 60, 890, 430, (-3.0, 14.0), (-0.02, 0.45))
    axes.frame(range(-2, 15, 2), [0, 0.1, 0.2, 0.3, 0.4])
    x = np.linspace(-3, 14, 1701)
    for terms, colour in zip((4, 8, 16, 32), COLOURS, strict=True):
        value = rainbow_data.de_morgan(x, terms) ** 2
        axes.curve(x, np.where(value < 0.5, value, np.nan), colour)
    axes.curve(x, airy_function.airy(-x)[0] ** 2, (0.9, 0.9, 0.9), 2.2)
    rows = [(f"{terms} terms", colour) for terms, colour in zip((4, 8, 16, 32), COLOURS, strict=True)]
    axes.legend([("Airy's function", (0.9, 0.9, 0.9)), *rows])
    canvas.text(70, 24, "Intensity against X, the angle from the bow in Airy's unit")
    canvas.text(70, 525, "maxima: 1.019 the bow, 3.248, 4.820, 6.163 ... its supernumerary arcs", scale=1)
    return canvas.pixels


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=Path("renders/too_few_terms.png"))
    path = parser.parse_args().output
    path.parent.mkdir(parents=True, exist_ok=True)
    png.write(path, encode(draw()))
    print(path)
