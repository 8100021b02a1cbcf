# SPDX-License-Identifier: GPL-3.0-or-later
"""The report's table of rainbows beside public Lorenz-Mie codes: 100 wavelengths x 31,416 angles, one drop radius.

    pip install miepython numba scattnlay            # in the environment that runs it, for the peers alone
    PYTHONPATH=kernels python benchmarks/rainbows.py                   # the whole table, for all three radii
    PYTHONPATH=kernels python benchmarks/rainbows.py --wavelengths 4   # peers at a few wavelengths, scaled up: says so

Each code computes |S1|^2 and |S2|^2; the agreement is that of the normalised phase function smoothed over 0.05 degrees. scattnlay, which
computes layered spheres, would take hours: it does one wavelength, at the 400 angles round the primary bow alone. What a peer did not do of
the wavelengths is scaled up, the angles are not. Cores used are the processor time over the wall time. Run it on a machine that does nothing else: times are medians of wall time, peers and Opal in turn.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

os.environ.setdefault("MIEPYTHON_USE_JIT", "1")  # read when miepython is imported

import numpy as np
from opal_kernels import droplets
from opal_kernels.optics.rainbow import mie, water

N_WAVELENGTHS, N_ANGLES = 100, 31416
RADII_UM = (10.0, 100.0, 500.0)
REPORT_SECONDS = 45 * 60.0  # the report of 2013: its table of 100 wavelengths
_SMOOTHING = np.radians(0.05)

ALL = slice(0, N_ANGLES)
_BOW = int(139.5 / 180 * (N_ANGLES - 1))
ROUND_THE_BOW = slice(_BOW - 200, _BOW + 200)

Table = Callable[[float, float, int], np.ndarray]  # index, size parameter, threads -> (2, angles) bare intensities


def _opal(n: float, x: float, threads: int) -> np.ndarray:
    return mie.uniform_intensities(n, x, N_ANGLES, threads)


def _miepython() -> Table:
    import miepython

    mu = np.cos(np.linspace(0, np.pi, N_ANGLES))

    def table(n: float, x: float, _threads: int) -> np.ndarray:
        return np.abs(np.array(miepython.S1_S2(n, x, mu, norm="wiscombe"))) ** 2

    return table


def _scattnlay() -> Table:
    from scattnlay import scattnlay

    theta = np.linspace(0, np.pi, N_ANGLES)[ROUND_THE_BOW]

    def table(n: float, x: float, _threads: int) -> np.ndarray:
        result = scattnlay(np.array([x]), np.array([complex(n)]), theta)
        return np.abs(np.array([np.ravel(result[-2]), np.ravel(result[-1])])) ** 2

    return table


PEERS: dict[str, tuple[Callable[[], Table], slice, int, float]] = {  # angles it computes, most wavelengths, largest drop in um
    "miepython": (_miepython, ALL, N_WAVELENGTHS, np.inf),
    "scattnlay": (_scattnlay, ROUND_THE_BOW, 1, 100.0),  # its series fails at x = 5700 (it says so), after minutes a wavelength
}


def _timed(work: Callable[[], object]) -> tuple[float, float]:
    """Wall seconds, and cores used."""
    cpu, wall = time.process_time(), time.perf_counter()
    work()
    wall = time.perf_counter() - wall
    return wall, (time.process_time() - cpu) / wall


def _smoothed(n: float, x: float, intensities: np.ndarray) -> np.ndarray:
    phase = intensities.mean(axis=0) / (np.pi * x * x * float(mie.efficiencies(n, x)[1]))
    width = round(_SMOOTHING / (np.pi / (N_ANGLES - 1)))
    return np.convolve(phase, np.ones(width) / width, "valid")


def measure(radii_um: tuple[float, ...] = RADII_UM, wavelengths: int = N_WAVELENGTHS, repeats: int = 1) -> list[dict]:
    """One record a code and radius: seconds for the whole table, cores, and the largest relative difference from Opal's smoothed p."""
    nm = np.linspace(380, 780, N_WAVELENGTHS)
    n = water.index(nm)
    middle = N_WAVELENGTHS // 2

    def chosen(most: int) -> np.ndarray:
        count = min(wavelengths, most)
        return np.linspace(0, N_WAVELENGTHS - 1, count).round().astype(int) if count > 1 else np.array([middle])

    peers: dict[str, Table] = {}
    for name, (load, *_) in PEERS.items():
        try:
            peers[name] = load()
            peers[name](1.33, 10.0, 1)  # compiles
        except ImportError as error:
            print(f"{name} is left out: {error}")
    records = []
    for radius in radii_um:
        x = 2000 * np.pi * radius / nm
        able = {name: table for name, table in peers.items() if radius <= PEERS[name][3]}
        times: dict[str, list[tuple[float, float]]] = {name: [] for name in ("opal", *able)}
        for _ in range(repeats):
            times["opal"].append(_timed(lambda x=x: [_opal(n[i], x[i], 0) for i in range(N_WAVELENGTHS)]))
            for name, table in able.items():
                most = PEERS[name][2]
                seconds, cores = _timed(lambda table=table, x=x, most=most: [table(n[i], x[i], 0) for i in chosen(most)])
                # The cost of a wavelength grows with the number of terms, so a few stand for all in proportion to x.
                times[name].append((seconds * x.sum() / x[chosen(most)].sum(), cores))
        bare = _opal(n[middle], x[middle], 0)
        for name, rows in times.items():
            _, angles, most, _ = PEERS.get(name, (None, ALL, N_WAVELENGTHS, 0.0))
            ours = _smoothed(n[middle], x[middle], bare[:, angles])
            theirs = ours if name == "opal" else _smoothed(n[middle], x[middle], peers[name](n[middle], x[middle], 0))
            records.append(
                {
                    "code": name,
                    "radius_um": radius,
                    "seconds": median(row[0] for row in rows),
                    "cores": median(row[1] for row in rows),
                    "measured_wavelengths": N_WAVELENGTHS if name == "opal" else len(chosen(most)),
                    "measured_angles": angles.stop - angles.start,
                    "difference": float(np.abs(theirs / ours - 1).max()),
                }
            )
    return records


