# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables for the tracer: normalised, with the theory's asymmetry, kept on disk, and recomputed when a file is damaged."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from opal_kernels import droplets
from opal_kernels.droplets import Drops
from opal_kernels.optics import rainbow
from opal_kernels.optics.rainbow import geometric, water
from opal_kernels.table_store import TableStore

SMALL = Drops(theory="DESCARTES_SAMPLED")


@pytest.fixture(autouse=True)
def _fresh():
    droplets._recent().clear()


def moments(drops, values):
    """Integral of the mean over the sphere and mean cosine, each (n_wavelengths,), as the tracer interpolates."""
    c, mean = np.cos(drops.angles()), values.mean(axis=0).astype(float)
    weight = np.pi * (c[:-1] - c[1:])
    f = mean * c
    return ((mean[..., 1:] + mean[..., :-1]) * weight).sum(-1), ((f[..., 1:] + f[..., :-1]) * weight).sum(-1)


@pytest.mark.parametrize(
    "drops", [Drops(), Drops("DESCARTES"), SMALL, Drops("MIE", 8.0, spread=0.1, diffraction=True)], ids=lambda d: d.theory
)
def test_a_table_integrates_to_one_and_keeps_the_asymmetry(drops):
    values = droplets.table(drops)
    assert values.shape == (2, drops.wavelengths().size, drops.angles().size) and values.min() >= 0
    total, g = moments(drops, values)
    np.testing.assert_allclose(total, 1, atol=1e-5)
    fine = np.concatenate([np.linspace(0, 0.2, 20001)[:-1], np.linspace(0.2, np.pi, 20001)])
    p = rainbow.phase_function(drops.theory, drops.radius_um, [550.0], fine, drops.spread, diffraction=drops.diffraction).mean(axis=(0, 1))
    f = p * np.sin(fine) * np.cos(fine)
    exact = 2 * np.pi * ((f[1:] + f[:-1]) / 2 * np.diff(fine)).sum()
    assert g[17] == pytest.approx(exact, abs=1e-3)


def test_without_its_lobe_a_mie_bow_is_as_bright_as_airys():
    # The primary's mean over 137 to 143 degrees; Airy's cubic wavefront is 0.2 to 1.6 per cent off there.
    nm = np.array([550.0])
    angles = np.radians(np.linspace(137, 143, 121))
    means = []
    for theory in ("MIE", "AIRY"):
        drops = Drops(theory, 100.0)
        p = rainbow.phase_function(theory, 100.0, nm, drops.angles(), 0.05, sizes=24, diffraction=False)
        c = np.cos(drops.angles())
        total = np.pi * ((p[..., 1:] + p[..., :-1]).mean(axis=0) * (c[:-1] - c[1:])).sum()
        means.append(np.interp(angles, drops.angles(), p.mean(axis=(0, 1))).mean() / total)
    assert means[0] == pytest.approx(means[1], rel=0.02)


def test_a_table_is_kept_and_read_back(tmp_path):
    store = TableStore(tmp_path / "made when needed")
    first = droplets.table(SMALL, store)
    droplets._recent().clear()

    def never(_done):
        raise AssertionError("it was computed again")

    again = droplets.table(SMALL, store, never)
    assert np.array_equal(first, again)
    assert droplets.table(Drops(theory="DESCARTES_SAMPLED", celsius=21.0), store).shape == first.shape
    assert len(list((tmp_path / "made when needed").iterdir())) == 2


