# SPDX-License-Identifier: GPL-3.0-or-later
"""One material seen straight from above: as Cycles renders it, and as Opal's program for it says at the same points.

Opal's side is the program alone, run at the pixels' centres: no light, no spectrum, no noise, so the two may be held to
single precision. The object is a rotated, stretched, smooth ball with UVs and a colour attribute; the camera is
orthographic.
"""

from __future__ import annotations

import importlib.util
import sys
import tempfile
import types
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
if importlib.util.find_spec("opal_kernels") is None:
    sys.path.insert(0, str(ROOT / "kernels"))
if "opal_source" not in sys.modules:
    package = types.ModuleType("opal_source")
    package.__path__ = [str(ROOT)]
    sys.modules["opal_source"] = package

sys.path.insert(0, str(ROOT / "tests" / "kernels"))
import program_under_test  # noqa: E402
from opal_kernels import binding  # noqa: E402
from opal_kernels.descriptions import Attribute  # noqa: E402
from opal_kernels.scene import Scene  # noqa: E402
from opal_source.addon.nodes import compile_material, compile_world  # noqa: E402
from opal_source.addon.nodes.images import Images  # noqa: E402
from opal_source.addon.translate.meshes import MeshNeeds, read_mesh  # noqa: E402

SIZE, VIEW = 32, 2.2  # pixels, metres
JITTER = 0.008  # pixels: Cycles' narrowest filter spreads its samples a little less than this
SPREAD = tuple((x, y) for x in (0, JITTER, -JITTER) for y in (0, JITTER, -JITTER))


class Context:
    """The node readers' context on a kernel scene."""

    def __init__(self, scene: Scene, depsgraph) -> None:
        self.depsgraph, self.attributes, self.problems = depsgraph, {}, []
        self._images = Images(scene.add_image, self.problems.append)

    def attribute_id(self, name: str) -> int:
        return self.attributes.setdefault(name, len(self.attributes))

    def image_index(self, image, image_user) -> int:
        return self._images.index(image, image_user)

    def image_tiles(self, image):
        return self._images.tiles(image)


def new_tree(owner, output: str = "ShaderNodeOutputMaterial"):
    """An empty node tree with an output node: (tree, output)."""
    if owner.node_tree is None or not owner.use_nodes:
        owner.use_nodes = True
    tree = owner.node_tree
    tree.nodes.clear()
    return tree, tree.nodes.new(output)


def node(tree, kind: str, inputs: dict | None = None, **settings):
    """Adds a node; `inputs` are numbers or sockets by identifier."""
    made = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in settings.items():
        setattr(made, name, value)
    for name, value in (inputs or {}).items():
        socket = next(s for s in made.inputs if s.identifier == name)
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    return made


def set_inputs(made, inputs: dict) -> None:
    """Sets the numbers of those inputs that the node's settings leave available."""
    for socket in made.inputs:
        if socket.enabled and socket.identifier in inputs:
            socket.default_value = inputs[socket.identifier]


def out(made, name: str | None = None):
    """An output socket, the first enabled one by default."""
    return next(s for s in made.outputs if (s.identifier == name or s.name == name if name else s.enabled))


def emission_material(build):
    """A material that emits what `build(tree)` gives: a socket."""
    material = bpy.data.materials.new("tested")
    tree, output = new_tree(material)
    emission = node(tree, "Emission", {"Color": build(tree)})
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def stage(material) -> bpy.types.Object:
    """An empty file with the ball under the camera."""
    scene = bpy.context.scene
    for old in list(bpy.data.objects):
        bpy.data.objects.remove(old)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=16, radius=0.9, rotation=(0.4, 0.3, 0.2), scale=(1, 0.8, 0.6))
    ball = bpy.context.object
    ball.location = (0.05, -0.03, 0.1)
    ball.color = (0.2, 0.4, 0.6, 0.8)
    ball.pass_index = 3
    for polygon in ball.data.polygons:
        polygon.use_smooth = True
    color = ball.data.color_attributes.new("Shade", "FLOAT_COLOR", "POINT")
    for i, vertex in enumerate(ball.data.vertices):
        color.data[i].color = (*(0.5 + 0.5 * x for x in vertex.co), 0.25)
    if material is not None:
        ball.data.materials.append(material)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", VIEW
    camera.location = (0, 0, 5)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.world = None
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    return ball


