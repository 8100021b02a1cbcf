# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the pictures of `docs/first_gem.md` and `docs/first_beam.md` by the very steps that the pages tell, from Blender's own first file,
and the layers of `docs/composite.md`.

python tools/with_extension.py tools/make_guide_pictures.py [gem] [beam] [composite]
"""

import math
import sys
from pathlib import Path

import bpy
import numpy as np
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


def composite() -> None:
    """A cube, a glass ball and a block of fog on a floor: the base, caustics, gem, medium and the composite, side by side."""
    scene = first_file((320, 240))
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.25, 0.3, 0.4, 1)
    bpy.ops.mesh.primitive_plane_add(size=14)
    paint("Floor", (0.7, 0.5, 0.3))
    bpy.ops.mesh.primitive_cube_add(size=1, location=(-1.4, 0.6, 0.5))
    paint("Cube", (0.2, 0.5, 0.8))
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.7, location=(0.1, -0.2, 0.75), segments=96, ring_count=48)
    bpy.ops.object.shade_smooth()
    glass = bpy.data.materials.new("Glass")
    bpy.context.object.data.materials.append(glass)
    bpy.ops.opal.apply_preset(kind="GEM", preset="BK7")
    bpy.ops.mesh.primitive_cube_add(size=2, location=(1.7, 1.0, 0.97))
    bpy.context.object.scale = (0.85, 1.2, 1.0)
    fog = bpy.data.materials.new("Fog")
    bpy.context.object.data.materials.append(fog)
    bpy.ops.opal.apply_preset(kind="MEDIUM", preset="FOG")
    fog.opal.medium.extinction = 0.25
    lamp = bpy.data.objects["Light"]
    lamp.data.type = "AREA"
    lamp.data.energy, lamp.data.size = 400, 0.3
    lamp.location = (2.4, -2.2, 4.2)
    lamp.rotation_euler = (Vector((0.0, 0.2, 0.4)) - lamp.location).to_track_quat("-Z", "Y").to_euler()
    look(bpy.data.objects["Camera"], (0, -6, 2.6), (0, 0, 0.72), 50.0)
    scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = 24, 8, 200_000
    bpy.ops.opal.composite(samples=256)
    tiles = []
    for name, factor in (("Base", 1), ("Caustics", 2), ("Gems", 1), ("Media", 1), ("Composite", 1)):
        image = bpy.data.images[f"Opal {name}"]
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        tiles += [factor * pixels.reshape(image.size[1], image.size[0], 4), np.ones((image.size[1], 6, 4), np.float32)]
    write_display(np.concatenate(tiles[:-1], axis=1), "composite")


def paint(name: str, color: tuple) -> None:
    """Gives the active object Blender's own material in a colour."""
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
    bpy.context.object.data.materials.append(material)


def write_display(linear: np.ndarray, name: str) -> None:
    """Writes scene-linear pixels, rows from the bottom up, as a JPEG of the guide."""
    from opal_kernels import metrics

    image = bpy.data.images.new(name, linear.shape[1], linear.shape[0])
    display = np.ones((*linear.shape[:2], 4), np.float32)
    display[..., :3] = metrics.srgb(linear)[..., :3]
    image.pixels.foreach_set(display.reshape(-1))
    image.filepath_raw, image.file_format = str(FOLDER / f"{name}.jpg"), "JPEG"
    image.save(quality=88)
    print(image.filepath_raw)


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
    for picture in (gem, beam, composite):
        if len(sys.argv) < 2 or picture.__name__ in sys.argv[1:]:
            picture()
