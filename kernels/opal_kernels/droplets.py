# SPDX-License-Identifier: GPL-3.0-or-later
"""A rainbow as a medium: the phase function of drops as a table that the tracer can sample.

The diffraction lobe, half of all scattered light in a fraction of a degree round the forward direction, is left out unless it is asked
for: that light goes on as if nothing had happened, and a medium's extinction then counts what drops take by geometry alone. With the
lobe both are double: `Drops.extinction_factor`. The sun's disc is not folded in: the tracer samples it as a light.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from . import binding
from .descriptions import Phase, PhaseKind
from .table_store import TableStore

if TYPE_CHECKING:
    from .optics.rainbow.arcs import Arcs

FIRST_NM, LAST_NM, STEP_NM = 380.0, 780.0, 10.0
FLAT_STEP_NM = 25.0
_COARSE, _FINE, _FINE_FROM = np.radians(0.25), np.radians(0.05), np.radians(60.0)
_CLOCKS = np.radians([*range(0, 100, 4), *range(108, 181, 12)])  # closest where a bow is seen: its top moves with the place
_SINGLE_SIZE = 0.02  # a narrower spread leaves ripple that the angles of a table cannot follow

Progress = Callable[[float], bool | None]


@dataclass(frozen=True)
class Drops:
    """What a rainbow's drops are.

    Attributes
    ----------
    theory : str
        One of `optics.rainbow.THEORIES`.
    radius_um : float
        Mean radius, µm, 0.1 to 5000.
    spread : float
        Standard deviation of the radii over their mean, 0 to 1; 0 is a single size.
    distribution : str
        One of `optics.rainbow.drops.DISTRIBUTIONS`.
    celsius, salinity : float
        Of water: °C, and parts per thousand of salt.
    index : float, optional
        Of another liquid or of glass, relative to air at 589.3 nm, instead of water's.
    dispersion : float
        With `index`: Cauchy's second coefficient, µm².
    diffraction : bool
        Keep the forward lobe.
    flattening : float
        ``DROPLET`` alone: 0 spheres, 1 the shape of falling drops.
    elevations : tuple of float
        ``DROPLET`` with flattening: heights of the suns over the horizon, radians, ascending.
    """

    theory: str = "AIRY"
    radius_um: float = 250.0
    spread: float = 0.05
    distribution: str = "LOG_NORMAL"
    celsius: float = 20.0
    salinity: float = 0.0
    index: float | None = None
    dispersion: float = 0.0
    diffraction: bool = False
    flattening: float = 0.0
    elevations: tuple[float, ...] = ()

    @property
    def flat(self) -> bool:
        """Whether the table depends on where the sun stands and on where one looks."""
        return self.theory == "DROPLET" and self.flattening > 0.0

    @property
    def extinction_factor(self) -> float:
        """Cross-section of a drop over the area of its disc."""
        return 2.0 if self.diffraction else 1.0

    def wavelengths(self) -> np.ndarray:
        """The table's wavelengths, nm."""
        step = FLAT_STEP_NM if self.flat else STEP_NM
        return np.arange(FIRST_NM, LAST_NM + 0.5 * step, step)

    def angles(self) -> np.ndarray:
        """The table's scattering angles, radians: 0.05° from 60° on, where bows can lie, 0.25° before, fine in the forward lobe."""
        fine = np.linspace(_FINE_FROM, np.pi, round((np.pi - _FINE_FROM) / _FINE) + 1)
        if not self.diffraction:
            return np.concatenate([np.arange(0.0, _FINE_FROM - _FINE, _COARSE), fine])
        ring = 1.0 / (2000.0 * np.pi * self.radius_um / FIRST_NM)  # 1/x
        lobe = np.arange(0.0, 20.0 * ring, 0.1 * ring)
        last = min(lobe[-1], 0.5 * _FINE_FROM)
        rings = np.geomspace(last, _FINE_FROM, max(2, int(np.log(_FINE_FROM / last) / 0.02)))
        return np.concatenate([lobe[lobe < last], rings[:-1], fine])

    def clocks(self) -> np.ndarray:
        """Places on the bow from its top (0) to below its feet (π)."""
        return _CLOCKS

    def key(self) -> str:
        """Everything that the table's numbers depend on, as text."""
        return f"drops {_code()} {sorted(asdict(self).items())}"


_SOURCES = ("droplets.py", "optics/dispersion.py", "optics/fresnel.py", "optics/rainbow/*.py")


@lru_cache(maxsize=1)
def _code() -> str:
    """Hash of all that a table's numbers come out of, the library's sums among it: what other code computed is never found again."""
    folder = Path(__file__).parent
    files = [path for pattern in _SOURCES for path in sorted(folder.glob(pattern))]
    found = hashlib.sha256()
    for path in (*files, Path(binding.library()._name)):
        found.update(path.read_bytes())
    return found.hexdigest()[:16]


def _indices(drops: Drops, wavelengths: np.ndarray) -> np.ndarray | None:
    if drops.index is None:
        return None
    return drops.index + drops.dispersion * ((1e3 / wavelengths) ** 2 - (1e3 / 589.3) ** 2)


