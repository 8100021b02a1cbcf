# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the optics: where they lie and how they are read. `README.md` beside this file names every source.

Tables are read on first use, kept, and handed out read-only: copy before changing.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).resolve().parent


@cache
def array(name: str) -> np.ndarray:
    """Return the array of ``<name>.npy``, read-only, float64.

    Raises
    ------
    FileNotFoundError
        If there is no such table.
    """
    values = np.load(FOLDER / f"{name}.npy").astype(np.float64)
    values.setflags(write=False)
    return values


@cache
def columns(name: str) -> dict[str, np.ndarray]:
    """Return the columns of ``<name>.csv`` by their headings, read-only, float64.

    Lines that start with ``#`` are the table's source; the first other line holds the headings.

    Raises
    ------
    FileNotFoundError
        If there is no such table.
    """
    with open(FOLDER / f"{name}.csv", encoding="utf-8") as file:
        lines = [line.strip() for line in file if line.strip() and not line.startswith("#")]
    values = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    values.setflags(write=False)
    return {heading: values[:, i] for i, heading in enumerate(lines[0].split(","))}
