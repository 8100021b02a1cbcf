# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison of the five theories for print: the numbers of *Rainbow Chart*, drawn by matplotlib where it is installed.

    PYTHONPATH=kernels python examples/charts/theories_plotted.py [--radius 0.25] [--spread 0.05] [--output theories_plotted.png]

Strips of every theory in true colour under one exposure, luminance and degree of polarisation against the angle from the antisolar point, and a Lee
diagram (drop radius against angle) for each theory with waves. `docs/images/rainbow_theories.jpg` is this picture.
"""

import argparse
from pathlib import Path

import matplotlib
import numpy as np
from opal_kernels.charts import rainbow_data
from opal_kernels.charts.rainbow_chart import encode

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

NAMES = {
    "DESCARTES": ("Descartes", "0.55"),
    "DESCARTES_SAMPLED": ("Descartes, sampled", "tab:olive"),
    "AIRY": ("Airy", "tab:orange"),
    "MIE": ("Lorenz-Mie", "black"),
    "DROPLET": ("Droplet", "tab:blue"),
}


def _strips(axes, sheet: rainbow_data.Sheet) -> None:
    brightest = sheet.bows["MIE"].luminance.max()
    rows = np.array([sheet.bows[theory].rgb / brightest for theory in NAMES])
    first, last = sheet.bows["MIE"].radius_deg[[0, -1]]
    axes.imshow(encode(np.clip(rows, 0, 1)), aspect="auto", extent=(first, last, len(rows) - 0.5, -0.5), interpolation="nearest")
    axes.set_yticks(range(len(rows)), [name for name, _ in NAMES.values()])
    axes.set_xticks([])


def _lee(axes, sheet: rainbow_data.Sheet, theory: str) -> None:
    first, last = sheet.bows["MIE"].radius_deg[[0, -1]]
    edge = np.log10(sheet.lee_radii_um / 1000)
    step = 0.5 * (edge[1] - edge[0])
    picture = encode(np.clip(sheet.lee[theory], 0, 1))
    axes.imshow(picture, aspect="auto", origin="lower", extent=(first, last, edge[0] - step, edge[-1] + step), interpolation="nearest")
    marks = [r for r in (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0) if edge[0] - step <= np.log10(r) <= edge[-1] + step]
    axes.set_yticks(np.log10(marks), [f"{r:g}" for r in marks])
    axes.set_title(NAMES[theory][0], fontsize=9)
    axes.set_xlabel("degrees from the antisolar point")


def draw(sheet: rainbow_data.Sheet) -> Figure:
    """Return the figure of a sheet's numbers."""
    with plt.rc_context({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False}):
        figure = plt.figure(figsize=(11, 9), layout="constrained")
        rows = [["strips"] * 3, ["luminance"] * 3, ["polarisation"] * 3, list(rainbow_data.LEE_THEORIES)]
        axes = figure.subplot_mosaic(rows, height_ratios=(1, 1.7, 1.1, 1.7))
        luminance, polarisation = axes["luminance"], axes["polarisation"]
        axes["strips"].set_title(f"Drops of {sheet.radius_um / 1000:g} mm radius, spread {sheet.spread:.0%}, under the sun")
        _strips(axes["strips"], sheet)
        for theory, (name, colour) in NAMES.items():
            bow = sheet.bows[theory]
            wide = 2.2 if theory == "MIE" else 1.2
            luminance.semilogy(bow.radius_deg, bow.luminance, color=colour, label=name, linewidth=wide, alpha=0.9)
            polarisation.plot(bow.radius_deg, bow.polarisation, color=colour, label=name, linewidth=wide, alpha=0.9)
        luminance.set_ylabel("luminance, 1/sr")
        luminance.legend(frameon=False, ncols=5, loc="upper right", fontsize=8)
        polarisation.set_ylabel("degree of polarisation")
        polarisation.set_xlabel("degrees from the antisolar point")
        for one in (luminance, polarisation):
            one.set_xlim(rainbow_data.FIRST_DEG, rainbow_data.LAST_DEG)
            one.grid(alpha=0.25)
        for theory in rainbow_data.LEE_THEORIES:
            _lee(axes[theory], sheet, theory)
        axes[rainbow_data.LEE_THEORIES[0]].set_ylabel("drop radius, mm")
    return figure


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--radius", type=float, default=0.25, help="of the strips' and curves' drops, mm")
    parser.add_argument("--spread", type=float, default=0.05)
    parser.add_argument("--output", type=Path, default=Path("renders/theories_plotted.png"))
    options = parser.parse_args()
    options.output.parent.mkdir(parents=True, exist_ok=True)
    draw(rainbow_data.compute(1000 * options.radius, options.spread)).savefig(options.output, dpi=100)
    print(options.output)