def cycles_image() -> np.ndarray:
    """The scene by Cycles, one sample in the middle of each pixel: (SIZE, SIZE, 3), rows from the bottom up."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples = "CPU", 1
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    scene.render.film_transparent = False
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "image.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        image.colorspace_settings.name = "Non-Color"
        values = np.empty(SIZE * SIZE * 4, np.float32)
        image.pixels.foreach_get(values)
        bpy.data.images.remove(image)
    return values.reshape(SIZE, SIZE, 4)[:, :, :3]


def run_program(scene, compiled, points, hits=None, ray_length=1.0):
    """Emission of a compiled program at points: (n, 3)."""
    handle = scene.handle if scene is not None else None
    return program_under_test.run(compiled.code, compiled.constants, compiled.n_registers, points, handle, hits, ray_length)[0]


def opal_images(ball, material, size: int = SIZE):
    """The same by Opal's program, at the pixels' centres and around where Cycles' sample may lie.

    Returns
    -------
    ndarray
        (9, size, size, 3), the centres first.
    list of Problem
        What the node readers could not keep.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = ball.evaluated_get(depsgraph)
    with Scene(threads=1) as scene:
        context = Context(scene, depsgraph)
        compiled = compile_material(material, context)
        arrays = read_mesh(evaluated.data, MeshNeeds(dict(context.attributes), "", True))
        mesh, _ = binding.scene_add_mesh(
            scene.handle,
            arrays.positions,
            arrays.triangles,
            corner_normals=arrays.corner_normals,
            corner_tangents=arrays.corner_tangents,
            generated=arrays.generated,
            attributes=[Attribute(*a) for a in arrays.attributes],
        )
        info = np.zeros((1, 8), np.float32)
        info[0, 1:6] = (ball.pass_index, *ball.color)
        scene.add_instances(mesh, [np.array(evaluated.matrix_world)[:3]], object_info=info)
        scene.commit()
        images = np.stack([_seen(scene, compiled, size, offset) for offset in SPREAD])
    return images, [*compiled.problems, *context.problems]


def _seen(scene, compiled, size, offset):
    axis = [((np.arange(size) + 0.5 + o) / size - 0.5) * VIEW for o in offset]
    x, y = np.meshgrid(*axis)
    origins = np.stack([x, y, np.full_like(x, 5.0)], axis=2).reshape(-1, 3).astype(np.float32)
    directions = np.broadcast_to(np.float32([0, 0, -1]), origins.shape)
    hit = binding.scene_intersect(scene.handle, origins, directions)
    on = np.isfinite(hit["distance"])
    barycentrics = hit["barycentrics"][on]
    points = np.concatenate([barycentrics, np.tile(np.float32([0, 0, 1]), (len(barycentrics), 1))], axis=1)
    hits = np.stack([hit["instance"][on], hit["triangle"][on]], axis=1)
    image = np.zeros((size * size, 3), np.float32)
    image[on] = run_program(scene, compiled, points, hits, 5.0)
    return image.reshape(size, size, 3)


def difference(ball, material):
    """How far the two are apart beyond what the place of Cycles' sample explains.

    Returns
    -------
    ndarray
        (SIZE, SIZE): the largest of the three channels.
    list of Problem
        What the node readers could not keep.
    """
    images, problems = opal_images(ball, material)
    # Cycles leaves out negative radiance.
    images, theirs = np.maximum(images, 0), np.maximum(cycles_image(), 0)
    assert images.max() > 0 or theirs.max() == 0, "Opal shows nothing"
    low, high = images.min(axis=0), images.max(axis=0)
    return np.maximum(low - theirs, theirs - high).clip(0).max(axis=2), problems


def world_difference(world):
    """A world seen by a wide camera from away of the origin: how far the two are apart, and the problems found.

    The camera is a perspective one, so that every pixel looks another way.
    """
    stage(None)
    for ball in [o for o in bpy.data.objects if o.type == "MESH"]:
        bpy.data.objects.remove(ball)
    scene = bpy.context.scene
    camera = scene.camera
    camera.data.type, camera.data.lens, camera.data.sensor_width = "PERSP", 15.0, 36.0
    camera.location, camera.rotation_euler = (1.0, 2.0, 3.0), (1.1, 0.2, 0.5)
    scene.world = world
    depsgraph = bpy.context.evaluated_depsgraph_get()
    rotation = np.array(camera.evaluated_get(depsgraph).matrix_world, np.float64)[:3, :3]
    images = []
    with Scene(threads=1) as kernels:
        context = Context(kernels, depsgraph)
        compiled = compile_world(world, context)
        for offset in SPREAD:
            x, y = np.meshgrid(*[((np.arange(SIZE) + 0.5 + o) / SIZE - 0.5) * 36 / 15 for o in offset])
            directions = np.stack([x, y, np.full_like(x, -1.0)], axis=2) @ rotation.T
            directions /= np.linalg.norm(directions, axis=2, keepdims=True)
            images.append(run_program(kernels, compiled, directions.reshape(-1, 3)).reshape(SIZE, SIZE, 3))
    images, theirs = np.maximum(images, 0), np.maximum(cycles_image(), 0)
    low, high = images.min(axis=0), images.max(axis=0)
    return np.maximum(low - theirs, theirs - high).clip(0).max(axis=2), [*compiled.problems, *context.problems]
