# SPDX-License-Identifier: GPL-3.0-or-later
"""Add › Mesh › Gem: a stone of a cut and a species, at real size, from its proportions."""

import math
from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty
from bpy_extras.object_utils import AddObjectHelper, object_data_add

from ..addon import units
from ..addon.presets import species_items
from . import gem_object

# Blender keeps the strings of a dynamic enumeration by reference only: they have to live here.
_items: list[tuple[str, str, str, int]] = []


def cut_items(_owner: Any = None, _context: Any = None) -> list[tuple[str, str, str, int]]:
    """Items of the cuts, read from the kernels when a menu first asks."""
    if not _items:
        from opal_kernels.cuts import CUTS

        _items.extend((name, cut.label, cut.description, number) for number, (name, cut) in enumerate(CUTS.items()))
    return _items


def _take_usual_proportions(self: Any, _context: Any) -> None:
    from opal_kernels.cuts import CUTS

    for name, value in CUTS[self.cut].defaults.items():
        setattr(self, name, value)


def _share(name: str, description: str, most: float = 1.0) -> Any:
    return FloatProperty(name=name, description=description, min=0.0, max=most, precision=3, step=0.5)


def _angle(name: str, description: str) -> Any:
    return FloatProperty(name=name, description=description, min=math.radians(5.0), max=math.radians(75.0), subtype="ANGLE", step=25)


class OPAL_OT_add_gem(bpy.types.Operator, AddObjectHelper):
    """Add a cut stone"""

    bl_idname = "opal.add_gem"
    bl_label = "Gem"
    bl_description = "Add a cut stone of real size and give it the material of a gem"
    bl_options = {"REGISTER", "UNDO"}

    cut: EnumProperty(
        name="Cut",
        description="How the stone is cut; choosing one sets its usual proportions",
        items=cut_items,
        update=_take_usual_proportions,
    )
    species: EnumProperty(name="Species", description="What the stone is", items=species_items)
    size: FloatProperty(
        name="Width",
        description="Width of the stone at the girdle",
        default=gem_object.USUAL_WIDTH,
        min=1e-9,
        soft_max=0.1,
        subtype="DISTANCE",
        precision=5,
        step=0.05,
    )

    ratio: FloatProperty(name="Length to Width", description="Length over width", min=0.5, max=3.0, precision=3)
    table: _share("Table", "Width of the table, as a part of the stone's width")
    crown_angle: _angle("Crown Angle", "Slope of the main facets above the girdle")
    pavilion_angle: _angle("Pavilion Angle", "Slope of the main facets below the girdle")
    pavilion_depth: _share("Pavilion Depth", "From girdle to culet, as a part of the stone's width")
    girdle: _share("Girdle", "Thickness of the girdle, as a part of the stone's width", 0.5)
    culet: _share("Culet", "Width of the culet, as a part of the stone's width; 0 is a point", 0.5)
    star_length: _share("Star Length", "How far the stars reach from the table to the girdle")
    lower_half_length: _share("Lower Half Length", "How far the lower halves reach from the girdle to the culet")
    corner: _share("Corners", "How much of the width each cut corner takes")
    cleft: _share("Cleft", "Depth of the heart's cleft, as a part of its width")
    bulge: _share("Bulge", "How far the sides bow out, as a part of their length")
    height: _share("Height", "Height of the dome over the girdle, as a part of the stone's width", 1.5)
    star_height: _share("Star Height", "Height of the stars' lower corners over the girdle, as a part of the stone's width")
    chevrons: IntProperty(name="Chevrons", description="Rows of eight facets below the girdle", default=4, min=2, max=5)
    girdle_facets: IntProperty(
        name="Girdle Facets", description="Sides of the girdle, a multiple of 16", default=96, min=16, max=960, step=16
    )
    segments: IntProperty(name="Segments", description="Corners round the stone, a multiple of 4", default=96, min=8, max=1024, step=4)
    rings: IntProperty(name="Rings", description="Steps from the girdle to the top", default=24, min=2, max=256)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "OBJECT"

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if not self.properties.is_property_set("species"):
            self.species = "DIAMOND"
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        from opal_kernels.cuts import CUTS

        if not self.properties.is_property_set("species"):
            self.species = "DIAMOND"
        metres = units.metres_per_unit(context.scene)
        gem_object.take_usual_width(self, metres)
        cut = CUTS[self.cut]
        for name, usual in cut.defaults.items():
            if not self.properties.is_property_set(name):
                setattr(self, name, usual)
        try:
            stone = cut.build(**{name: getattr(self, name) for name in cut.defaults}).scaled(self.size * metres)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        mesh = gem_object.mesh_from_stone(stone, f"{cut.label} {gem_object.label_of(self.species)}", cut.smooth, metres)
        mesh.materials.append(gem_object.gem_material(self.species))
        object_data_add(context, mesh, operator=self)
        facets = "" if cut.smooth else f"{stone.facet_count()} facets, "
        self.report({"INFO"}, facets + gem_object.weight(stone, self.species))
        return {"FINISHED"}

    def draw(self, _context: bpy.types.Context) -> None:
        from opal_kernels.cuts import CUTS

        layout = self.layout
        layout.use_property_split = True
        for name in ("cut", "species", "size"):
            layout.prop(self, name)
        proportions = layout.column(align=True)
        for name in CUTS[self.cut].defaults:
            proportions.prop(self, name)
        place = layout.column(align=True)
        for name in ("align", "location", "rotation"):
            place.prop(self, name)


class OPAL_MT_add_gem(bpy.types.Menu):
    """The cuts"""

    bl_idname = "OPAL_MT_add_gem"
    bl_label = "Gem"

    def draw(self, _context: bpy.types.Context) -> None:
        for name, label, _description, _number in cut_items():
            self.layout.operator(OPAL_OT_add_gem.bl_idname, text=label).cut = name


def _draw_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.menu(OPAL_MT_add_gem.bl_idname, icon="SHADING_RENDERED")


def register() -> None:
    bpy.utils.register_class(OPAL_OT_add_gem)
    bpy.utils.register_class(OPAL_MT_add_gem)
    bpy.types.VIEW3D_MT_mesh_add.append(_draw_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_mesh_add.remove(_draw_menu)
    bpy.utils.unregister_class(OPAL_MT_add_gem)
    bpy.utils.unregister_class(OPAL_OT_add_gem)
