# SPDX-License-Identifier: GPL-3.0-or-later
"""Rainbows as media of the kernels' scene: drops from properties, tables from the store, and what keeps a bow out of sight."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from opal_kernels import droplets
from opal_kernels.descriptions import Density, Light, LightType, MediumLayer
from opal_kernels.optics.rainbow import drops as sizes
from opal_kernels.optics.rainbow import rain_places, sight
from opal_kernels.scene import Scene

from .. import rainbow_tables
from ..identity import Named
from ..report import Report

# Metres of height over which rain thins out where the world does not say: of the order of a shower cloud's base.
RAIN_HEIGHT = 1000.0


def drops_of(rainbow: Any, elevations: Sequence[float] = ()) -> droplets.Drops:
    """What `OpalRainbowProperties` says of the drops.

    Parameters
    ----------
    rainbow : OpalRainbowProperties
    elevations : sequence of float
        Heights of the suns, radians: flattened drops look different under each.
    """
    single = rainbow.distribution == "SINGLE"
    custom = rainbow.liquid == "CUSTOM"
    flattening = rainbow.flattening if rainbow.theory == "DROPLET" else 0.0
    return droplets.Drops(
        theory=rainbow.theory,
        radius_um=round(rainbow.radius * 1000.0, 4),
        spread=0.0 if single else 1.0 if rainbow.distribution == "MARSHALL_PALMER" else round(rainbow.spread, 6),
        distribution="LOG_NORMAL" if single else rainbow.distribution,
        celsius=20.0 if custom else round(rainbow.temperature, 3),
        salinity=round(rainbow.salinity, 3) if rainbow.liquid == "SEA_WATER" else 0.0,
        index=round(rainbow.index, 6) if custom else None,
        dispersion=round(rainbow.index_dispersion, 7) if custom else 0.0,
        diffraction=rainbow.diffraction,
        flattening=round(flattening, 5),
        elevations=droplets.elevation_nodes(elevations) if flattening > 0.0 else (),
    )


def refusal(rainbow: Any) -> str:
    """Why there are no drops as `OpalRainbowProperties` says them, in its own names and units; empty where they can be."""
    least, most = sizes.SMALLEST_UM / 1000.0, sizes.LARGEST_UM / 1000.0
    drops = drops_of(rainbow)
    if not least <= drops.radius_um / 1000.0 <= most:
        return f"Radius must lie between {least:g} and {most:g} mm, not {rainbow.radius:g} mm."
    if not 0.0 <= drops.spread <= sizes.LARGEST_SPREAD:
        return f"Spread must lie between 0 and {sizes.LARGEST_SPREAD:g}, not {rainbow.spread:g}."
    sentence = droplets.index_refusal(drops)
    return f"Index and Dispersion give {sentence}." if sentence else ""


class Rain:
    """Makes the media of rainbows.

    Parameters
    ----------
    scene : Scene
        Takes the media.
    report : Report
        Told of damaged tables and of what keeps a bow out of sight.
    stage : callable
        Takes a few words and the fraction done; may raise to stop.
    """

    def __init__(self, scene: Scene, report: Report, stage: Callable[..., None]) -> None:
        self._scene, self._report, self._stage = scene, report, stage
        self._lights: list[Light] = []
        self._metres = 1.0
        self._regions: list[rain_places.Box | rain_places.Air] = []
        self.present = False

    def begin(self, lights: Sequence[Light], metres: float) -> None:
        """The lamps of the scene, as they were read, and metres per unit."""
        self._lights, self._metres = list(lights), metres

    def stands(self, materials: Sequence[Any], box: tuple[np.ndarray, np.ndarray], transforms: np.ndarray) -> None:
        """Where the drops of a closed body are, if any of its materials are drops: its box, and box to world of its copies."""
        for material in materials:
            if material is not None and material.opal.kind == "RAINBOW" and not refusal(material.opal.rainbow):
                self._regions.append(rain_places.Box(droplets.arcs(drops_of(material.opal.rainbow)), transforms, *box))

    def _suns(self) -> list[np.ndarray]:
        """Directions to the suns, unit vectors."""
        suns = [light for light in self._lights if light.type == LightType.SUN]
        return [axis / np.linalg.norm(axis) for axis in (np.asarray(sun.transform, float)[:3, 2] for sun in suns)]

    def add(self, rainbow: Any) -> int:
        """Adds what `OpalRainbowProperties` says; returns the medium's number.

        Raises
        ------
        ValueError
            If the theory cannot hold the drops, in one sentence.
        """
        drops, phase = self.phase(rainbow)
        medium = self._scene.add_medium(self._metres * rainbow.extinction * drops.extinction_factor, 1.0, phase)
        self._scene.set_medium_layer(medium, MediumLayer.RAINBOW)
        return medium

    def add_world(self, world: Any) -> int:
        """Fills the world with the rain of `OpalWorldProperties`; returns the medium's number. Errors as `add`."""
        settings = world.opal
        height = settings.scale_height
        if not height > 0.0:
            height = RAIN_HEIGHT / self._metres
            self._report.add(
                Named(world),
                f"Rain without a scale height would let no sun through: it is rendered with one of {RAIN_HEIGHT:g} m.",
                "Scale Height",
            )
        drops, phase = self.phase(settings.rainbow)
        extinction = self._metres * settings.rainbow.extinction
        self._regions.append(rain_places.Air(droplets.arcs(drops), extinction, settings.base_height))
        medium = self._scene.add_medium(
            extinction * drops.extinction_factor,
            1.0,
            phase,
            density=Density.HEIGHT,
            scale_height=height,
            base_height=settings.base_height,
        )
        self._scene.set_medium_layer(medium, MediumLayer.RAINBOW)
        return medium

    def phase(self, rainbow: Any) -> tuple[droplets.Drops, Any]:
        """The drops and their phase function; errors as `add`."""
        if sentence := refusal(rainbow):
            raise ValueError(sentence)
        drops = drops_of(rainbow, [float(np.arcsin(np.clip(sun[2], -1.0, 1.0))) for sun in self._suns()])

        def told(done: float) -> None:
            self._stage(f"Computing the rainbow's drops: {done:.0%}", done)

        store = rainbow_tables.store(lambda sentence: self._report.add("Rainbow", sentence))
        phase = droplets.phase(drops, rainbow.polarization, store, told)
        self.present = True
        return drops, phase

    def look(self, camera: Any) -> None:
        """Says in the report why the camera sees no bow, where there is rain and it cannot see one.

        Parameters
        ----------
        camera : opal_kernels.descriptions.Camera
        """
        if not self._regions:
            return
        strongest = max((light.power for light in self._lights if light.type == LightType.SUN), default=0.0)
        found = [(np.asarray(light.transform, float)[:3, 3], light.power) for light in self._lights if light.type != LightType.SUN]
        lamps = rain_places.lamps(found, self._regions, strongest)
        for sentence in sight.warnings(self._suns(), sight.View.of(camera), self._regions, lamps):
            self._report.add("Rainbow", sentence)
