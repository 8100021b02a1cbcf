# SPDX-License-Identifier: GPL-3.0-or-later
"""Gems that a camera does not see because it starts to see behind them.

Stones are modelled at real size, and Blender's cameras start to see at 10 cm: a close picture of one shows what lies behind it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from opal_kernels.descriptions import Camera, CameraType

from .instances import SEEN_BY_CAMERA

if TYPE_CHECKING:
    from .scene_builder import Snapshot


def hidden_gems(camera: Camera, snapshot: Snapshot) -> list[str]:
    """Names of objects with gems that lie in the picture and wholly before the camera's clip start."""
    to_camera = np.linalg.inv(np.vstack([np.asarray(camera.transform, float).reshape(3, 4), (0, 0, 0, 1)]))[:3]
    hidden = []
    for group, key, has_gem in zip(snapshot.groups, snapshot.mesh_of_group, snapshot.has_gem, strict=True):
        arrays = snapshot.meshes[key]
        if not has_gem or arrays is None or not group.visibility & SEEN_BY_CAMERA:
            continue
        low, high = arrays.positions.min(axis=0), arrays.positions.max(axis=0)
        corners = np.array([[*np.where(np.array([i & 1, i & 2, i & 4]) > 0, high, low), 1.0] for i in range(8)])
        place = np.asarray(group.transforms, float)
        world = np.einsum("kij,cj->kci", place, corners)
        seen = world @ to_camera[:, :3].T + to_camera[:, 3]
        if _before_the_clip_start(camera, seen).any():
            hidden.append(group.name)
    return list(dict.fromkeys(hidden))


def _before_the_clip_start(camera: Camera, seen: np.ndarray) -> np.ndarray:
    """Which boxes (count, 8, 3), in the camera's space, lie wholly between it and its clip start, and in the frame."""
    depth = -seen[..., 2]
    hidden = (depth > 0).all(axis=1) & (depth < camera.clip_start).all(axis=1)
    left, right, bottom, top = camera.window
    with np.errstate(divide="ignore", invalid="ignore"):
        x, y = np.moveaxis(seen[..., :2] / depth[..., None] if camera.type == CameraType.PERSPECTIVE else seen[..., :2], -1, 0)
    return hidden & (x.max(axis=1) > left) & (x.min(axis=1) < right) & (y.max(axis=1) > bottom) & (y.min(axis=1) < top)


def sentence(hidden: list[str], clip_start: str) -> str:
    """What to tell the artist; `clip_start` is the length as Blender shows it."""
    others = "" if len(hidden) == 1 else f" and “{hidden[1]}”" if len(hidden) == 2 else f" and {len(hidden) - 1} other gems"
    verb = "lies" if len(hidden) == 1 else "lie"
    return f"“{hidden[0]}”{others} {verb} nearer to the camera than {clip_start}, where it starts to see: lower it"
