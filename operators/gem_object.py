# SPDX-License-Identifier: GPL-3.0-or-later
"""From a cut stone and a species to Blender's mesh and material."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import bpy

from ..addon import presets

if TYPE_CHECKING:
    from opal_kernels.cuts import Stone

CUSTOM = "CUSTOM"


# Width of a stone that nobody says otherwise of, m: a carat of diamond.
USUAL_WIDTH = 0.0065


def take_usual_width(operator: bpy.types.Operator, metres: float) -> None:
    """The width of a stone whose `size`, in units, was not set: the same whatever a unit is."""
    if not operator.properties.is_property_set("size"):
        operator.size = USUAL_WIDTH / metres


def mesh_from_stone(stone: Stone, name: str, smooth: Sequence[str] = (), metres: float = 1.0) -> bpy.types.Mesh:
    """A mesh of planar polygons, as they are cut.

    Parameters
    ----------
    stone : Stone
        In metres.
    name : str
        Of the mesh.
    smooth : sequence of str
        Names of facets that stand for a curved surface.
    metres : float
        Per unit (`units`), which the mesh is in.
    """
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata((stone.solid.vertices / metres).tolist(), [], [list(face) for face in stone.solid.faces])
    mesh.polygons.foreach_set("use_smooth", [facet in smooth for facet in stone.names])
    mesh.update()
    return mesh


def gem_material(species: str, index: float | None = None) -> bpy.types.Material:
    """The gem material of a species: one that is there and as new, or a new one.

    Parameters
    ----------
    species : str
        A name of `material.opal.gem.species`.
    index : float, optional
        With the species ``CUSTOM``: an index of refraction without dispersion.
    """
    name = label_of(species) if index is None else f"Gem {index:.3f}"
    known = [m for m in bpy.data.materials if m.name.split(".")[0] == name.split(".")[0] and m.opal.kind == "GEM"]
    material = bpy.data.materials.new(name)
    material.opal.kind = "GEM"
    material.opal.gem.species = species
    if index is not None:
        material.opal.gem.dispersion = "CAUCHY"
        material.opal.gem.cauchy_b = index
        material.opal.gem.cauchy_c = 0.0
    wanted = _settings(material)
    same = next((other for other in known if other.animation_data is None and _settings(other) == wanted), None)
    if same is None:
        return material
    bpy.data.materials.remove(material)
    return same


def _settings(material: bpy.types.Material) -> list[Any]:
    """All that an artist can have changed on a gem."""
    gem = material.opal.gem
    shown = [prop for prop in gem.bl_rna.properties if not prop.is_hidden and prop.type in {"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"}]
    values = [tuple(getattr(gem, p.identifier)) if getattr(p, "is_array", False) else getattr(gem, p.identifier) for p in shown]
    return [*values, material.opal.use_medium, presets.curve_of(gem)]


def label_of(species: str) -> str:
    """What people call a species."""
    if species == CUSTOM:
        return "Gem"
    from opal_kernels.optics.species import get

    return get(species).label


def weight(stone: Stone, species: str) -> str:
    """The stone's weight as a sentence's end, or its volume where the species has no density."""
    if species == CUSTOM:
        return f"{stone.solid.volume() * 1e9:.1f} mm³"
    from opal_kernels.optics.species import get

    return f"{stone.carats(1e3 * get(species).density):.2f} ct"