def presets() -> list[dict]:
    """Seconds to the tables that artists wait for, computed anew."""
    records = []
    for name, drops in {"default": droplets.Drops(), "fogbow": droplets.Drops("MIE", 10.0, 0.1)}.items():
        droplets._recent().clear()
        seconds, cores = _timed(lambda drops=drops: droplets.table(drops))
        records.append({"preset": name, "seconds": seconds, "cores": cores})
    return records


def report(records: list[dict]) -> None:
    """Print the table, each code's time over Opal's, and Opal's gain over the report of 2013."""
    print(f"{N_WAVELENGTHS} wavelengths x {N_ANGLES} angles, both polarisations, {os.cpu_count()} processors")
    for row in records:
        opal = next(r for r in records if r["code"] == "opal" and r["radius_um"] == row["radius_um"])
        scaled = "" if row["measured_wavelengths"] == N_WAVELENGTHS else f", scaled up from {row['measured_wavelengths']} wavelengths"
        scaled += "" if row["measured_angles"] == N_ANGLES else f", {row['measured_angles']} angles alone"
        line = f"a = {row['radius_um']:5.0f} um  {row['code']:10} {row['seconds']:9.2f} s on {row['cores']:.2f} cores{scaled}"
        if row["code"] == "opal":
            line += f"; {REPORT_SECONDS / row['seconds']:.0f} times the report's 45 minutes"
        else:
            line += f"; Opal is {row['seconds'] / opal['seconds']:.1f} times faster, smoothed p agrees to {row['difference']:.1e}"
        print(line)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--radii", type=float, nargs="+", default=list(RADII_UM), help="um")
    parser.add_argument("--wavelengths", type=int, default=N_WAVELENGTHS, help="that the peers compute; fewer are scaled up")
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    records = measure(tuple(options.radii), options.wavelengths, options.repeats)
    report(records)
    made = presets()
    for row in made:
        print(f"preset {row['preset']}: {row['seconds']:.2f} s on {row['cores']:.2f} cores")
    if options.json:
        options.json.write_text(json.dumps({"tables": records, "presets": made}, indent=1))


if __name__ == "__main__":
    main()