@pytest.mark.parametrize("harm", ["flip", "cut", "empty", "other"])
def test_a_damaged_table_is_computed_again_with_a_message(tmp_path, harm):
    said = []
    store = TableStore(tmp_path, warn=said.append)
    first = droplets.table(SMALL, store)
    path = store.path(SMALL.key())
    data = bytearray(path.read_bytes())
    if harm == "flip":
        data[len(data) // 2] ^= 1
    path.write_bytes({"flip": data, "cut": data[:-100], "empty": b"", "other": b"no header\n" + data}[harm])
    droplets._recent().clear()
    assert np.array_equal(droplets.table(SMALL, store), first)
    assert len(said) == 1 and "damaged" in said[0]
    droplets._recent().clear()
    assert np.array_equal(droplets.table(SMALL, store), first) and len(said) == 1


def test_the_least_recently_used_tables_go(tmp_path):
    import os

    store = TableStore(tmp_path, most_bytes=30_000)
    noise = np.random.default_rng(0)
    for number in range(12):
        store.write(f"table {number}", noise.random(1000))
        os.utime(store.path(f"table {number}"), (number, number))
        if number == 5:
            for kept in range(6):
                if store.path(f"table {kept}").is_file():
                    os.utime(store.path(f"table {kept}"), (1000 if kept == 3 else kept,) * 2)
    assert store.bytes() <= 30_000
    assert store.read("table 11") is not None and store.read("table 3") is not None
    assert store.read("table 0") is None


def test_a_folder_that_cannot_be_written_only_costs_time(tmp_path):
    said = []
    (tmp_path / "file").write_text("in the way")
    store = TableStore(tmp_path / "file" / "folder", warn=said.append)
    assert droplets.table(SMALL, store) is not None
    assert len(said) == 1 and "cannot be kept" in said[0]


def test_every_parameter_belongs_to_the_key():
    base = Drops("DROPLET", flattening=0.5, elevations=(0.2,))
    changes = {
        "theory": "AIRY", "radius_um": 251.0, "spread": 0.06, "distribution": "GAMMA", "celsius": 19.0, "salinity": 1.0, "index": 1.4,
        "dispersion": 0.001, "diffraction": True, "flattening": 0.6, "elevations": (0.3,),
    }  # fmt: skip
    assert set(changes) == set(Drops.__dataclass_fields__)
    keys = {Drops(**{**base.__dict__, name: value}).key() for name, value in changes.items()}
    assert len(keys) == len(changes) and base.key() not in keys


def test_another_formula_has_other_keys(tmp_path, monkeypatch):
    """A stored table is found by the very sources that computed it: a changed one, or another library, computes it again."""
    before = SMALL.key()
    package = tmp_path / "opal_kernels"
    for pattern in droplets._SOURCES:
        found = list(Path(droplets.__file__).parent.glob(pattern))
        assert found, pattern
        for path in found:
            copy = package / path.relative_to(Path(droplets.__file__).parent)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(path.read_bytes())
    monkeypatch.setattr(droplets, "__file__", str(package / "droplets.py"))

    def key():
        droplets._code.cache_clear()
        return SMALL.key()

    try:
        assert key() == before
        with (package / "optics" / "rainbow" / "airy.py").open("a") as file:
            file.write("# changed\n")
        assert key() != before
    finally:
        droplets._code.cache_clear()


def test_the_keys_sources_are_all_that_tables_use():
    """Whatever of the optics the theories load is among the sources that a table's key counts."""
    code = "import sys, opal_kernels.optics.rainbow._tables; print(*[m.__file__ for n, m in sys.modules.items() if n.startswith('opal_kernels.optics.')])"
    used = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    folder = Path(droplets.__file__).parent
    counted = {path for pattern in droplets._SOURCES for path in folder.glob(pattern)}
    assert len(used) > 10 and {Path(path) for path in used} <= counted, {Path(path).name for path in used} - {path.name for path in counted}


def test_glass_beads_have_their_bow_at_22_degrees():
    drops = Drops("AIRY", 300.0, index=1.51, dispersion=0.0042)
    values = droplets.table(drops).mean(axis=0)
    radius = 180 - np.degrees(drops.angles())
    row = values[21]  # 590 nm
    inside = (radius > 15) & (radius < 30)
    peak = radius[inside][row[inside].argmax()]
    assert peak == pytest.approx(np.degrees(geometric.bow_radius(1.51, 1)), abs=0.4)
    assert peak == pytest.approx(22, abs=1)


def test_sea_water_and_warmth_move_the_bow():
    bows = [np.degrees(geometric.bow_radius(water.index(589.3, *state), 1)) for state in ((20.0, 0.0), (20.0, 35.0), (10.0, 0.0))]
    assert bows[0] - bows[1] == pytest.approx(0.9, abs=0.1)
    assert bows[0] - bows[2] == pytest.approx(0.10, abs=0.02)


def test_a_long_table_stops_at_once():
    import time

    begun = time.monotonic()
    with pytest.raises(rainbow.Cancelled):
        droplets.table(Drops("MIE", 2000.0), progress=lambda _done: False)
    assert time.monotonic() - begun < 8.0  # one sphere of a few that were begun


def test_a_table_of_flattened_drops_stops_at_once():
    """Half a minute's table, told to stop at its first sign: within what one drop takes."""
    import time

    begun = time.monotonic()
    with pytest.raises(rainbow.Cancelled):
        droplets.table(Drops("DROPLET", 700.0, 0.1, flattening=1.0, elevations=(0.3,)), progress=lambda _done: False)
    assert time.monotonic() - begun < 3.0
