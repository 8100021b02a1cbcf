# SPDX-License-Identifier: GPL-3.0-or-later
"""Add › Volume › Rain: a curtain of drops where a camera sees the bow, and a word where it cannot."""

from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty

from ..addon import rainbow_presets, units

# How far away the curtain stands and how thick it is where nobody says otherwise, m.
_USUAL = 150.0
# Height of an eye, m.
_EYE = 1.7


class OPAL_OT_add_rain(bpy.types.Operator):
    """Add a curtain of rain opposite the sun"""

    bl_idname = "opal.add_rain"
    bl_label = "Rain"
    bl_description = "Add a curtain of rain where the scene's camera looks away from the sun, so that it shows a rainbow"
    bl_options = {"REGISTER", "UNDO"}

    preset: EnumProperty(name="Drops", description="What the drops are", items=rainbow_presets.items()[1:], default="CLASSIC")
    distance: FloatProperty(
        name="Distance",
        description="From the camera to the curtain",
        default=_USUAL,
        min=1e-6,
        soft_max=5000.0,
        subtype="DISTANCE",
    )
    depth: FloatProperty(
        name="Depth",
        description="How thick the curtain is",
        default=_USUAL,
        min=1e-6,
        soft_max=5000.0,
        subtype="DISTANCE",
    )
    share: FloatProperty(
        name="Light Caught",
        description="How much of the light that crosses the curtain's depth the drops catch: more is a brighter bow and a darker background",
        default=0.25,
        min=0.001,
        max=0.99,
        subtype="FACTOR",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "OBJECT"

    def execute(self, context: bpy.types.Context) -> set[str]:
        import numpy as np
        from opal_kernels import droplets
        from opal_kernels.optics.rainbow import rain_places, sight
        from opal_kernels.optics.rainbow.curtain import curtain as curtain_for

        from ..addon.translate.rainbow import drops_of

        scene = context.scene
        metres = units.metres_per_unit(scene)
        for name in ("distance", "depth"):
            if not self.properties.is_property_set(name):
                setattr(self, name, _USUAL / metres)
        suns, strongest = _suns(context)
        eye, view = _camera(scene, metres)
        material = _material(self.preset, -np.log1p(-self.share) / (self.depth * metres))
        arcs = droplets.arcs(drops_of(material.opal.rainbow))
        # A corona is seen round the sun: then the curtain stands where the camera looks.
        curtain = curtain_for([] if arcs.corona else suns, view, eye, self.distance, self.depth)
        obj = bpy.data.objects.new("Rain", _box(curtain.size))
        obj.location = curtain.centre
        obj.rotation_euler = (0.0, 0.0, curtain.turn)
        obj.display_type = "WIRE"
        obj.data.materials.append(material)
        context.collection.objects.link(obj)
        for other in context.selected_objects:
            other.select_set(False)
        obj.select_set(True)
        context.view_layer.objects.active = obj
        if view is None:
            self.report({"WARNING"}, "The scene has no camera: the rain stands where somebody at the origin sees the bow.")
        else:
            context.view_layer.update()
            half = np.asarray(curtain.size) / 2
            region = rain_places.Box(arcs, np.asarray(obj.matrix_world, float)[None, :3], -half, half)
            found = [(np.asarray(o.matrix_world.translation, float), o.data.energy) for o in _lamps(scene) if o.data.type != "SUN"]
            for sentence in sight.warnings(suns, view, [region], rain_places.lamps(found, [region], strongest)):
                self.report({"WARNING"}, sentence)
        return {"FINISHED"}

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        for name in ("preset", "distance", "depth", "share"):
            self.layout.prop(self, name)


def _lamps(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """The lamps that a render sees."""
    return [o for o in scene.objects if o.type == "LIGHT" and not o.hide_render and o.data.energy > 0.0]


def _suns(context: bpy.types.Context) -> tuple[list[Any], float]:
    """Directions to the scene's suns, and the irradiance of the strongest, W/m²."""
    import numpy as np

    suns = [o for o in _lamps(context.scene) if o.data.type == "SUN"]
    context.view_layer.update()
    columns = [np.asarray(o.matrix_world, float)[:3, 2] for o in suns]
    return [axis / np.linalg.norm(axis) for axis in columns], max((o.data.energy for o in suns), default=0.0)


def _camera(scene: bpy.types.Scene, metres: float) -> tuple[Any, Any]:
    """Where the eye is, in units of so many metres, and how it looks (None without a camera)."""
    from opal_kernels.optics.rainbow import sight

    from ..addon.translate.camera import camera_from_object

    camera = scene.camera
    if camera is None or camera.type != "CAMERA":
        return (0.0, 0.0, _EYE / metres), None
    from ..addon.settings import frame_of

    frame = frame_of(scene.render)
    view = sight.View.of(camera_from_object(camera, scene, frame.width, frame.height))
    return tuple(camera.matrix_world.translation), view


def _box(size: tuple[float, float, float]) -> bpy.types.Mesh:
    """A closed box about the origin, faces outwards."""
    x, y, z = (0.5 * s for s in size)
    vertices = [(i * x, j * y, k * z) for k in (-1, 1) for j in (-1, 1) for i in (-1, 1)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    mesh = bpy.data.meshes.new("Rain")
    mesh.from_pydata(vertices, [], faces)
    mesh.update()
    return mesh


def _material(preset: str, extinction: float) -> bpy.types.Material:
    material = bpy.data.materials.new("Rain")
    material.opal.kind = "RAINBOW"
    material.opal.rainbow.preset = preset
    material.opal.rainbow.extinction = extinction
    return material


def register() -> None:
    bpy.utils.register_class(OPAL_OT_add_rain)


def unregister() -> None:
    bpy.utils.unregister_class(OPAL_OT_add_rain)
