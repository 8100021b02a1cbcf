# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the pictures of `docs/first_gem.md` and `docs/first_beam.md` by the very steps that the pages tell, from Blender's own first file.

python tools/with_extension.py tools/make_guide_pictures.py [gem] [beam]
"""

import math
import sys
from pathlib import Path

import bpy
from mathutils import Vector

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "images"


def first_file(size: tuple[int, int]) -> bpy.types.Scene:
    """Blender's own first file without its cube, in Opal."""
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    scene = bpy.context.scene
    scene.render.engine = "OPAL"
    scene.render.resolution_x, scene.render.resolution_y = size
    return scene


def look(camera: bpy.types.Object, place: tuple, at: tuple, lens: float = 50.0) -> None:
    """Puts the camera somewhere and turns it to something."""
    camera.location = place
    camera.rotation_euler = (Vector(at) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens, camera.data.clip_start = lens, 0.001


def gem() -> None:
    """A ruby of 10 mm that lies on its side on a table, under a small lamp."""
    scene = first_file((640, 400))
    bpy.ops.mesh.primitive_plane_add(size=0.4)
    table = bpy.data.materials.new("Table")
    table.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.55, 0.5, 0.45, 1)
    table.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.8
    bpy.context.object.data.materials.append(table)
    bpy.ops.opal.add_gem(cut="BRILLIANT", species="RUBY", size=0.01)
    stone = bpy.context.object
    stone.rotation_euler.x = math.radians(41)
    bpy.context.view_layer.update()
    stone.location.z = 1e-5 - min((stone.matrix_world @ v.co).z for v in stone.data.vertices)
    lamp = bpy.data.objects["Light"]
    lamp.location = (-0.05, 0.05, 0.08)
    lamp.data.energy, lamp.data.shadow_soft_size = 1.0, 0.001
    look(bpy.data.objects["Camera"], (0.012, -0.06, 0.036), (0.003, -0.003, 0.002), 70.0)
    bpy.ops.opal.render_preset_apply(name="Caustics")
    scene.opal.passes, scene.opal.time_limit = 300, 100
    write(scene, "first_gem")


def beam() -> None:
    """A spot through fog in a dark room, past a ball."""
    scene = first_file((640, 400))
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    bpy.ops.mesh.primitive_plane_add(size=20)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.45, location=(0.6, 0, 0.9), segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    glass = bpy.data.materials.new("Glass")
    bpy.context.object.data.materials.append(glass)
    bpy.ops.opal.apply_preset(kind="GEM", preset="BK7")
    bpy.ops.mesh.primitive_cube_add(size=8, location=(0, 0, 4.01))
    fog = bpy.data.materials.new("Fog")
    bpy.context.object.data.materials.append(fog)
    bpy.ops.opal.apply_preset(kind="MEDIUM", preset="FOG")
    fog.opal.medium.extinction, fog.opal.medium.anisotropy = 0.1, 0.3
    lamp = bpy.data.objects["Light"]
    lamp.data.type = "SPOT"
    lamp.location = (-3.2, 0, 2.9)
    lamp.rotation_euler = (Vector((0.6, 0, 0.9)) - lamp.location).to_track_quat("-Z", "Y").to_euler()
    lamp.data.energy, lamp.data.shadow_soft_size = 15000, 0.01
    lamp.data.spot_size, lamp.data.spot_blend = math.radians(12), 0.2
    look(bpy.data.objects["Camera"], (0.0, -7.2, 1.5), (0.1, 0, 1.35), 42.0)
    bpy.ops.opal.render_preset_apply(name="Fog and Beams")
    scene.opal.passes, scene.opal.time_limit, scene.opal.denoise = 200, 60, True
    write(scene, "first_beam")


def write(scene: bpy.types.Scene, name: str) -> None:
    """Renders a JPEG of the guide."""
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.quality = "JPEG", 88
    scene.render.filepath = str(FOLDER / f"{name}.jpg")
    bpy.ops.render.render(write_still=True)
    print(scene.render.filepath)


if __name__ == "__main__":
    for picture in (gem, beam):
        if len(sys.argv) < 2 or picture.__name__ in sys.argv[1:]:
            picture()
