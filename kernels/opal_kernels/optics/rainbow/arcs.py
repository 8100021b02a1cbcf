# SPDX-License-Identifier: GPL-3.0-or-later
"""Where drops show colours: the two bows and the glory round the antisolar point, the corona round the sun.

A bow is brightest not at Descartes' angle but inside it by the first maximum of Airy's function, by half a degree for rain and by five for fog.
Glory and corona are rings of a few times 1/x, x the drops' size parameter; where the sun's own disc is wider than the first ring nothing of
them is seen. Sources: van de Hulst, Light Scattering by Small Particles (1957), 13.2 (Airy), 8.31 (corona); rings of the glory as Lorenz-Mie
theory has them from 5 to 20 um radius (Laven, Appl. Opt. 42 (2003) 436, and `reference/fog_corona_glory.csv`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opal_kernels.optics.rainbow import geometric

NM = np.array([440.0, 589.3, 680.0])  # violet, the sodium line that a bow's radius is told at, red
_AIRY_PEAK = 1.0188  # -Ai'(-X) = 0
_WIDEST_SHIFT = 0.2  # rad; Airy's function says nothing of drops so small
_GLORY_RINGS = (3.1, 9.6)  # x times the first and the third ring's angle
_CORONA_RINGS = (5.14, 11.62)  # the same: maxima of (J1(z)/z)^2
_SUN_DISC = np.radians(0.53)


@dataclass(frozen=True)
class Arcs:
    """What drops of one kind show.

    Attributes
    ----------
    primary, secondary : float
        Angle from the antisolar point to where a bow's yellow is brightest, radians; NaN where the drops' index has no such bow.
    bands : tuple of (float, float)
        Inner and outer angle from the antisolar point, radians, of every bow, glory and corona.
    glory, corona : bool
        Whether these are among the bands.
    """

    primary: float
    secondary: float
    bands: tuple[tuple[float, float], ...]
    glory: bool = False
    corona: bool = False

    @property
    def radii(self) -> np.ndarray:
        """Angles a degree apart or closer that stand for the bands, radians."""
        return np.concatenate([np.linspace(low, high, 2 + int(np.degrees(high - low))) for low, high in self.bands])


def of(index: np.ndarray, radius_um: float, waves: bool = True, glory: bool = False, corona: bool = False) -> Arcs:
    """Return what drops show.

    Parameters
    ----------
    index : array (3,)
        Of the drops relative to air at `NM`.
    radius_um : float
        Of the drops, µm; of many sizes their mean weighted with their area.
    waves : bool
        Whether the theory has Airy's waves; rays alone put the bow at Descartes' angle.
    glory, corona : bool
        Whether the theory has a glory, and the phase function its diffraction lobe.
    """
    x = 2000 * np.pi * radius_um / NM
    bands, brightest = [], []
    for k in (1, 2):
        with np.errstate(invalid="ignore"):
            caustic = geometric.caustic_deviation(index, k)
            shift = np.minimum(_AIRY_PEAK * np.cbrt(geometric.curvature(index, k)) * x ** (-2 / 3), _WIDEST_SHIFT) if waves else 0.0
            at = np.pi - geometric.fold(np.array([caustic, caustic + shift]))
        brightest.append(float(at[1, 1]))
        if np.isfinite(at).any():
            bands.append((float(np.nanmin(at)), float(np.nanmax(at))))
    glory = glory and bool(_GLORY_RINGS[0] / x[1] > _SUN_DISC)
    corona = corona and bool(_CORONA_RINGS[0] / x[1] > _SUN_DISC)
    if glory:
        bands.append((0.0, float(min(_GLORY_RINGS[1] / x[1], np.pi))))
    if corona:
        bands.append((float(max(np.pi - _CORONA_RINGS[1] / x[1], 0.0)), np.pi))
    return Arcs(brightest[0], brightest[1], tuple(bands), glory, corona)
