# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured absorption curves from text: a wavelength in nm and an absorption coefficient in 1/mm on each line.

Columns are parted by semicolons or tabs, and then a comma is a decimal point; else by commas or blanks. Lines that start with ``#``,
empty ones, two lines of headings and columns after the second are passed over. σa is the natural (Napierian) coefficient, T = exp(-σa d); decadic absorbances have to be multiplied by ln 10.
"""

from __future__ import annotations

import math
import re
from typing import NamedTuple

import numpy as np

from .descriptions import SPECTRUM_FIRST_NM, SPECTRUM_SIZE

_LAST_NM = SPECTRUM_FIRST_NM + SPECTRUM_SIZE - 1
_STRONG_SEPARATOR = re.compile(r"\s*[;\t]\s*")
_SEPARATOR = re.compile(r"\s*,\s*|\s+")
# Names of the columns, and their units.
_HEADINGS = 2


class CurveError(ValueError):
    """A curve that cannot be used; the sentence names the line where there is one."""


class Curve(NamedTuple):
    """A measured absorption.

    Attributes
    ----------
    wavelengths_nm, absorption_per_mm : ndarray
        (n,) each, by ascending wavelength.
    ignored_columns : int
        How many columns after the second the file has, at most.
    """

    wavelengths_nm: np.ndarray
    absorption_per_mm: np.ndarray
    ignored_columns: int


def parse(text: str) -> Curve:
    """Reads a curve.

    Parameters
    ----------
    text : str
        The file's content.

    Raises
    ------
    CurveError
        With one sentence; it names the line unless the whole file is at fault.
    """
    samples: dict[float, float] = {}
    headings_left, columns = _HEADINGS, 2
    for number, line in enumerate(text.lstrip("\ufeff").splitlines(), start=1):
        content = line.split("#", 1)[0].strip().strip(",;")
        if not content:
            continue
        cells = _cells(number, content)
        if headings_left and not (_is_number(cells[0]) or cells[0][:1].isdigit()):
            headings_left -= 1
            continue
        headings_left = 0
        columns = max(columns, len(cells))
        nm, value = _sample(number, cells)
        if nm in samples:
            raise CurveError(f"Line {number}: the wavelength {nm:g} nm stands there a second time.")
        samples[nm] = value
    if not samples:
        raise CurveError("The file holds no samples; each line needs a wavelength in nm and an absorption in 1/mm.")
    nm = np.array(sorted(samples))
    if nm[-1] < SPECTRUM_FIRST_NM or nm[0] > _LAST_NM:
        raise CurveError(
            f"The wavelengths run from {nm[0]:g} to {nm[-1]:g}; they have to be in nm and meet the visible range, "
            f"{SPECTRUM_FIRST_NM} to {_LAST_NM} nm."
        )
    return Curve(nm, np.array([samples[w] for w in nm]), columns - 2)


def _cells(number: int, content: str) -> list[str]:
    """The columns of a line; decimal commas become points."""
    if _STRONG_SEPARATOR.search(content):
        return [cell.replace(",", ".") for cell in _STRONG_SEPARATOR.split(content)]
    words = content.replace(",", ".").split() if "," in content else []
    if len(words) > 1 and all(_is_number(word) and word == word.strip(".") for word in words[:2]):
        raise CurveError(f"Line {number}: a comma may part columns or stand for a decimal point here; part columns with semicolons.")
    return _SEPARATOR.split(content)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _sample(number: int, cells: list[str]) -> tuple[float, float]:
    if len(cells) < 2:
        raise CurveError(f"Line {number}: two numbers are needed, a wavelength in nm and an absorption in 1/mm.")
    for cell in cells[:2]:
        if not _is_number(cell):
            raise CurveError(f"Line {number}: “{cell}” is not a number.")
    nm, value = float(cells[0]), float(cells[1])
    if not (math.isfinite(nm) and nm > 0):
        raise CurveError(f"Line {number}: a wavelength has to be above 0, not {cells[0]}.")
    if not math.isfinite(value):
        raise CurveError(f"Line {number}: an absorption has to be finite, not {cells[1]}.")
    if value < 0:
        raise CurveError(f"Line {number}: an absorption cannot be negative, as {cells[1]} is.")
    return nm, value
