# SPDX-License-Identifier: GPL-3.0-or-later
"""Films handed to whoever asked for them: a final render as Blender runs it, and its passes as arrays.

An operator that composites or compares needs what the film holds, layers included, of a render with everything that belongs to
one: render visibility, motion blur, view layers, the person's Escape. It opens a `Capture`, lets Blender render, and finds the
films in it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from opal_kernels.descriptions import Pass


@dataclass
class Capture:
    """What to keep of the renders to come, and what they gave.

    Attributes
    ----------
    passes : sequence of Pass
        Kept beside Combined and what view layers ask for.
    films : dict of str to dict of Pass to ndarray
        By view layer: (height, width, channels) float32, rows from the bottom up.
    statistics : dict of str to dict
        By view layer, as `opal_kernels.render.Render.statistics` gives them.
    failure : str
        Why a layer could not be rendered.
    done : float
        Part of the present layer's render that is done.
    """

    passes: Sequence[Pass]
    films: dict[str, dict[Pass, np.ndarray]] = field(default_factory=dict)
    statistics: dict[str, dict[str, Any]] = field(default_factory=dict)
    passes_done: dict[str, int] = field(default_factory=dict)
    failure: str = ""
    stopped: bool = False
    done: float = 0.0

    def take(self, layer: str, render: Any) -> None:
        """Keeps the films of a view layer's finished render."""
        self.films[layer] = {number: render.film(number) for number in {Pass.COMBINED, *self.passes}}
        self.statistics[layer] = render.statistics
        self.passes_done[layer] = render.passes_done


_current: Capture | None = None


def current() -> Capture | None:
    """The capture that is open, if any."""
    return _current


@contextmanager
def capturing(passes: Sequence[Pass] = ()) -> Iterator[Capture]:
    """Opens a capture for the renders within."""
    global _current
    before, _current = _current, Capture(tuple(passes))
    try:
        yield _current
    finally:
        _current = before
