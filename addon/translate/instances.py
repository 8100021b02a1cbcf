# SPDX-License-Identifier: GPL-3.0-or-later
"""What the evaluated depsgraph shows, grouped so that the tracer gets each mesh once and its copies as arrays.

Blender lists objects and instances alike as `object_instances`. Their matrices and random numbers are read for all at
once by `foreach_get`; the loop over instances looks only at which object and which mesh each one shows, and everything
else is read once a group. Copies with the same mesh, materials and visibility make one group; those of volume objects that keep their look at any
scale only where they are scaled alike.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..finiteness import misplaced_by
from ..identity import Named
from .voxels import density_by_scale, source_of

# Ray visibility of an object: property, OPAL_RAY_* bit.
_VISIBILITY = (
    ("visible_camera", 1),
    ("visible_diffuse", 2),
    ("visible_glossy", 4),
    ("visible_transmission", 8),
    ("visible_shadow", 16),
    ("visible_volume_scatter", 32),
)
SEEN_BY_CAMERA = 1
# Determinant below which a matrix cannot be inverted in single precision: a scale of 1e-10.
_SMALLEST_VOLUME = 1e-30


@dataclass
class Group:
    """Copies of one mesh that share materials and visibility.

    Attributes
    ----------
    mesh : bpy.types.Mesh or bpy.types.Volume
        Evaluated; valid until the depsgraph changes.
    grids : Source or None
        Voxels of a volume or of a smoke domain.
    rows : ndarray
        Numbers of the instances in the depsgraph's order.
    transforms : ndarray
        (count, 3, 4) float32, object to world.
    object_info : ndarray
        (count, 8) float32 as in `opal_instances_desc`.
    density : float
        What the coefficients of a volume are multiplied by.
    blurs : (bool, bool)
        Whether motion blur shows where they move, and where they are bent.
    motion : list of ndarray
        `transforms` at shutter open and close, where they were read.
    """

    name: str
    mesh: Any
    materials: tuple[Any, ...]
    visibility: int
    holdout: bool
    receiver_set: int
    rows: np.ndarray
    transforms: np.ndarray
    object_info: np.ndarray
    grids: Any = None
    density: float = 1.0
    blurs: tuple[bool, bool] = (True, True)
    motion: list[np.ndarray] = field(default_factory=list)


@dataclass
class Visible:
    """Everything that `collect` found."""

    groups: list[Group] = field(default_factory=list)
    problems: list[tuple[str, str]] = field(default_factory=list)  # object name, sentence
    changes: list[tuple[str, str]] = field(default_factory=list)  # the same of what is shown in another way


@dataclass
class _Look:
    """What is read once for all instances that show the same object and mesh."""

    key: tuple
    name: str
    mesh: Any
    materials: tuple[Any, ...]
    visibility: int
    holdout: bool
    receiver_set: int
    pass_index: float
    color: tuple[float, ...]
    random: float
    grids: Any = None
    thins_with_scale: bool = False
    blurs: tuple[bool, bool] = (True, True)


def collect(
    depsgraph: Any,
    on_light: Callable[[Any, np.ndarray], None] | None = None,
    receiver_set: Callable[[Any], int] = lambda _object: -1,
) -> Visible:
    """Groups what the depsgraph shows.

    Parameters
    ----------
    depsgraph : bpy.types.Depsgraph
    on_light : callable, optional
        Called with (object, 4 x 4 matrix) for each lamp; the object is only valid during the call.
    receiver_set : callable
        Number of an object's receiver set for light linking, or -1.

    Returns
    -------
    Visible
        Groups, and the names of objects that cannot be rendered with the reason.
    """
    visible = Visible()
    instances = depsgraph.object_instances
    matrices = read_matrices(depsgraph)
    random_ids = np.empty(len(matrices), np.int32)
    instances.foreach_get("random_id", random_ids)
    usable = np.isfinite(matrices).all(axis=(1, 2))
    usable[usable] = np.abs(np.linalg.det(matrices[usable, :3, :3].astype(np.float64))) > _SMALLEST_VOLUME

    context = _LayerContext(depsgraph, visible)
    shown = context.kinds()
    edited = _EditedMeshes()
    looks: list[_Look | None] = []
    look_of: dict[tuple, int] = {}
    look_rows = np.full(len(matrices), -1, np.int32)
    for row, instance in enumerate(instances):
        obj = instance.object
        kind = obj.type
        if kind == "LIGHT":
            if not np.isfinite(matrices[row]).all():
                visible.problems.append((Named(obj), f"the lamp is left out: its {misplaced_by(obj)} is not finite"))
            elif on_light is not None:
                on_light(obj, matrices[row])
            continue
        if kind not in {"MESH", "VOLUME"}:
            _note_unreadable(obj, kind, visible.problems)
            continue
        if kind not in shown:
            continue
        is_copy = instance.is_instance
        source = instance.instance_object if is_copy else obj
        parent = instance.parent if is_copy else None
        mesh = edited.of(source, obj.data) if kind == "MESH" else obj.data
        identity = (
            source.as_pointer() if source is not None else 0,
            mesh.as_pointer(),
            parent.as_pointer() if parent is not None else 0,
        )
        number = look_of.get(identity)
        if number is None:
            number = look_of[identity] = len(looks)
            looks.append(context.look(instance, obj, source, parent, mesh, receiver_set))
        look_rows[row] = number

    used = (look_rows >= 0) & usable
    _note_singular(look_rows, used, looks, visible.problems)
    _group(looks, look_rows, used, matrices, random_ids, visible)
    return visible


def read_matrices(depsgraph: Any) -> np.ndarray:
    """Object-to-world matrices of all instances in the depsgraph's order, (n, 4, 4) float32."""
    instances = depsgraph.object_instances
    flat = np.empty(len(instances) * 16, np.float32)
    instances.foreach_get("matrix_world", flat)
    return flat.reshape(-1, 4, 4).transpose(0, 2, 1)  # Blender stores columns


