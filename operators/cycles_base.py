# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as Cycles has to render it under Opal's layers.

Gems are holes to the camera and black to every other ray, media take light away and scatter none, caustics are off: just what
the kernels' layers leave out (kernels/src/integrator/layers.h). The change is a second output for Cycles in each node tree and is
taken away again; the artist's nodes are not touched.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import bpy

_PREFIX = "Opal base "


@contextmanager
def replaced(scene: Any, dim_camera: bool) -> Iterator[None]:
    """While it lasts, materials and worlds of Opal's kinds are to Cycles what the base needs.

    Parameters
    ----------
    dim_camera : bool
        Media dim what the camera sees through them in the base; if not, the picture has to be multiplied by the transmittance.
    """
    from ..addon import units
    from ..addon.twins import trees

    metres = units.metres_per_unit(scene)
    made: list[_Added] = []
    try:
        for material in bpy.data.materials:
            opal = material.opal
            if opal.kind == "GEM":
                made.append(_add(material, trees.blocker()))
            elif opal.kind in {"MEDIUM", "RAINBOW"}:
                made.append(_add(material, trees.absorber(opal, camera_passes=not dim_camera, metres=metres)))
        world = scene.world
        if world is not None and world.opal.kind in {"MEDIUM", "RAINBOW"}:
            made.append(_add_to_world(world, trees.absorber(world.opal, world=True, camera_passes=not dim_camera, metres=metres)))
        yield
    finally:
        for added in made:
            added.remove()


@dataclass
class _Added:
    """Nodes that were added to a tree, and its outputs that were active before, by name."""

    tree: Any
    nodes: list[str]
    active: list[str]

    def remove(self) -> None:
        try:
            for name in self.nodes:
                if (node := self.tree.nodes.get(name)) is not None:
                    self.tree.nodes.remove(node)
            for name in self.active:
                if (node := self.tree.nodes.get(name)) is not None:
                    node.is_active_output = True
        except ReferenceError:
            pass  # its material was deleted meanwhile


def _add(owner: Any, plan: Any) -> _Added:
    if owner.node_tree is None:
        owner.use_nodes = True
    tree = owner.node_tree
    active = [node.name for node in tree.nodes if getattr(node, "is_active_output", False)]
    nodes = plan.apply(tree, _PREFIX)
    output = next(node for node in nodes if node.name == _PREFIX + "Output")
    output.target = "CYCLES"
    output.is_active_output = True
    return _Added(tree, [node.name for node in nodes], active)


def _add_to_world(world: Any, plan: Any) -> _Added:
    """The same; the background is the artist's."""
    if world.node_tree is None:
        world.use_nodes = True
    before = world.node_tree.get_output_node("CYCLES")
    added = _add(world, plan)
    if before is not None and before.inputs["Surface"].is_linked:
        added.tree.links.new(before.inputs["Surface"].links[0].from_socket, added.tree.nodes[_PREFIX + "Output"].inputs["Surface"])
    return added


_MOST_BOUNCES = 1024  # that Cycles takes


def settings(scene: Any) -> dict[str, Any]:
    """Settings of Cycles with which light is what Opal's is: no caustics, no clamping, as many bounces."""
    opal = scene.opal
    depth = min(_MOST_BOUNCES, opal.max_depth)
    # Opal's depth counts bounces off rough surfaces; gems, mirrors and media end by chance.
    endless = _MOST_BOUNCES if depth else 0
    return {
        "caustics_reflective": False,
        "caustics_refractive": False,
        "max_bounces": endless,
        "diffuse_bounces": depth,
        "glossy_bounces": endless,
        "transmission_bounces": endless,
        "volume_bounces": endless,
        "transparent_max_bounces": opal.transparent_depth,
        "sample_clamp_direct": 0.0,
        "sample_clamp_indirect": 0.0,
        "blur_glossy": 0.0,
        "light_sampling_threshold": 0.0,
        "use_fast_gi": False,
        "use_guiding": False,
        "film_exposure": opal.film_exposure,
        "pixel_filter_type": opal.pixel_filter,
        "filter_width": opal.filter_width,
        "use_denoising": False,
        "use_adaptive_sampling": False,
    }
