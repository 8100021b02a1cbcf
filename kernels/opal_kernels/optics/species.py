# SPDX-License-Identifier: GPL-3.0-or-later
"""Gem species by name: index of refraction and absorption at any wavelength, from `data/species.toml`."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from opal_kernels import data
from opal_kernels.optics import dispersion

_FWHM_TO_EXPONENT = 4 * np.log(2)


@dataclass(frozen=True)
class Species:
    """One row of the table; `data/species.toml` says what each field means and in which unit."""

    name: str
    label: str
    formula: str
    coefficients: dict
    coefficients_e: dict | None
    bands: tuple[tuple[float, float, float], ...]
    curve: tuple[tuple[float, float], ...]
    density: float
    source: str
    absorption_source: str
    note: str


@lru_cache(maxsize=1)
def table() -> dict[str, Species]:
    """Return every species by its name, in the file's order."""
    rows = tomllib.loads((data.FOLDER / "species.toml").read_text(encoding="utf-8"))
    return {
        name: Species(
            name=name,
            label=row["label"],
            formula=row["formula"],
            coefficients=row["index"],
            coefficients_e=row.get("index_e"),
            bands=tuple(tuple(band) for band in row.get("bands", ())),
            curve=tuple(tuple(sample) for sample in row.get("curve", ())),
            density=row["density"],
            source=row["source"],
            absorption_source=row.get("absorption_source", ""),
            note=row.get("note", ""),
        )
        for name, row in rows.items()
    }


def get(name: str) -> Species:
    """Return a species.

    Raises
    ------
    KeyError
        With the names there are, if this is none of them.
    """
    try:
        return table()[name]
    except KeyError:
        raise KeyError(f"no species {name!r}; there are {', '.join(table())}") from None


def index(name: str, wavelengths_nm: np.ndarray, ray: str = "o") -> np.ndarray:
    """Return the index of refraction at wavelengths (nm), same shape.

    Parameters
    ----------
    name : str
        A name of `table()`.
    wavelengths_nm : array
        Wavelengths, nm.
    ray : {"o", "e"}
        The ordinary or the extraordinary ray; the ordinary one where the table has only that.

    Raises
    ------
    KeyError
        If there is no such species.
    """
    species = get(name)
    coefficients = species.coefficients_e if ray == "e" and species.coefficients_e else species.coefficients
    return dispersion.FORMULAS[species.formula](wavelengths_nm, **coefficients)


def gaussian_bands(bands, wavelengths_nm: np.ndarray) -> np.ndarray:
    """Return the absorption (1/m) of bands ((centre 1/cm, full width at half maximum 1/cm, peak 1/mm), ...)."""
    wavenumber = 1e7 / np.asarray(wavelengths_nm, float)
    sigma = np.zeros_like(wavenumber)
    for centre, width, peak in bands:
        sigma += 1e3 * peak * np.exp(-_FWHM_TO_EXPONENT * ((wavenumber - centre) / width) ** 2)
    return sigma


def absorption(name: str, wavelengths_nm: np.ndarray) -> np.ndarray:
    """Return the absorption coefficient (1/m) at wavelengths (nm), same shape. Raises KeyError for an unknown name."""
    species = get(name)
    sigma = gaussian_bands(species.bands, wavelengths_nm)
    if species.curve:
        nm, values = np.array(species.curve).T
        sigma += np.interp(wavelengths_nm, nm, values)
    return sigma