def _evaluate(drops: Drops, progress: Progress | None, **place: float) -> np.ndarray:
    from .optics import rainbow

    wavelengths = drops.wavelengths()
    return rainbow.phase_function(
        drops.theory,
        drops.radius_um,
        wavelengths,
        drops.angles(),
        drops.spread,
        # Half a cell of the table, for ripple that lies between its angles; a thirtieth of what the sun's disc does to a variance.
        0.5 * _FINE if drops.theory == "MIE" and drops.spread < _SINGLE_SIZE else 0.0,
        distribution=drops.distribution,
        celsius=drops.celsius,
        salinity=drops.salinity,
        index=_indices(drops, wavelengths),
        diffraction=drops.diffraction,
        flattening=drops.flattening if drops.flat else 0.0,
        progress=progress,
        **place,
    )


def _compute(drops: Drops, progress: Progress | None) -> np.ndarray:
    if not drops.flat:
        return _evaluate(drops, progress).astype(np.float32)
    from .optics.rainbow import droplet

    elevations = drops.elevations or (0.0,)
    clocks = drops.clocks()
    nodes = len(elevations) * len(clocks)
    values = None
    try:
        for number in range(nodes):
            e, c = divmod(number, len(clocks))

            def told(done: float, number: int = number) -> bool | None:
                return progress((number + done) / nodes) if progress is not None else None

            one = _evaluate(drops, told, sun_elevation_rad=float(elevations[e]), clock_rad=float(clocks[c]))
            if values is None:
                values = np.empty((2, len(elevations), len(clocks), *one.shape[1:]), np.float32)
            values[:, e, c] = one
    finally:
        droplet.forget()
    return values


def _normalised(values: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Scale so that what the tracer interpolates, linear in the cosine, integrates to 1 at every wavelength."""
    mean = 0.5 * (values[0] + values[1])
    cosines = np.cos(angles.astype(float))
    total = np.pi * ((mean[..., 1:] + mean[..., :-1]) * (cosines[:-1] - cosines[1:])).sum(axis=-1, keepdims=True)
    return (values / total).astype(np.float32)


@lru_cache(maxsize=1)
def _recent() -> dict[str, np.ndarray]:
    return {}


_MOST_RECENT = 8


def table(drops: Drops, store: TableStore | None = None, progress: Progress | None = None) -> np.ndarray:
    """The phase function of drops in two polarisations.

    Parameters
    ----------
    drops : Drops
    store : TableStore, optional
        Where it is looked for before it is computed, and kept afterwards.
    progress : callable, optional
        Called with the fraction done while it is computed; returning False stops.

    Returns
    -------
    array (2, n_wavelengths, n_angles)
        Perpendicular and parallel, 1/sr. For flattened drops (2, n_elevations, n_clocks, n_wavelengths, n_angles).

    Raises
    ------
    ValueError
        If the drops cannot be, in one sentence.
    opal_kernels.optics.rainbow.Cancelled
        If `progress` returned False.
    """
    key, recent = drops.key(), _recent()
    values = recent.get(key)
    if values is None:
        values = store.read(key) if store is not None else None
        if values is None:
            values = _normalised(_compute(drops, progress), drops.angles())
            if store is not None:
                store.write(key, values)
    recent.pop(key, None)
    recent[key] = values
    while len(recent) > _MOST_RECENT:
        del recent[next(iter(recent))]
    return values


def phase(drops: Drops, polarization: bool = True, store: TableStore | None = None, progress: Progress | None = None) -> Phase:
    """The phase function of drops for the tracer; parameters and errors as of `table`.

    Parameters
    ----------
    polarization : bool
        Tell the tracer how the light is polarised, for a camera with a filter.
    """
    values = table(drops, store, progress)
    both = values[0] + values[1]
    degree = np.divide(values[0] - values[1], both, out=np.zeros_like(both), where=both > 0) if polarization else None
    return Phase(
        kind=PhaseKind.TABLE,
        wavelengths=drops.wavelengths(),
        angles=drops.angles(),
        values=0.5 * both,
        polarization=degree,
        elevations=np.asarray(drops.elevations or (0.0,)) if drops.flat else None,
        clocks=drops.clocks() if drops.flat else None,
    )


def arcs(drops: Drops) -> Arcs:
    """Where these drops show bows, glory and corona, for an eye that looks for them; errors as of `table` where the sizes cannot be."""
    from .optics.rainbow import arcs, water
    from .optics.rainbow import drops as sizes

    index = _indices(drops, arcs.NM)
    if index is None:
        index = water.index(arcs.NM, drops.celsius, drops.salinity)
    radii, weights = sizes.quadrature(drops.radius_um, drops.spread, drops.distribution)
    area = weights * radii**2
    return arcs.of(
        index,
        float((area * radii).sum() / area.sum()),
        waves=not drops.theory.startswith("DESCARTES"),
        glory=drops.theory == "MIE",
        corona=drops.diffraction,
    )


def index_refusal(drops: Drops) -> str:
    """Why an index that was given cannot be, as it is at the wavelengths of a table; empty where it can."""
    wavelengths = drops.wavelengths()
    index = _indices(drops, wavelengths)
    if index is None or (np.isfinite(index) & (index > 1)).all():
        return ""
    worst = int(np.argmin(index))
    return f"an index of {index[worst]:.3f} at {wavelengths[worst]:.0f} nm, and drops need one above 1"


def elevation_nodes(heights: Sequence[float]) -> tuple[float, ...]:
    """Heights (radians) at which a table for flattened drops is computed: those of the suns, at most four, in whole tenths of a degree."""
    tenths = sorted({round(np.degrees(h) * 10) for h in heights if -0.1 <= h <= np.pi / 2})
    if len(tenths) > 4:
        tenths = [tenths[round(i * (len(tenths) - 1) / 3)] for i in range(4)]
    return tuple(float(np.radians(t / 10)) for t in tenths)
