# SPDX-License-Identifier: GPL-3.0-or-later
"""An evaluated depsgraph as a committed kernel scene.

Everything Blender owns is read first (a change of frame makes it invalid), in the middle of the shutter, then, where there is
motion blur, what moves at its opening and at its close; only then does the kernels' scene get its meshes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np
from opal_kernels.descriptions import Attribute, Camera, Light, World
from opal_kernels.mesh_bodies import NO_GEM
from opal_kernels.scene import Scene

from .. import units
from ..identity import Named, key_of
from ..report import Report
from .gem_meshes import mend_gem_mesh
from .instances import Group, Visible, collect
from .lights import LightLinks, light_from_object, out_of_range
from .materials import Materials, bounds_a_medium, fills
from .meshes import MeshArrays, MeshNeeds, box_mesh, box_of, is_closed, read_mesh
from .node_context import NodeContext
from .rainbow import Rain
from .spectra import Spectra
from .volumes import Body
from .world import add_world_medium, world_from_scene

_WORKING_SPACE = "Linear Rec.709"

# The address that a mesh had, and which of its slots are gems and media (`_same_materials`): objects of one mesh that are filled by
# slots of their own have its faces turned each as it needs.
MeshKey = tuple[int, tuple[int, ...], tuple[int, ...]]


@dataclass
class Snapshot:
    """What was read from Blender at one time, without references into it."""

    groups: list[Group] = field(default_factory=list)
    materials: list[list[int]] = field(default_factory=list)  # kernel numbers, a list a group
    meshes: dict[MeshKey, MeshArrays | None] = field(default_factory=dict)
    mesh_of_group: list[MeshKey] = field(default_factory=list)
    has_gem: list[bool] = field(default_factory=list)  # whether any of a group's materials is a gem
    lights: list[tuple[Light, str]] = field(default_factory=list)
    bodies: list[Body | None] = field(default_factory=list)  # what a group's materials fill
    world: World | None = None
    first_instances: list[int] = field(default_factory=list)  # the kernels' number of each group's first, -1: left out


def _ignore_stage(_text: str, _done: float = 0.0) -> None:
    pass


def _at_once(read: Callable[[], Any], _depsgraph: Any) -> Any:
    return read()


def _here(work: Callable[[], None], _cancel: Callable[[], None]) -> None:
    work()


class SceneBuilder:
    """Builds a kernel scene from a depsgraph.

    Parameters
    ----------
    report : Report
        Told what could not be kept.
    threads : int
        0 takes every core.
    stage : callable
        Called with a few words before each step, and with the fraction done in long ones; may raise `stopping.Stopped`.
    preview : bool
        It is one of Blender's previews of a material (`units.of_preview`).
    map_width : int, optional
        Pixels across the world's importance map, at most; it says where samples go, not how bright anything is.
    undisturbed : callable
        Calls its first argument, which reads original data-blocks through the depsgraph that is the second.
    aside : callable
        Calls its first argument, which builds the kernels' scene and touches nothing of Blender's; its second makes the first stop.
    """

    def __init__(
        self,
        report: Report,
        threads: int = 0,
        stage: Callable[..., None] = _ignore_stage,
        preview: bool = False,
        map_width: int | None = None,
        undisturbed: Callable[[Callable[[], Any], Any], Any] = _at_once,
        aside: Callable[[Callable[[], None], Callable[[], None]], None] = _here,
    ) -> None:
        self._report, self._stage, self._undisturbed, self._aside = report, stage, undisturbed, aside
        self._stopping, self._reading = False, ""
        self._map_width, self._preview = map_width, preview
        self.scene = Scene(threads=threads)
        self.spectra = Spectra(self.scene)
        self._lamp_spectra: list[int] = []
        self.context = NodeContext(self.scene, report)
        self.rain = Rain(self.scene, report, stage)
        self.materials = Materials(self.scene, self.context, report, self.rain, self.spectra)

    def read(self, depsgraph: Any) -> Snapshot:
        """Reads everything that is seen: instances, lamps, world, materials and meshes."""
        self._stage("Reading objects")
        snapshot = Snapshot()
        visible = self._undisturbed(lambda: self._read_blocks(depsgraph, snapshot), depsgraph)
        needs = self.context.mesh_needs()
        for count, group in enumerate(visible.groups):
            self._reading = f"Reading meshes, {count + 1} of {len(visible.groups)}"
            self._stage(self._reading)
            snapshot.mesh_of_group.append(self._read_mesh(group, needs, snapshot, snapshot.bodies[count]))
        snapshot.groups = visible.groups
        return snapshot

    def _read_blocks(self, depsgraph: Any, snapshot: Snapshot) -> Visible:
        """Everything but the meshes, which belong to the depsgraph; names lead to originals."""
        visible = self.read_objects(depsgraph, snapshot)
        self._stage("Reading materials")
        lengths = units.of_preview() if self._preview else units.of_scene(depsgraph.scene)
        self.materials.begin(lengths)
        self.rain.begin([light for light, _ in snapshot.lights], lengths.media)
        world = world_of(depsgraph)
        snapshot.world = self.read_world(world)
        if snapshot.world is not None:
            self.scene.set_world(snapshot.world)
        self._fill_world(world)
        for group in visible.groups:
            body = self._body(group)
            snapshot.materials.append(
                [self.materials.number(m, body if fills(m) or group.grids is not None else None) for m in group.materials or (None,)]
            )
            snapshot.bodies.append(body)
            if body is not None and body.closed and body.box is not None:
                self.rain.stands(group.materials, body.box, group.transforms)
            snapshot.has_gem.append(any(m is not None and m.opal.kind == "GEM" for m in group.materials))

        for name, sentence in visible.problems:  # grids have been read by now
            self._report.add(name, sentence, lost=True)
        for name, sentence in visible.changes:
            self._report.add(name, sentence)
        self._note_working_space()
        return visible

    def _note_working_space(self) -> None:
        """Says so where the file's numbers of colours are not of Rec.709, which a file may choose since Blender 5."""
        space = getattr(getattr(bpy.data, "colorspace", None), "working_space", _WORKING_SPACE)
        if space != _WORKING_SPACE:
            self._report.add(
                "",
                f"the file works in {space}, and Opal in {_WORKING_SPACE}: images, and what spectra colour, such as stones and bows, are "
                "shown too saturated",
                "Working Space",
            )

    def before_change(self, call: Callable[[], None]) -> None:
        """Sets what reading once more calls before it adds an image or a spectrum to the kernels' scene."""
        self.context.before_change = self.spectra.before_change = call

    def read_objects(self, depsgraph: Any, snapshot: Snapshot) -> Visible:
        """Finds what is seen, and reads the lamps into the snapshot."""
        self.context.begin(depsgraph)
        # Not `depsgraph.objects`, which lacks what is only there as an instance.
        lamps = (block for block in depsgraph.ids if block.id_type == "OBJECT" and block.type == "LIGHT")
        links = LightLinks(lamps, self._report.add)
        originals: list[Any] = []
        before = self._lamp_spectra
        self._lamp_spectra = []

        def take_spectrum(values: np.ndarray) -> int:
            self._lamp_spectra.append(self.spectra.take(values))
            return self._lamp_spectra[-1]

        def on_light(obj: Any, matrix: np.ndarray) -> None:
            light = light_from_object(obj, matrix=matrix, context=self.context, report=self._report.add, add_spectrum=take_spectrum)
            if sentence := out_of_range(obj.data, *depsgraph.scene_eval.opal.wavelengths):
                self._report.add(Named(obj), sentence, "Spectrum", lost=True)
            if light is not None:
                snapshot.lights.append((light, Named(obj)))
                originals.append(obj.original)

        visible = collect(depsgraph, on_light, links.group)
        for (light, _), lamp in zip(snapshot.lights, originals, strict=True):
            light.receivers = links.receivers(lamp)
        self.spectra.release(before)
        return visible

    def read_world(self, world: Any) -> World | None:
        """The light from infinity."""
        result, problems = world_from_scene(world, self.context)
        self.context.note(problems)
        if result is not None and self._map_width is not None:
            result.map_width = min(result.map_width, self._map_width)
        return result

    def _body(self, group: Group) -> Body | None:
        """What a group's materials fill, where any of them fills; `None` for surfaces alone."""
        mesh, transform = group.mesh, group.transforms[0]
        if not hasattr(mesh, "polygons"):
            key = (mesh.as_pointer(), group.density)
            return Body(group.name, group.grids, None, transform, key, is_volume=True, density=group.density)
        if not any(fills(m) for m in group.materials):
            return None
        box = box_of(mesh) if len(mesh.vertices) else (np.zeros(3), np.zeros(3))
        return Body(group.name, group.grids, box, transform, mesh.as_pointer(), closed=is_closed(mesh))

    def _fill_world(self, world: Any) -> None:
        if world is None:
            return
        if world.opal.kind != "RAINBOW":
            add_world_medium(world, self.scene, self.context, self.materials.volumes, self._report)
            return
        try:
            self.scene.set_world_medium(self.rain.add_world(world))
        except ValueError as error:
            self._report.add(Named(world), f"{str(error).rstrip('.')}; the world is rendered empty.", lost=True)

    def _read_mesh(self, group: Group, needs: MeshNeeds, snapshot: Snapshot, body: Body | None) -> MeshKey:
        gems = _same_materials(group, lambda m: m.opal.kind == "GEM")
        media = _same_materials(group, bounds_a_medium) if body is not None and body.closed else ()
        key = group.mesh.as_pointer(), gems, media
        if body is not None and body.is_volume:
            box = body.bounds()
            if snapshot.meshes.get(key) is None:
                snapshot.meshes[key] = box_mesh(*box) if box is not None else None
        elif key not in snapshot.meshes:
            arrays = snapshot.meshes[key] = read_mesh(group.mesh, needs, lambda: self._stage(self._reading))
            for sentence in arrays.problems if arrays is not None else ():
                self._report.add(group.name, sentence, lost=True)
            if arrays is not None:
                self._mend(arrays, group, "gem", gems)
                self._mend(arrays, group, "medium", media)
        group.mesh = None
        return key

    def _mend(self, arrays: MeshArrays, group: Group, what: str, bodies: tuple[int, ...]) -> None:
        """Turns the faces of the group's gems or media outwards where they look inwards, and says so."""
        if bodies:
            for sentence in mend_gem_mesh(arrays, bodies, what):
                self._report.add(group.name, sentence)

    def read_motion(self, depsgraph: Any, snapshot: Snapshot) -> None:
        """Reads once more what moves or deforms, at the opening of the shutter, then at its close.

        What cannot be matched is as in the middle.
        """
        self._stage("Reading motion")
        visible = self._undisturbed(lambda: collect(depsgraph), depsgraph)
        by_rows = {(group.name, len(group.rows), int(group.rows[0])): group for group in visible.groups}
        deformed: dict[MeshKey, np.ndarray] = {}
        for group, key in zip(snapshot.groups, snapshot.mesh_of_group, strict=True):
            then = by_rows.get((group.name, len(group.rows), int(group.rows[0])))
            if then is None or not np.array_equal(then.rows, group.rows):
                group.motion.append(group.transforms)
                continue
            moves, bends = group.blurs
            group.motion.append(then.transforms if moves else group.transforms)
            arrays = snapshot.meshes[key]
            if arrays is None or not bends or key in deformed or not hasattr(then.mesh, "vertices"):
                continue
            positions = read_positions(then.mesh)
            if positions.shape == arrays.positions.shape and not np.array_equal(positions, arrays.positions):
                deformed[key] = positions
        for key, arrays in snapshot.meshes.items():
            if arrays is not None:
                arrays.motion.append(deformed.get(key, arrays.positions))

    def finish(self, snapshot: Snapshot, camera: Camera | None = None) -> Scene:
        """Hands everything to the kernels and commits."""
        self._stage("Building the scene")
        self._aside(lambda: self._build(snapshot, camera), self._stop_building)
        return self.scene

    def _stop_building(self) -> None:
        self._stopping = True
        self.scene.cancel()

    def _build(self, snapshot: Snapshot, camera: Camera | None) -> None:
        numbers: dict[MeshKey, int] = {}
        for group, materials, key in zip(snapshot.groups, snapshot.materials, snapshot.mesh_of_group, strict=True):
            arrays = snapshot.meshes[key]
            if self._stopping:
                break
            if arrays is None:
                snapshot.first_instances.append(-1)
                continue
            if key not in numbers:
                numbers[key] = self._add_mesh(arrays, group.name)
            start, end = group.motion or (None, None)
            first = self.scene.add_instances(
                numbers[key],
                group.transforms,
                materials,
                transforms_start=start,
                transforms_end=end,
                visibility=group.visibility,
                object_info=group.object_info,
                holdout=group.holdout,
                light_group=group.receiver_set,
            )
            snapshot.first_instances.append(first)
        self.add_lights(snapshot.lights)
        if camera is not None:
            self.scene.set_camera(camera)
        self.scene.commit()

    def _add_mesh(self, arrays: MeshArrays, name: str) -> int:
        from opal_kernels import binding

        deforms = any(positions is not arrays.positions for positions in arrays.motion)
        start, end = arrays.motion if deforms else (None, None)
        number, dropped = binding.scene_add_mesh(
            self.scene.handle,
            arrays.positions,
            arrays.triangles,
            positions_start=start,
            positions_end=end,
            corner_normals=arrays.corner_normals,
            corner_tangents=arrays.corner_tangents,
            material_slots=arrays.material_slots,
            generated=arrays.generated,
            attributes=[Attribute(*attribute) for attribute in arrays.attributes],
        )
        if dropped:
            self._report.add(name, f"{dropped} triangles have corners that are not finite and are left out", lost=True)
        return number

    def add_lights(self, lights: Iterable[tuple[Light, str]]) -> None:
        """Hands lamps to the kernels."""
        from opal_kernels import binding

        for light, name in lights:
            try:
                self.scene.add_light(light)
            except binding.OpalError as error:
                self._report.add(name, f"the lamp is left out: {error}", lost=True)


def _same_materials(group: Group, is_one: Callable[[Any], bool]) -> tuple[int, ...]:
    """For each slot the first of the same material where it is one, `NO_GEM` elsewhere; empty where none is."""
    mine = [key_of(m) if m is not None and is_one(m) else None for m in group.materials]
    return tuple(NO_GEM if one is None else mine.index(one) for one in mine) if any(one is not None for one in mine) else ()


def world_of(depsgraph: Any) -> Any:
    """The evaluated world that a view layer shows, or None where it has none or the layer's filter leaves it out."""
    if not depsgraph.view_layer_eval.use_sky:
        return None
    override = getattr(depsgraph.view_layer_eval, "world_override", None)  # since Blender 5
    return override or depsgraph.scene_eval.world


def read_positions(mesh: Any) -> np.ndarray:
    """Vertices of an evaluated mesh, (n, 3) float32."""
    flat = np.empty(len(mesh.vertices) * 3, np.float32)
    if len(flat):
        mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat.reshape(-1, 3)
