# SPDX-License-Identifier: GPL-3.0-or-later
"""The kernel scene that a 3D view keeps, brought up to date with as little building as an edit allows.

    a material's settings or nodes      its program or its gem's tables are replaced: nothing is built but tables of lights
    an object moved                     its matrices: the top level of the acceleration structure, no mesh
    a lamp                              all lamps are handed over again: tables of lights
    the world's colour or picture       the world: tables of lights
    a camera                            nothing here: the view sets it

Whatever has another shape, another material in a slot, another medium, or is not understood builds the whole scene anew. What
is tagged but reads the same as before is left alone, and the running render with it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from opal_kernels.scene import Scene

from . import report, units
from .identity import key_of
from .nodes import has_volume
from .translate.instances import Group
from .translate.materials import NeedsRebuild, program_content
from .translate.scene_builder import SceneBuilder, Snapshot, world_of
from .translate.world import nodes_of
from .viewport_changes import Changes, changes_of

# Pixels across the world's importance map, at most: a finer one takes longer than it saves in a view.
_MAP_WIDTH = 512


def _nothing() -> None:
    pass


@dataclass
class _Kept:
    """What was handed over, to be compared with what is read later.

    Attributes
    ----------
    structure : tuple
        All that instances are made of but their matrices: as long as it is the same the meshes can stay.
    transforms : list of ndarray
        A group's matrices.
    first_instances : list of int
        The kernels' number of a group's first instance; -1 where it is left out.
    placed_inside : list of bool
        Whether a group is filled by nodes, which may ask where it stands.
    lights : list
        Lamps and their names.
    world : tuple
        See `_world_state`.
    """

    structure: tuple = ()
    transforms: list[np.ndarray] = field(default_factory=list)
    first_instances: list[int] = field(default_factory=list)
    placed_inside: list[bool] = field(default_factory=list)
    lights: list[Any] = field(default_factory=list)
    world: tuple = ()
    of: tuple = ()
    frame: int = 0


class SceneSync:
    """A kernel scene that follows a depsgraph. No Blender data outlives a call.

    Parameters
    ----------
    threads : int
        0 takes every core.

    Attributes
    ----------
    rebuilds : int
        How often everything was read.
    """

    def __init__(self, threads: int = 0) -> None:
        self._threads = threads
        self._builder: SceneBuilder | None = None
        self._kept = _Kept()
        self.rebuilds = 0

    @property
    def scene(self) -> Scene | None:
        """The committed scene; None where there is none, as after a failure."""
        return self._builder.scene if self._builder is not None else None

    def close(self) -> None:
        """Frees the scene; no render of it may be running."""
        builder, self._builder = self._builder, None
        self._kept = _Kept()
        if builder is not None:
            builder.scene.close()

    def update(self, depsgraph: Any, before_change: Callable[[], None] = _nothing, everything: bool = False) -> bool:
        """Reads what an edit has touched.

        Parameters
        ----------
        depsgraph : bpy.types.Depsgraph
        before_change : callable
            Called before the kernels' scene is touched for the first time: stops what renders it.
        everything : bool
            Whatever the depsgraph says, all of it is read.

        Returns
        -------
        bool
            Whether the picture is another.

        Raises
        ------
        OpalError, ValueError, MemoryError
            In one sentence; there is no scene then.
        """
        changes = changes_of(depsgraph)
        if everything or self._builder is None or changes.everything or _name_of(depsgraph) != self._kept.of:
            return self._rebuild(depsgraph, before_change)
        try:
            changed = self._update_in_place(depsgraph, changes, before_change)
        except NeedsRebuild:
            return self._rebuild(depsgraph, before_change)
        except BaseException:
            before_change()
            self.close()
            raise
        if changed:
            self._builder.scene.commit()
        return changed

    # ---- Everything ----

    def _rebuild(self, depsgraph: Any, before_change: Callable[[], None]) -> bool:
        before_change()
        self.close()
        builder = SceneBuilder(report.start(depsgraph.scene), self._threads, map_width=_MAP_WIDTH)
        try:
            snapshot = builder.read(depsgraph)
            kept = _Kept(
                structure=_structure(snapshot.groups, [key[0] for key in snapshot.mesh_of_group]),
                transforms=[group.transforms for group in snapshot.groups],
                placed_inside=[any(has_volume(m) for m in group.materials) for group in snapshot.groups],
                lights=snapshot.lights,
                world=_world_state(world_of(depsgraph), snapshot.world),
                of=_name_of(depsgraph),
                frame=depsgraph.scene_eval.frame_current,
            )
            builder.finish(snapshot)
        except BaseException:
            builder.scene.close()
            raise
        kept.first_instances = snapshot.first_instances
        builder.context.begin(None)
        self._builder, self._kept = builder, kept
        self.rebuilds += 1
        return True

    # ---- In place ----

    def _update_in_place(self, depsgraph: Any, changes: Changes, before_change: Callable[[], None]) -> bool:
        builder = self._builder
        builder.before_change(before_change)
        builder.context.begin(depsgraph)
        frame = depsgraph.scene_eval.frame_current
        other_frame, self._kept.frame = frame != self._kept.frame, frame
        if other_frame and builder.context.any_frames:
            raise NeedsRebuild
        needs = builder.context.mesh_needs()
        changed = self._update_materials(depsgraph, changes, other_frame or changes.all_materials, before_change)
        if builder.context.mesh_needs() != needs:
            raise NeedsRebuild  # the meshes have to bring more than they did
        if changes.world or changes.worlds or changes.trees or changes.moved or other_frame:
            changed |= self._update_world(depsgraph, changes, before_change)
        if changes.objects or changes.trees or other_frame:
            changed |= self._update_objects(depsgraph, before_change)
        builder.before_change(_nothing)
        builder.context.begin(None)
        return changed

    def _update_materials(self, depsgraph: Any, changes: Changes, all_of_them: bool, before_change: Callable[[], None]) -> bool:
        if not (changes.materials or changes.trees or changes.moved or all_of_them):
            return False
        changed = False
        for block in depsgraph.ids:
            if block.id_type != "MATERIAL":
                continue
            key = key_of(block)
            if all_of_them or key in changes.materials or _touches(block.original, changes):
                changed |= self._builder.materials.refresh(block, before_change)
        return changed

    def _update_world(self, depsgraph: Any, changes: Changes, before_change: Callable[[], None]) -> bool:
        world = world_of(depsgraph)
        described = self._builder.read_world(world)
        state = _world_state(world, described)
        if state == self._kept.world and not state[0]:
            return False
        if state[0] != self._kept.world[0] or (state[0] and (key_of(world) in changes.worlds or _touches(world.original, changes))):
            raise NeedsRebuild  # it is filled with a medium
        if state == self._kept.world:
            return False
        before_change()
        self._builder.scene.set_world(described)
        self._kept.world = state
        return True

    def _update_objects(self, depsgraph: Any, before_change: Callable[[], None]) -> bool:
        builder, kept = self._builder, self._kept
        now = Snapshot()
        visible = builder.read_objects(depsgraph, now)
        if _structure(visible.groups, [group.mesh.as_pointer() for group in visible.groups]) != kept.structure:
            raise NeedsRebuild
        changed = False
        if now.lights != kept.lights:
            if builder.rain.present:
                raise NeedsRebuild  # flattened drops look different under another sun
            before_change()
            builder.scene.clear_lights()
            builder.add_lights(now.lights)
            kept.lights = now.lights
            changed = True
        for number, (group, first) in enumerate(zip(visible.groups, kept.first_instances, strict=True)):
            if first < 0 or np.array_equal(group.transforms, kept.transforms[number]):
                continue
            if kept.placed_inside[number]:
                raise NeedsRebuild
            before_change()
            builder.scene.set_transforms(first, group.transforms)
            kept.transforms[number] = group.transforms
            changed = True
        return changed


def _name_of(depsgraph: Any) -> tuple:
    """Whose picture it is, and how long its units are: all that is measured by the metre depends on that."""
    return key_of(depsgraph.scene), depsgraph.view_layer.name, units.metres_per_unit(depsgraph.scene)


def _structure(groups: list[Group], meshes: list[int]) -> tuple:
    """See `_Kept`; `meshes` are the addresses of the groups' meshes, which stay while nothing tags their geometry."""
    return tuple(
        (
            group.name,
            mesh,
            tuple(key_of(m) for m in group.materials),
            group.visibility,
            group.holdout,
            group.receiver_set,
            group.grids.key if group.grids is not None else 0,
            group.rows.tobytes(),
            group.object_info.tobytes(),
            group.density,
        )
        for group, mesh in zip(groups, meshes, strict=True)
    )


def _touches(owner: Any, changes: Changes) -> bool:
    """Whether the node tree of a material or world, or a group in it, was changed, or asks where things stand and some moved."""
    tree = owner.node_tree
    if tree is None:
        return False
    if key_of(tree) in changes.trees:
        return True
    for node in nodes_of(tree):
        if changes.moved and node.type == "TEX_COORD":
            return True
        if (inner := getattr(node, "node_tree", None)) is not None and key_of(inner) in changes.trees:
            return True
    return False


def _world_state(world: Any, described: Any) -> tuple:
    """What fills a world (empty where nothing does), and its light."""
    if world is None:
        return (), ()
    kind, nodes = world.opal.kind, has_volume(world)
    filling = (key_of(world), kind, nodes) if kind != "NONE" or nodes else ()
    light = () if described is None else (*program_content(described.program), described.visibility, described.map_width)
    return filling, light
