# SPDX-License-Identifier: GPL-3.0-or-later
"""What node readers need from whoever builds the scene, and what they hand back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

import numpy as np

# What programs call the colour attribute that renders, as the empty name is the UV map that does; no attribute has this name.
RENDER_COLOR = "\0"


class Problem(NamedTuple):
    """Something that a node tree asks for and Opal does not give.

    Attributes
    ----------
    owner : str
        Name of the material, world, lamp or image (`identity.Named`).
    node : str
        Name of the node, or empty.
    message : str
        A sentence for the artist: what is not read, and what is shown instead.
    lost : bool
        Whether it is missing from the picture; what is not is only shown in another way.
    """

    owner: str
    node: str
    message: str
    lost: bool = False


class NodeContext(Protocol):
    """Numbers for what programs name: images and mesh attributes.

    Attributes
    ----------
    depsgraph
        Evaluated dependency graph of the render (its scene's camera gives the camera and window coordinates), or None.
    """

    depsgraph: Any

    def attribute_id(self, name: str) -> int:
        """The number by which programs read a mesh attribute. The empty name is the UV map that renders, `RENDER_COLOR` the colours that do."""

    def attribute_name(self, number: int) -> str:
        """The name that `attribute_id` gave this number."""

    def image_index(self, image: Any, image_user: Any) -> int:
        """The kernel scene's number of an image, at the image user's frame; -1 where it cannot be read."""

    def image_tiles(self, image: Any) -> list[tuple[int, int]]:
        """(UDIM number, kernel image number) of the tiles of a tiled image that could be read."""


@dataclass
class CompiledProgram:
    """A node tree as a register program (``kernels/include/opal_shader.h``) and what the tracer has to know of it.

    Attributes
    ----------
    code : ndarray
        int32 of shape (n_instructions, 16): operation, mode, first register written, 13 inputs.
    constants : ndarray
        float32 of shape (n_constants, 4): registers 0 .. n_constants - 1.
    n_registers : int
        Registers in all, constants included.
    emissive : bool
        It may emit light.
    caster : bool
        It has a lobe sharp enough to make caustics.
    transparent_shadow : bool
        Light may pass straight through it.
    problems : list of Problem
        What could not be read, each once.
    """

    code: np.ndarray
    constants: np.ndarray
    n_registers: int
    emissive: bool = False
    caster: bool = False
    transparent_shadow: bool = False
    problems: list[Problem] = field(default_factory=list)