class _EditedMeshes:
    """Meshes in edit mode, whose arrays are empty: a copy of each with the edits so far.

    An object keeps one such copy, and asked again throws it away: so each is asked once.
    """

    def __init__(self) -> None:
        self._copies: dict[int, Any] = {}

    def of(self, source: Any, mesh: Any) -> Any:
        """The mesh itself, or its copy where it is in edit mode, be it through another object that shares it."""
        if source is None or not mesh.is_editmode:
            return mesh
        key = source.as_pointer()
        if key not in self._copies:
            self._copies[key] = source.to_mesh()
        return self._copies[key]


class _LayerContext:
    """The view layer's say in what is seen and what an object looks like."""

    def __init__(self, depsgraph: Any, visible: Visible) -> None:
        self.problems, self.changes = visible.problems, visible.changes
        self.layer, self.layer_eval = depsgraph.view_layer, depsgraph.view_layer_eval
        self.override = self.layer_eval.material_override

    def kinds(self) -> set[str]:
        """The kinds of object that the layer's filter lets through."""
        return {kind for kind, on in (("MESH", self.layer_eval.use_solid), ("VOLUME", self.layer_eval.use_volumes)) if on}

    def look(self, instance: Any, obj: Any, source: Any, parent: Any, mesh: Any, receiver_set: Callable[[Any], int]) -> _Look:
        visibility = _ray_visibility(obj)
        if parent is not None:
            visibility &= _ray_visibility(parent)
        original = (source if source is not None else obj).original
        owners = (original,) if parent is None else (original, parent.original)
        holdout = obj.is_holdout or any(owner.holdout_get(view_layer=self.layer) for owner in owners)
        # A holdout stays a hole, as in Cycles.
        if not holdout and any(owner.indirect_only_get(view_layer=self.layer) for owner in owners):
            visibility &= ~SEEN_BY_CAMERA
        materials = self._materials(obj, source, mesh)
        if not instance.is_instance and not instance.show_self:
            visibility = 0
        self._note_what_is_not_kept(obj, original)
        receivers = receiver_set(parent.original if parent is not None else original)
        grids = source_of(obj, lambda sentence: self.problems.append((Named(original), sentence)))
        blurs = tuple(map(min, _blurs(obj), _blurs(parent))) if parent is not None else _blurs(obj)
        key = (
            mesh.as_pointer(),
            tuple(m.as_pointer() if m else 0 for m in materials),
            visibility,
            holdout,
            receivers,
            grids.key if grids is not None else 0,
            blurs,
        )
        return _Look(
            key=key,
            name=Named(original),
            mesh=mesh,
            materials=materials,
            visibility=visibility,
            holdout=holdout,
            receiver_set=receivers,
            pass_index=float(obj.pass_index),
            color=tuple(obj.color),
            random=object_random(original.name),
            grids=grids,
            thins_with_scale=obj.type == "VOLUME" and mesh.render.space == "OBJECT",
            blurs=blurs,
        )

    def _note_what_is_not_kept(self, obj: Any, original: Any) -> None:
        if obj.is_shadow_catcher:
            self.changes.append((Named(original), "Opal has no shadow catchers: it is rendered as any other object"))
        linking = getattr(obj, "light_linking", None)
        if linking is not None and (linking.receiver_collection is not None or linking.blocker_collection is not None):
            self.changes.append((Named(original), "Opal links the light of lamps, not of meshes: where it glows it lights everything"))
        hair = (m.particle_system.settings for m in obj.modifiers if m.type == "PARTICLE_SYSTEM" and m.show_render)
        if any(settings.type == "HAIR" and settings.render_type == "PATH" for settings in hair):
            self.problems.append((Named(original), "hair of particles is not rendered"))

    def _materials(self, obj: Any, source: Any, mesh: Any) -> tuple[Any, ...]:
        slots = tuple(slot.material for slot in obj.material_slots)
        own = source is not None and source.data == mesh
        chosen = slots if own or not len(mesh.materials) else tuple(mesh.materials)
        if not own and len(slots) == len(mesh.materials):
            chosen = slots
        if self.override is not None:
            return (self.override,) * max(1, len(chosen))
        return chosen


