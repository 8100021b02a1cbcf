# SPDX-License-Identifier: GPL-3.0-or-later
"""What node readers may ask for while they compile: numbers for images and attributes, the camera, a place for problems.

Implements the protocol of `addon/nodes/context.py` on a kernel scene, and remembers what the compiled programs will read
from meshes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from opal_kernels.scene import Scene

from ..nodes.images import Images
from ..report import Report
from .meshes import MeshNeeds

# Operations of opal_shader.h that read from the mesh more than its shape.
_OP_COORDINATE, _COORDINATE_GENERATED = 40, 0
_OP_NORMAL_MAP, _NORMAL_TANGENT, _NORMAL_MAP_UV = 47, 0, 2
_OP_TANGENT, _TANGENT_RADIAL, _TANGENT_UV = 49, 2, 3
_FIRST_OPERAND = 3  # column of an instruction: op, mode, out, operands


class NodeContext:
    """Numbers for what programs name.

    Parameters
    ----------
    scene : Scene
        Takes images.
    report : Report
        Told what the node readers could not keep.
    """

    def __init__(self, scene: Scene, report: Report) -> None:
        self._report = report
        self._scene = scene
        self._images = Images(self._add_image, lambda problem: self.note([problem]))
        self._attributes: dict[str, int] = {}
        self._tangent_uv: str | None = None
        self._generated = False
        self.depsgraph: Any = None
        self.before_change: Callable[[], None] = lambda: None  # called before the kernel scene takes something

    def begin(self, depsgraph: Any) -> None:
        """Sets the depsgraph that materials are read from."""
        self.depsgraph = depsgraph

    def attribute_id(self, name: str) -> int:
        """The number of an attribute; an empty name is the UV map that renders."""
        return self._attributes.setdefault(name, len(self._attributes))

    def attribute_name(self, number: int) -> str:
        """The name of an attribute by its number."""
        return next(name for name, known in self._attributes.items() if known == number)

    def image_index(self, image: Any, image_user: Any) -> int:
        """The number of an image; -1 where it cannot be read."""
        frame = self.depsgraph.scene_eval.frame_current if self.depsgraph is not None else 1
        return self._images.index(image, image_user, frame)

    def _add_image(self, pixels: np.ndarray, transfer: int) -> int:
        self.before_change()
        return self._scene.add_image(pixels, transfer)

    @property
    def any_frames(self) -> bool:
        """Whether an image shows another picture at another frame."""
        return self._images.any_frames

    def image_tiles(self, image: Any) -> list[tuple[int, int]]:
        """(UDIM number, image number) of a tiled image's readable tiles."""
        return self._images.tiles(image)

    def note(self, problems: Iterable[Any]) -> None:
        """Puts what a node reader could not keep into the report."""
        for problem in problems:
            self._report.add(problem.owner, problem.message, f"node “{problem.node}”" if problem.node else "", problem.lost)

    def program_compiled(self, code: np.ndarray) -> None:
        """Remembers what a program reads from meshes."""
        op, mode = code[:, 0], code[:, 1]
        radial = (op == _OP_TANGENT) & (mode == _TANGENT_RADIAL)
        generated = (op == _OP_COORDINATE) & (mode == _COORDINATE_GENERATED)
        self._generated |= bool((radial | generated).any())
        normal_maps = code[(op == _OP_NORMAL_MAP) & (mode == _NORMAL_TANGENT)][:, _FIRST_OPERAND + _NORMAL_MAP_UV]
        tangents = code[(op == _OP_TANGENT) & (mode == _TANGENT_UV)][:, _FIRST_OPERAND]
        for number in (*normal_maps.tolist(), *tangents.tolist()):
            name = next((n for n, i in self._attributes.items() if i == number), "")
            if self._tangent_uv is None:
                self._tangent_uv = name
            elif self._tangent_uv != name:
                self._report.add("", f"Normal maps use several UV maps; all take their tangents from “{self._tangent_uv}”")

    def mesh_needs(self) -> MeshNeeds:
        """What meshes have to bring for the programs compiled so far."""
        return MeshNeeds(dict(self._attributes), self._tangent_uv, self._generated)
