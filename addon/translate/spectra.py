# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectra of a kernel scene, each content once. What nobody uses any more is overwritten by what comes next, so that a
slider pulled for an hour leaves no trail of tables."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from opal_kernels.scene import Scene


class Spectra:
    """Numbers of spectra by their values, counted by use.

    Parameters
    ----------
    scene : Scene
        Takes the tables.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._numbers: dict[bytes, int] = {}
        self._content: dict[int, bytes] = {}
        self._uses: dict[int, int] = {}
        self._free: list[int] = []
        self.before_change: Callable[[], None] = lambda: None  # called before the kernel scene takes something

    def take(self, values: Any) -> int:
        """The number of a table of 471 values; to be given back by `release` once for each time it was taken."""
        table = np.ascontiguousarray(values, np.float32)
        content = table.tobytes()
        number = self._numbers.get(content)
        if number is None:
            self.before_change()
            if self._free:
                number = self._free.pop()
                self._scene.set_spectrum(number, table)
            else:
                number = self._scene.add_spectrum(table)
            self._numbers[content], self._content[number] = number, content
        self._uses[number] = self._uses.get(number, 0) + 1
        return number

    def release(self, numbers: list[int]) -> None:
        """Gives back what `take` gave."""
        for number in numbers:
            self._uses[number] -= 1
            if not self._uses[number]:
                del self._uses[number], self._numbers[self._content.pop(number)]
                self._free.append(number)
