# SPDX-License-Identifier: GPL-3.0-or-later
"""Media with known numbers: the list in the interface, and what choosing one fills in.

Coefficients are those of the paper named in each row, for red, green and blue, in 1/m. Where a paper gives the reduced
scattering coefficient (isotropic, the forward part of the phase function left out), the preset is isotropic too: that is what
the number means. The rows hold numbers alone; what is done with them is `on_preset`.

Sources
-------
Jensen, Marschner, Levoy and Hanrahan, "A Practical Model for Subsurface Light Transport", SIGGRAPH 2001, figure 5.
Narasimhan et al., "Acquiring Scattering Properties of Participating Media by Dilution", SIGGRAPH 2006, table 3.
Bruneton and Neyret, "Precomputed Atmospheric Scattering", EGSR 2008, section 4 (after Riley et al. 2004).
Koschmieder 1924: extinction = 3.912 / visibility, for a contrast of 2 % at the limit of sight; World Meteorological Organization,
"Guide to Instruments and Methods of Observation" (WMO-No. 8): fog is a visibility below 1 km, haze one of 1 to 5 km.
Mulholland and Croarkin, "Specific Extinction Coefficient of Flame Generated Smoke", Fire and Materials 24 (2000) 227: 8.7 m2/g.
Bond and Bergstrom, "Light Absorption by Carbonaceous Particles", Aerosol Sci. Technol. 40 (2006) 27: albedo of soot 0.2 to 0.3.
Dubovik et al., "Variability of Absorption and Optical Properties of Key Aerosol Types", J. Atmos. Sci. 59 (2002) 590: desert dust
(albedo 0.92 at 440 nm to 0.97 at 670 nm, asymmetry 0.68 to 0.70 for Solar Village), water clouds' asymmetry 0.85 after Hu and
Stamnes, "An Accurate Parameterization of the Radiative Properties of Water Clouds", J. Climate 6 (1993) 728.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

_KOSCHMIEDER = 3.912


@dataclass(frozen=True)
class Preset:
    """A medium by its coefficients.

    Attributes
    ----------
    scattering, absorption : tuple of float
        1/m for red, green and blue.
    anisotropy : float
        Mean cosine of the Henyey-Greenstein phase function; 0 is isotropic.
    """

    label: str
    source: str
    scattering: tuple[float, float, float]
    absorption: tuple[float, float, float]
    anisotropy: float = 0.0
    rayleigh: bool = False

    @property
    def extinction(self) -> tuple[float, ...]:
        return tuple(s + a for s, a in zip(self.scattering, self.absorption, strict=True))

    @property
    def albedo(self) -> tuple[float, ...]:
        return tuple(s / t if t > 0 else 0.0 for s, t in zip(self.scattering, self.extinction, strict=True))


def _per_mm(*values: float) -> tuple[float, ...]:
    return tuple(1000.0 * v for v in values)


def _of_visibility(metres: float, albedo: tuple[float, float, float]) -> dict[str, tuple[float, ...]]:
    extinction = _KOSCHMIEDER / metres
    return {"scattering": tuple(extinction * a for a in albedo), "absorption": tuple(extinction * (1 - a) for a in albedo)}


_JENSEN, _NARASIMHAN = "Jensen et al. 2001, reduced, isotropic", "Narasimhan et al. 2006, reduced, isotropic"
PRESETS: dict[str, Preset] = {
    "AIR": Preset("Clear Air", "Bruneton and Neyret 2008: Rayleigh at sea level", (5.8e-6, 13.5e-6, 33.1e-6), (0.0, 0.0, 0.0), 0.0, True),
    "HAZE": Preset("Air Haze", "Koschmieder, visibility 5 km; Bruneton and Neyret 2008", **_of_visibility(5000.0, (0.9, 0.9, 0.9)), anisotropy=0.76),
    "MIST": Preset("Mist", "Koschmieder, visibility 1 km; Hu and Stamnes 1993", **_of_visibility(1000.0, (1.0, 1.0, 1.0)), anisotropy=0.85),
    "FOG": Preset("Fog", "Koschmieder, visibility 100 m; Hu and Stamnes 1993", **_of_visibility(100.0, (1.0, 1.0, 1.0)), anisotropy=0.85),
    "SMOKE": Preset("Smoke", "Mulholland and Croarkin 2000 at 0.1 g/m³; Bond and Bergstrom 2006", (0.2175,) * 3, (0.6525,) * 3, 0.6),
    "DUST": Preset("Dust", "Koschmieder, visibility 1 km; Dubovik et al. 2002", **_of_visibility(1000.0, (0.97, 0.95, 0.92)), anisotropy=0.69),
    "MILK": Preset("Whole Milk", _JENSEN, _per_mm(2.55, 3.21, 3.77), _per_mm(0.0011, 0.0024, 0.014)),
    "SKIM_MILK": Preset("Skim Milk", _JENSEN, _per_mm(0.70, 1.22, 1.90), _per_mm(0.0014, 0.0025, 0.0142)),
    "CREAM": Preset("Cream", _JENSEN, _per_mm(7.38, 5.47, 3.15), _per_mm(0.0002, 0.0028, 0.0163)),
    "MARBLE": Preset("Marble", _JENSEN, _per_mm(2.19, 2.62, 3.00), _per_mm(0.0021, 0.0041, 0.0071)),
    "SKIN": Preset("Skin", _JENSEN, _per_mm(0.74, 0.88, 1.01), _per_mm(0.032, 0.17, 0.48)),
    "KETCHUP": Preset("Ketchup", _JENSEN, _per_mm(0.18, 0.07, 0.03), _per_mm(0.061, 0.97, 1.45)),
    "ORANGE_JUICE": Preset("Orange Juice", "Narasimhan et al. 2006, orange powder in water", _per_mm(1.5617e-4, 1.7482e-4, 1.762e-4), _per_mm(0.001449, 0.003441, 0.007863)),
    "APPLE_JUICE": Preset("Apple Juice", _NARASIMHAN, _per_mm(1.3612e-4, 1.5836e-4, 2.27e-4), _per_mm(0.012957, 0.023741, 0.052184)),
    "GRAPEFRUIT_JUICE": Preset("Grapefruit Juice", _NARASIMHAN, _per_mm(0.22826, 0.23998, 0.32748), _per_mm(0.0138, 0.018831, 0.056781)),
    "BEER": Preset("Beer", _NARASIMHAN, _per_mm(2.4356e-5, 2.4079e-5, 1.0564e-5), _per_mm(0.011492, 0.024911, 0.057786)),
    "RED_WINE": Preset("Red Wine", _NARASIMHAN, _per_mm(2.1129e-5, 0.0, 0.0), _per_mm(0.11632, 0.25191, 0.29434)),
    "COFFEE": Preset("Coffee", _NARASIMHAN, _per_mm(0.72378, 0.84557, 1.0247), _per_mm(4.7984, 6.5751, 8.8493)),
    "SEAWATER": Preset("Seawater", "Narasimhan et al. 2006, surface of the Pacific", _per_mm(1.764e-4, 3.2095e-4, 1.9617e-4), _per_mm(0.031845, 0.031324, 0.030147)),
}  # fmt: skip


def items() -> tuple[tuple[str, str, str], ...]:
    """Items of `material.opal.medium.preset`."""
    rows = tuple((name, row.label, f"{row.label}. Source: {row.source}") for name, row in PRESETS.items())
    return (("CUSTOM", "Custom", "The numbers below, as they are"), *rows)


def on_preset(medium: Any, _context: Any = None) -> None:
    """Fills a medium's numbers from the preset chosen."""
    row = PRESETS.get(medium.preset)
    if row is None:
        return
    extinction = row.extinction
    largest = max(extinction)
    medium.extinction = largest
    medium.extinction_color = tuple(e / largest for e in extinction)
    medium.albedo = row.albedo
    medium.anisotropy = row.anisotropy
    medium.phase = "RAYLEIGH" if row.rayleigh else "HENYEY_GREENSTEIN" if row.anisotropy else "ISOTROPIC"
