# SPDX-License-Identifier: GPL-3.0-or-later
"""What the observer of a gem report sees, rendered: the stone face-up under the bright hemisphere, and its flashes of fire."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

from .. import programs
from ..descriptions import CameraType, Light, LightType, World
from ..render import Render
from ..scene import Scene
from .measures import HEAD_ANGLE, Cancelled
from .stone import FacetedStone

Progress = Callable[[float], bool]

# Radius of the picture in units of the stone's reach.
_FRAME = 1.05
# Small lamps that make fire: so many, of so many degrees across, spread evenly over the hemisphere outside of the head.
_LAMPS, _LAMP_ANGLE = 150, math.radians(2.5)


@contextmanager
def _seen_from_above(stone: FacetedStone) -> Iterator[Scene]:
    """A scene of the stone alone, at unit size, with a camera that looks straight down; not yet committed."""
    size = stone.reach
    with Scene() as scene:
        absorption = None if stone.absorption is None else np.asarray(stone.absorption) * size
        mesh = scene.add_mesh((stone.vertices - stone.centre) / size, stone.triangles)
        scene.add_instances(mesh, [np.eye(4)], [scene.add_gem(stone.index, absorption)])
        above = np.eye(4)[:3]
        above[2, 3] = 3.0
        scene.set_camera(type=CameraType.ORTHOGRAPHIC, transform=above, window=(-_FRAME, _FRAME, -_FRAME, _FRAME))
        yield scene


def _render(scene: Scene, size: int, passes: int, progress: Progress | None) -> np.ndarray:
    scene.commit()
    with Render(
        scene, width=size, height=size, samples_per_pass=8, photons_per_pass=0, max_depth=64, transparent_film=1, filter_width=1.5
    ) as render:
        for number in range(passes):
            if progress is not None and not progress(number / passes):
                raise Cancelled
            render.run_pass(number)
        return render.film("COMBINED").astype(np.float32)


def face_up(
    stone: FacetedStone, size: int = 256, passes: int = 8, head: float = HEAD_ANGLE, progress: Progress | None = None
) -> np.ndarray:
    """The stone under a white hemisphere with the head's shadow.

    Parameters
    ----------
    size : int
        Pixels across.
    passes : int
        Of 8 samples a pixel.
    head : float
        Half of the cone that the observer's head takes, radians.
    progress : callable, optional
        Told the part done; returns False to stop.

    Returns
    -------
    ndarray
        (size, size, 4) linear Rec.709 and alpha, rows from the bottom up; the hemisphere's white is 1.
    """
    with _seen_from_above(stone) as scene:
        scene.set_world(World(programs.hemisphere(head), map_width=128))
        return _render(scene, size, passes, progress)


def flashes(
    stone: FacetedStone, size: int = 256, passes: int = 8, head: float = HEAD_ANGLE, progress: Progress | None = None
) -> np.ndarray:
    """The stone under many small lamps in the dark, as `face_up`: what it throws back is its fire.

    A lamp's disc has the radiance that a mirror's picture of it would show as 4.
    """
    golden = math.pi * (3 - math.sqrt(5))
    with _seen_from_above(stone) as scene:
        for i in range(_LAMPS):
            cosine = math.cos(head) * (1 - (i + 0.5) / _LAMPS)
            sine, turn = math.sqrt(1 - cosine**2), i * golden
            scene.add_light(
                Light(
                    type=LightType.SUN,
                    power=4.0 * math.pi * math.sin(0.5 * _LAMP_ANGLE) ** 2,
                    radius=0.5 * _LAMP_ANGLE,
                    transform=_looking(np.array([-sine * math.cos(turn), -sine * math.sin(turn), -cosine])),
                )
            )
        return _render(scene, size, passes, progress)


def _looking(direction: np.ndarray) -> np.ndarray:
    """A (3, 4) pose whose -z runs along a direction."""
    z = -direction
    x = np.cross((0.0, 1.0, 0.0) if abs(z[1]) < 0.9 else (1.0, 0.0, 0.0), z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z, np.zeros(3)])
