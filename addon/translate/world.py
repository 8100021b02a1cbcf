# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender's world to the tracer's: a program for the radiance, and how finely it is sampled."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from opal_kernels.descriptions import Program, Ray, World

from ..identity import Named

SMALLEST_MAP, USUAL_MAP, LARGEST_MAP = 256, 1024, 2048  # pixels across


def visibility(world: Any) -> Ray:
    """The kinds of ray that see the world."""
    seen = getattr(world, "cycles_visibility", None)
    if seen is None:
        return Ray.ALL
    flags = (
        (seen.camera, Ray.CAMERA),
        (seen.diffuse, Ray.DIFFUSE),
        (seen.glossy, Ray.GLOSSY),
        (seen.transmission, Ray.TRANSMISSION),
        (seen.scatter, Ray.SCATTER),
    )
    return Ray(sum((ray for on, ray in flags if on), int(Ray.SHADOW)))


def nodes_of(tree: Any, seen: set[str] | None = None) -> Iterator[Any]:
    """Every node of a tree and of the groups in it, each group once."""
    seen = set() if seen is None else seen
    for node in tree.nodes:
        yield node
        inner = getattr(node, "node_tree", None)
        if inner is not None and inner.name_full not in seen:
            seen.add(inner.name_full)
            yield from nodes_of(inner, seen)


def map_width(world: Any) -> int:
    """Pixels across the importance map: of the finest picture in the world, as Cycles takes it, within limits."""
    settings = getattr(world, "cycles", None)
    if getattr(settings, "sampling_method", "AUTOMATIC") == "MANUAL":
        return max(4, settings.sample_map_resolution)
    if world.node_tree is None:
        return 0
    width = 0
    for node in nodes_of(world.node_tree):
        if node.type == "TEX_ENVIRONMENT" and node.image is not None:
            width = max(width, node.image.size[0], SMALLEST_MAP)
        elif node.type == "TEX_SKY":
            width = max(width, LARGEST_MAP if getattr(node, "sun_disc", False) else USUAL_MAP)
        elif node.type.startswith("TEX_") and node.type != "TEX_COORD":
            width = max(width, USUAL_MAP)
        elif node.type == "TEX_COORD":
            width = max(width, SMALLEST_MAP)
    return min(width, LARGEST_MAP) or SMALLEST_MAP


def add_world_medium(world: Any, scene: Any, context: Any, volumes: Any, report: Any) -> None:
    """Fills the world with what `world.opal` or the Volume socket of its node tree says.

    A medium that is the same to infinity lets no sun and no sky through, in Opal as in Cycles: the report says so, and lamps
    within it shine as ever.
    """
    from opal_kernels.descriptions import Density

    from ..nodes import Coefficient, compile_volume
    from .volumes import Body

    settings = world.opal
    body = Body(Named(world), box=((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)))
    if settings.kind == "MEDIUM":
        fields = {}
        if settings.scale_height > 0.0:
            fields = {"density": Density.HEIGHT, "scale_height": settings.scale_height, "base_height": settings.base_height}
            if settings.medium.density != "HOMOGENEOUS":
                report.add(
                    Named(world), "A world's medium thins with height or varies by noise, not both; it thins with height.", "Density"
                )
        medium = volumes.add_medium(settings.medium, body, **fields)
        endless = settings.scale_height == 0.0 and settings.medium.extinction > 0.0
    else:
        compiled = compile_volume(world, context)
        if compiled is None:
            return
        context.note(compiled.problems)
        if any(c.program is not None for c in compiled.coefficients):
            report.add(
                Named(world),
                "The world's volume is the same everywhere in Opal; what varies from place to place is left out.",
                "Volume",
                lost=True,
            )
            compiled.scattering = [lobe for lobe in compiled.scattering if lobe.coefficient.program is None]
            for kind in ("absorption", "emission"):
                if getattr(compiled, kind).program is not None:
                    setattr(compiled, kind, Coefficient())
        medium = volumes.add_compiled(compiled, body)
        endless = bool(compiled.scattering) or compiled.absorption.present
    if medium < 0:
        return
    scene.set_world_medium(medium)
    if endless:
        report.add(
            Named(world),
            "The medium has no end, so neither the sun nor the sky shines through it; give it a scale height, or put it in a closed mesh.",
            "Scale Height",
        )


def world_from_scene(world: Any, context: Any) -> tuple[World | None, list[Any]]:
    """The world as the tracer takes it.

    Parameters
    ----------
    world : bpy.types.World or None
        Evaluated world.
    context
        Handed to the node readers.

    Returns
    -------
    World or None
        None is black.
    list of Problem
        What the node readers could not keep.
    """
    if world is None:
        return None, []
    from ..nodes import compile_world  # the node readers are only loaded for a render

    compiled = compile_world(world, context)
    program = Program(compiled.code, compiled.constants, compiled.n_registers)
    return World(program=program, visibility=int(visibility(world)), map_width=map_width(world)), list(compiled.problems)
