# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for the add-on's tests, and renders of them as arrays.

Nothing here asserts. Pictures come back as float32 (height, width, channels), rows from the bottom up.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

WHITE_WORLD = (1.0, 1.0, 1.0)


def addon(name: str) -> Any:
    """A module of the installed extension's ``addon`` package."""
    package = next(key for key in sys.modules if key.endswith("opal.addon"))
    return importlib.import_module(f"{package}.{name}")


def scene(width: int = 16, height: int = 12, passes: int = 2, samples: int = 4) -> bpy.types.Scene:
    """The current scene, set to a small Opal render without photons."""
    scene = bpy.context.scene
    scene.render.engine = "OPAL"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = passes, samples, 0
    return scene


def link(name: str, data: Any, location: Any = (0, 0, 0)) -> bpy.types.Object:
    """A new object in the scene's collection."""
    obj = bpy.data.objects.new(name, data)
    obj.location = location
    bpy.context.scene.collection.objects.link(obj)
    return obj


def camera(location: Any = (0, 0, 5), rotation: Any = (0, 0, 0), **settings: Any) -> bpy.types.Object:
    """The scene's camera; it looks down -Z by default."""
    data = bpy.data.cameras.new("Camera")
    for key, value in settings.items():
        setattr(data, key, value)
    obj = link("Camera", data, location)
    obj.rotation_euler = rotation
    bpy.context.scene.camera = obj
    return obj


def world(color: Any = WHITE_WORLD, strength: float = 1.0) -> bpy.types.World:
    """A uniform world."""
    result = bpy.data.worlds.new("World")
    if result.node_tree is None:
        result.use_nodes = True
    background = next(node for node in result.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = result
    return result


def mesh(name: str, vertices: Any, faces: Any, location: Any = (0, 0, 0), material: Any = None) -> bpy.types.Object:
    """An object of polygons."""
    data = bpy.data.meshes.new(name)
    data.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    if material is not None:
        data.materials.append(material)
    return link(name, data, location)


def plane(name: str = "Plane", size: float = 2.0, location: Any = (0, 0, 0), material: Any = None) -> bpy.types.Object:
    """A square facing +Z."""
    h = size / 2
    return mesh(name, [(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)], [(0, 1, 2, 3)], location, material)


def node_material(name: str, kind: str, **inputs: Any) -> bpy.types.Material:
    """A material of one shader node, such as ``"Emission"`` or ``"BsdfDiffuse"``."""
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(f"ShaderNode{kind}"), tree.nodes.new("ShaderNodeOutputMaterial")
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def glowing(name: str = "Glow", color: Any = (1, 1, 1), strength: float = 1.0) -> bpy.types.Material:
    """A surface of this radiance."""
    return node_material(name, "Emission", Color=(*color, 1), Strength=strength)


def matte(name: str = "Matte", color: Any = (0.5, 0.5, 0.5)) -> bpy.types.Material:
    """A Lambertian surface."""
    return node_material(name, "BsdfDiffuse", Color=(*color, 1))


def render(folder: Path, layer: str | None = None) -> np.ndarray:
    """The picture (Combined) of a render of the current scene."""
    return render_passes(folder, layer)["Combined"]


def render_passes(folder: Path, layer: str | None = None) -> dict[str, np.ndarray]:
    """Every pass of a view layer (the first by default) of a render of the current scene, by Blender's name."""
    scene = bpy.context.scene
    path = Path(folder) / "render.exr"
    scene.render.filepath = str(path)
    image_settings = scene.render.image_settings
    if hasattr(image_settings, "media_type"):
        image_settings.media_type = "MULTI_LAYER_IMAGE"
    image_settings.file_format = "OPEN_EXR_MULTILAYER"
    image_settings.color_depth = "32"
    bpy.ops.render.render(write_still=True)
    return read_layers(path)[layer or scene.view_layers[0].name]


def read_layers(path: Path) -> dict[str, dict[str, np.ndarray]]:
    """Layers of a multilayer OpenEXR file: {layer: {pass: pixels}}."""
    bpy.utils.expose_bundled_modules()
    import OpenImageIO as oiio

    channels: dict[tuple[str, str], dict[str, np.ndarray]] = {}
    for part in range(oiio.ImageBuf(str(path)).nsubimages):
        image = oiio.ImageBuf(str(path), part, 0)
        pixels = image.get_pixels(oiio.FLOAT)[::-1]
        for i, name in enumerate(image.spec().channelnames):
            layer, pass_name, letter = name.rsplit(".", 2)
            channels.setdefault((layer, pass_name), {})[letter] = pixels[..., i]
    layers: dict[str, dict[str, np.ndarray]] = {}
    for (layer, pass_name), found in channels.items():
        order = next(letters for letters in ("RGBA", "RGB", "XYZ", "Z", "V") if set(letters) == set(found))
        layers.setdefault(layer, {})[pass_name] = np.stack([found[letter] for letter in order], axis=-1)
    return layers


def problems() -> list[str]:
    """What the last render of the current scene could not do as set."""
    return [str(entry) for entry in addon("report").of(bpy.context.scene).entries]
