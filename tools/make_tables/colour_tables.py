# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the colorimetric tables of `opal_kernels/data` from the package `colour-science` (0.4.6 was used).

    python tools/make_tables/colour_tables.py

cie1931_observer.npy  CIE 018:2019 (doi 10.25039/CIE.DS.xvudnb9b), 1 nm, 360-830 nm.
d65.npy               CIE S 014-2: the daylight components S0, S1, S2 and the chromaticity coefficients of CIE 15 to 5 nm,
                      between them linear, which is what CIE 15 prescribes for illuminants.
illuminants.csv       CIE A (by its formula), F2 (FL2), F11 (FL11) and LED-B3 at the published 5 nm, 380-780 nm.
"""

from __future__ import annotations

from pathlib import Path

import colour
import numpy as np

DATA = Path(__file__).resolve().parents[2] / "kernels" / "opal_kernels" / "data"
NM = np.arange(360, 831)

ILLUMINANTS_HEADER = """\
# Relative spectral power of light sources, any scale. Between samples linear, outside 380-780 nm zero (A: by its formula).
# a      CIE standard illuminant A, CIE S 014-2: 100 (560/l)^5 (exp(1.435e7/(2848*560))-1)/(exp(1.435e7/(2848 l))-1)
# f2     CIE FL2, cool white fluorescent, CIE 15:2018 table T.9
# f11    CIE FL11, narrow three-band fluorescent of 4000 K, CIE 15:2018 table T.9
# led    CIE LED-B3, blue-pumped phosphor LED, 4103 K, mean of measured lamps, CIE 15:2018 table T.12
"""


def observer() -> np.ndarray:
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    assert np.array_equal(cmfs.wavelengths, NM)
    return cmfs.values.T.copy()


def d65() -> np.ndarray:
    tabulated = colour.SDS_ILLUMINANTS["D65"]  # 300-780 nm at 5 nm, as printed
    nm, power = tabulated.wavelengths, tabulated.values
    # 785-830 nm, as printed in CIE S 014-2 (the package's table stops at 780).
    tail_nm = np.arange(785, 831, 5)
    tail = [63.8434, 64.3040, 61.8779, 59.4519, 55.7054, 51.9590, 54.6998, 57.4406, 58.8765, 60.3125]
    return np.interp(NM, np.append(nm, tail_nm), np.append(power, tail))


def write_illuminants(path: Path) -> None:
    nm = np.arange(360, 831, 5)
    a = 100 * (560 / nm) ** 5 * np.expm1(1.435e7 / (2848 * 560)) / np.expm1(1.435e7 / (2848 * nm))
    columns = [nm, a]
    for name in ("FL2", "FL11", "LED-B3"):
        sd = colour.SDS_ILLUMINANTS[name]
        columns.append(np.interp(nm, sd.wavelengths, sd.values, left=0, right=0))
    rows = [",".join([str(row[0].astype(int)), *(f"{v:.6g}" for v in row[1:])]) for row in np.array(columns).T]
    path.write_text(ILLUMINANTS_HEADER + "nm,a,f2,f11,led\n" + "\n".join(rows) + "\n", encoding="utf-8")


if __name__ == "__main__":
    np.save(DATA / "cie1931_observer.npy", observer())
    np.save(DATA / "d65.npy", d65())
    write_illuminants(DATA / "illuminants.csv")
