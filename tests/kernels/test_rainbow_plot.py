# SPDX-License-Identifier: GPL-3.0-or-later
"""The chart of the theories as the documentation's plotting library draws it: what is drawn is what was computed."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from opal_kernels.charts import rainbow_data
from opal_kernels.optics import rainbow

pytest.importorskip("matplotlib")
SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "charts" / "theories_plotted.py"


def test_matplotlib_draws_the_sheets_numbers(tmp_path):
    specification = importlib.util.spec_from_file_location("theories_plotted", SCRIPT)
    script = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(script)
    sheet = rainbow_data.Sheet(60.0, 0.05, lee_radii_um=np.array([20.0, 30.0, 45.0]))
    for theory in rainbow.THEORIES:
        sheet.bows[theory] = rainbow_data.bow(theory, 60.0, 0.05, 40.0, 0.1)
    for theory in rainbow_data.LEE_THEORIES:
        rows = [rainbow_data.bow(theory, radius, 0.0, 40.0, 0.1) for radius in sheet.lee_radii_um.tolist()]
        sheet.lee[theory] = np.array([row.rgb / row.luminance.max() for row in rows])
    figure = script.draw(sheet)
    axes = {one.get_ylabel(): one for one in figure.axes}
    for label, values in (("luminance, 1/sr", "luminance"), ("degree of polarisation", "polarisation")):
        lines = axes[label].get_lines()
        assert len(lines) == len(sheet.bows)
        for line, bow in zip(lines, sheet.bows.values(), strict=True):
            np.testing.assert_array_equal(line.get_ydata(), getattr(bow, values))
            np.testing.assert_array_equal(line.get_xdata(), bow.radius_deg)
    pictures = [image.get_array() for one in figure.axes for image in one.get_images()]
    assert [p.shape[0] for p in pictures] == [5, 3, 3, 3]
    strip = pictures[0][list(script.NAMES).index("MIE")].astype(float)
    degrees = sheet.bows["MIE"].radius_deg
    primary = (degrees > 36) & (degrees < 43)
    red, blue = (degrees[primary][strip[primary, c].argmax()] for c in (0, 2))
    assert red > blue, "red is outside"
    path = tmp_path / "sheet.png"
    figure.savefig(path, dpi=50)
    assert path.stat().st_size > 10_000