def _ray_visibility(obj: Any) -> int:
    return sum(bit for name, bit in _VISIBILITY if getattr(obj, name))


def _blurs(obj: Any) -> tuple[bool, bool]:
    """Whether an object is blurred where it moves, and where it is bent: Cycles' settings, where Cycles is enabled."""
    settings = getattr(obj, "cycles", None)
    moves = getattr(settings, "use_motion_blur", True)
    return moves, moves and getattr(settings, "use_deform_motion", True)


_UNREADABLE = {
    "CURVES": "hair curves are not rendered",
    "POINTCLOUD": "point clouds are not rendered",
    "GREASEPENCIL": "Grease Pencil is not rendered",
}


def _note_unreadable(obj: Any, kind: str, problems: list[tuple[str, str]]) -> None:
    if (sentence := _UNREADABLE.get(kind)) and (obj.name, sentence) not in problems:
        problems.append((Named(obj), sentence))


def _note_singular(look_rows: np.ndarray, used: np.ndarray, looks: list[_Look], problems: list[tuple[str, str]]) -> None:
    skipped = look_rows[(look_rows >= 0) & ~used]
    for number, count in zip(*np.unique(skipped, return_counts=True), strict=True):
        copies = "" if count == 1 else f" ({count} copies)"
        problems.append((looks[number].name, f"is scaled to nothing or has a matrix that is not finite, and is left out{copies}"))


def _group(
    looks: list[_Look],
    look_rows: np.ndarray,
    used: np.ndarray,
    matrices: np.ndarray,
    random_ids: np.ndarray,
    visible: Visible,
) -> None:
    """Joins looks with the same key and sorts the instances by group, in the depsgraph's order within each."""
    first_with: dict[tuple, int] = {}
    group_of_look = np.array([first_with.setdefault(look.key, len(first_with)) for look in looks], np.int32)
    rows = np.flatnonzero(used)
    groups = group_of_look[look_rows[rows]] if len(rows) else np.empty(0, np.int32)
    order = np.argsort(groups, kind="stable")
    rows, groups = rows[order], groups[order]
    per_look = np.array([(look.random, look.pass_index, *look.color, 0.0, 0.0) for look in looks], np.float32).reshape(-1, 8)
    bounds = np.searchsorted(groups, np.arange(len(first_with) + 1))
    representatives = {group: looks[number] for number, group in reversed(list(enumerate(group_of_look)))}
    for group in range(len(first_with)):
        mine = rows[bounds[group] : bounds[group + 1]]
        look = representatives[group]
        if not len(mine) or not look.visibility:
            continue
        info = per_look[look_rows[mine]]
        copies = random_ids[mine] != 0
        info[copies, 0] = random_ids[mine][copies].view(np.uint32).astype(np.float64) / 0xFFFFFFFF
        densities = density_by_scale(matrices[mine]) if look.thins_with_scale else np.ones(len(mine))
        for density in np.unique(densities):
            alike = densities == density
            visible.groups.append(
                Group(
                    name=look.name,
                    mesh=look.mesh,
                    materials=look.materials,
                    visibility=look.visibility,
                    holdout=look.holdout,
                    receiver_set=look.receiver_set,
                    rows=mine[alike],
                    transforms=np.ascontiguousarray(matrices[mine[alike], :3]),
                    object_info=info[alike],
                    grids=look.grids,
                    density=float(density),
                    blurs=look.blurs,
                )
            )


def object_random(name: str) -> float:
    """The Object Info node's Random of an object that is no instance: 0 to 1, from its name, as in Cycles.

    The name's bytes are folded by ``h = 37 h + byte`` and mixed with 0 by the last round of Bob Jenkins' lookup3.
    """
    mask = 0xFFFFFFFF
    folded = 0
    for byte in name.encode():
        folded = (folded * 37 + (byte if byte < 128 else byte - 256)) & mask  # C's signed characters
    return _jenkins_final(folded, 0) / mask


def _jenkins_final(x: int, y: int) -> int:
    mask = 0xFFFFFFFF

    def rotated(value: int, bits: int) -> int:
        return ((value << bits) | (value >> (32 - bits))) & mask

    start = (0xDEADBEEF + (2 << 2) + 13) & mask
    a, b, c = (start + x) & mask, (start + y) & mask, start
    for bits, step in ((14, 0), (11, 1), (25, 2), (16, 0), (4, 1), (14, 2), (24, 0)):
        if step == 0:
            c = ((c ^ b) - rotated(b, bits)) & mask
        elif step == 1:
            a = ((a ^ c) - rotated(c, bits)) & mask
        else:
            b = ((b ^ a) - rotated(a, bits)) & mask
    return c
