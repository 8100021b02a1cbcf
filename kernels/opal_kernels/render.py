# SPDX-License-Identifier: GPL-3.0-or-later
"""A progressive render of a committed scene: passes in, images out.

Passes are independent given (seed, pass): any subset, in any order, adds up to the same film. Another thread may cancel the
running pass or ask how far it is.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from . import binding
from .descriptions import PASS_CHANNELS, Pass, RenderSettings
from .film_sums import FilmSums
from .scene import Scene


class Render:
    """The film and the state of one render.

    Parameters
    ----------
    scene : Scene
        Committed; it has to outlive the render.
    settings : RenderSettings, optional
        Or its fields by name.

    Raises
    ------
    OpalError
        If a setting is out of range, the scene is not committed, or memory is short.

    Attributes
    ----------
    passes_done : int
        Passes in the film.
    numbers : list of int
        Which they are, in the order rendered.
    """

    def __init__(self, scene: Scene, settings: RenderSettings | None = None, **fields: Any) -> None:
        self._handle = 0
        self.passes_done = 0
        self.numbers: list[int] = []
        self.settings = settings if settings is not None else RenderSettings(**fields)
        self._scene = scene  # keeps it alive
        self._handle = binding.render_create(scene.handle, self.settings)

    @property
    def handle(self) -> int:
        """The kernels' handle.

        Raises
        ------
        OpalError
            If the render is closed.
        """
        if not self._handle:
            raise binding.OpalError("The render is closed.")
        return self._handle

    def close(self) -> None:
        """Frees the film; not while a pass runs. Closing twice is allowed."""
        handle, self._handle = self._handle, 0
        if handle:
            binding.render_destroy(handle)

    def __enter__(self) -> Render:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()

    @property
    def size(self) -> tuple[int, int]:
        """Height and width of the rendered region in pixels."""
        region = self.settings.region
        if region is None:
            return self.settings.height, self.settings.width
        return region[3] - region[1], region[2] - region[0]

    def run_pass(self, number: int) -> None:
        """Renders one pass and adds it to the film.

        Raises
        ------
        Cancelled
            If `cancel` was called meanwhile; the film then holds complete passes only.
        """
        binding.render_pass(self.handle, number)
        self.passes_done += 1
        self.numbers.append(number)

    def run(self, passes: int, each: Callable[[int], None] | None = None) -> Render:
        """Renders passes 0 .. ``passes`` - 1, calling ``each`` with the number of every finished one."""
        for number in range(passes):
            self.run_pass(number)
            if each is not None:
                each(number)
        return self

    def cancel(self) -> None:
        """Asks the running pass to stop; from any thread."""
        binding.render_cancel(self.handle)

    @property
    def progress(self) -> float:
        """Fraction of the running pass that is done."""
        return binding.render_progress(self.handle)

    def film(self, which: Pass | str = Pass.COMBINED) -> np.ndarray:
        """An image of what is rendered so far.

        Parameters
        ----------
        which : Pass or str
            A pass that the settings asked for, such as ``"COMBINED"`` (RGBA, premultiplied) or ``"DEPTH"``.

        Returns
        -------
        ndarray
            float32 of shape (height, width, channels), rows from the bottom up.
        """
        number = Pass[which] if isinstance(which, str) else Pass(which)
        channels = self.settings.spectral_bins if number is Pass.SPECTRAL else PASS_CHANNELS[number]
        return binding.film_read(self.handle, number, *self.size, channels)

    def sums(self) -> FilmSums:
        """What the film holds, exactly: to be saved, or merged with other passes of the same render."""
        kept = {Pass.COMBINED, *(Pass(p) for p in self.settings.passes)} - {Pass.NOISE}
        if not self.settings.spectral_bins:
            kept -= {Pass.SPECTRAL}
        channels = {Pass.SPECTRAL: self.settings.spectral_bins}
        return FilmSums(
            passes=tuple(self.numbers),
            depth_pass=binding.film_depth_pass(self.handle),
            sums={p: binding.film_read_sums(self.handle, p, *self.size, channels.get(p)) for p in sorted(kept)},
            squares=binding.film_read_sums(self.handle, Pass.NOISE, *self.size),
        )

    @property
    def noise(self) -> float:
        """Mean estimated error relative to brightness; negative before two passes."""
        return binding.film_noise(self.handle)

    @property
    def statistics(self) -> dict[str, Any]:
        """Rays, photons, seconds and bytes so far."""
        return binding.render_get_statistics(self.handle)
