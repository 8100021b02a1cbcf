# SPDX-License-Identifier: GPL-3.0-or-later
"""The traced drop beside Lorenz-Mie, for round drops of 100 to 500 µm: what an eye sees of both bows and the band between.

Luminance of D65 under the sun, 5 % spread of sizes, smoothed over one degree; Mie's curves are in `mie_bow_luminance.csv`, averaged over so
many sizes that the interference of the bows with the light that the drop reflects outside is gone.
"""

from pathlib import Path

import numpy as np
import pytest
from opal_kernels.charts import rainbow_data

REFERENCE = Path(__file__).resolve().parents[1] / "reference_data" / "mie_bow_luminance.csv"
PRIMARY, SECONDARY = (36.0, 43.5), (49.5, 57.0)


def top(radius, luminance, span):
    """Radius (degrees) of the brightest place, by a parabola through all that is above 95 % of it: Mie's own rest of ripple counts less."""
    inside = (radius > span[0]) & (radius < span[1])
    r, y = radius[inside], luminance[inside]
    near = y > 0.95 * y.max()
    near &= np.abs(r - r[y.argmax()]) < 1.5
    _, slope, curvature = np.polynomial.polynomial.polyfit(r[near] - r[y.argmax()], y[near], 2)
    return r[y.argmax()] - slope / (2 * curvature)


@pytest.mark.parametrize(("micrometres", "largest"), [(100, 0.075), (250, 0.045), (500, 0.04)])
def test_round_traced_drops_shine_as_lorenz_mie_says(micrometres, largest):
    rows = np.genfromtxt(REFERENCE, delimiter=",", names=True)
    mie = rows[f"y_{micrometres}um"]
    bow = rainbow_data.bow("DROPLET", float(micrometres), 0.05, 20.0, 0.04, sizes=21)
    np.testing.assert_allclose(bow.radius_deg, rows["radius_deg"], atol=1e-6)
    degree = np.ones(25) / 25
    ratio = np.convolve(bow.luminance, degree, "valid") / np.convolve(mie, degree, "valid")
    assert np.abs(ratio - 1).max() < largest < 0.1
    for span in (PRIMARY, SECONDARY):
        assert top(bow.radius_deg, bow.luminance, span) == pytest.approx(top(rows["radius_deg"], mie, span), abs=0.05)
    inside = (bow.radius_deg > PRIMARY[0]) & (bow.radius_deg < PRIMARY[1])
    assert np.abs(ratio - 1)[inside[12:-12]].max() < 0.03, "the primary itself"


@pytest.mark.parametrize("radius", [100.0, 250.0, 400.0])
def test_each_polarisation_of_both_bows_is_lorenz_mies(radius):
    """Means over the primary, 137 to 143 degrees, and the secondary, 121 to 129: within 3 per cent, the secondary's parallel light within 6."""
    from opal_kernels.optics import rainbow

    primary, secondary = np.radians(np.arange(137.0, 143.0, 0.05)), np.radians(np.arange(121.0, 129.3, 0.05))
    angles = np.concatenate([secondary, primary])
    p = {t: rainbow.phase_function(t, radius, [550.0], angles, 0.05)[:, 0] for t in ("MIE", "AIRY", "DROPLET")}
    for theory in ("AIRY", "DROPLET"):
        for part, parallel in ((slice(secondary.size), 0.06), (slice(secondary.size, None), 0.03)):
            ours, exact = (p[t][:, part].mean(axis=1) for t in (theory, "MIE"))
            assert ours[0] == pytest.approx(exact[0], rel=0.03)
            assert ours[1] == pytest.approx(exact[1], rel=parallel)


def test_the_fifth_bow_shines_into_the_dark_band():
    """Beside the secondary, half a degree outside of the dark band's middle, Descartes' pile of the fifth order's rays is not there."""
    angles = np.radians(180 - np.arange(49.5, 51.0, 0.02))
    from opal_kernels.optics import rainbow

    luminance = {
        theory: rainbow.phase_function(theory, 300.0, [550.0], angles, 0.05, 0.0047, sizes=21).mean(axis=(0, 1))
        for theory in ("DESCARTES_SAMPLED", "AIRY", "DROPLET")
    }
    step = {theory: np.abs(np.diff(y)).max() / y.mean() for theory, y in luminance.items()}
    assert luminance["AIRY"] == pytest.approx(luminance["DROPLET"], rel=0.12)
    assert step["AIRY"] < step["DESCARTES_SAMPLED"]
