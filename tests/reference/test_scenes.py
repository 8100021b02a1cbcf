# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole scenes beside Cycles: the same picture, as bright, and different by nothing but noise.

Each scene is rendered twice by each engine with two seeds. Half of the mean square of the difference of an engine's two renders
is its variance, so the mean of two renders has half of that again; when both engines converge to the same picture the
difference D of their means has E[D²] = (Var Cycles + Var Opal) / 2 and no more. What D² has beyond that is *unexplained*, and
its root is held to a few percent of the picture's brightness. The 0.5 % of pixels that differ most between any two of the four
renders are left out: one firefly among 3,000 pixels would outweigh everything else.

Both engines follow 32 bounces of every kind, without clamping, blurred reflections or a threshold for dim lamps.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

SIZE = (64, 48)
SAMPLES = 128
BOUNCES = 32


# ---- What scenes are made of ----


def nodes_of(block):
    """Node tree of a material or world, which Blender 4.5 makes on demand."""
    if block.node_tree is None:
        block.use_nodes = True
    return block.node_tree


def principled(name, **inputs):
    material = bpy.data.materials.new(name)
    shader = next(n for n in nodes_of(material).nodes if n.type == "BSDF_PRINCIPLED")
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return material


def diffuse(name, colour):
    material = bpy.data.materials.new(name)
    tree = nodes_of(material)
    tree.nodes.clear()
    shader, output = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = (*colour, 1.0)
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def place(name, mesh, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    obj = bpy.data.objects.new(name, mesh)
    obj.location, obj.rotation_euler, obj.scale = location, rotation, scale
    bpy.context.scene.collection.objects.link(obj)
    return obj


def square(name, material, half=1.0):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new().data.foreach_set("uv", (0, 0, 1, 0, 1, 1, 0, 1))
    mesh.materials.append(material)
    return mesh


def cube(name, material):
    corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    mesh.materials.append(material)
    return mesh


def ball(name, material, rings=24, segments=48):
    """A smooth sphere of radius 1."""
    heights = [math.pi * i / rings for i in range(1, rings)]
    turns = [math.tau * j / segments for j in range(segments)]
    corners = [(math.sin(p) * math.cos(a), math.sin(p) * math.sin(a), math.cos(p)) for p in heights for a in turns]
    top, bottom = len(corners), len(corners) + 1
    corners += [(0, 0, 1), (0, 0, -1)]
    faces = []
    for j in range(segments):
        k = (j + 1) % segments
        last = (rings - 2) * segments
        faces += [(top, j, k), (bottom, last + k, last + j)]
        for i in range(rings - 2):
            row = i * segments
            faces.append((row + j, row + segments + j, row + segments + k, row + k))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    mesh.materials.append(material)
    return mesh


def camera(location, rotation, **settings):
    data = bpy.data.cameras.new("camera")
    for key, value in settings.items():
        setattr(data, key, value)
    obj = place("camera", data, location, rotation)
    bpy.context.scene.camera = obj
    return data


def lamp(kind, location, rotation=(0, 0, 0), **settings):
    data = bpy.data.lights.new(kind, kind)
    for key, value in settings.items():
        setattr(data, key, value)
    return place(kind, data, location, rotation)


def world(colour=(0, 0, 0), image=None):
    block = bpy.data.worlds.new("world")
    bpy.context.scene.world = block
    tree = nodes_of(block)
    tree.nodes.clear()
    background, output = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeOutputWorld")
    background.inputs["Color"].default_value = (*colour, 1)
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    if image is not None:
        texture = tree.nodes.new("ShaderNodeTexEnvironment")
        texture.image = bpy.data.images.load(str(image))
        tree.links.new(texture.outputs["Color"], background.inputs["Color"])


def hdri(name):
    """One of the pictures of the sky that Blender brings."""
    return Path(bpy.utils.resource_path("LOCAL")) / "datafiles" / "studiolights" / "world" / f"{name}.exr"


# ---- How two engines are compared ----


def four_renders(render, samples):
    scene = bpy.context.scene
    cycles = scene.cycles
    for kind in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(cycles, f"{kind}_bounces", BOUNCES)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    scene.opal.max_depth = BOUNCES + 1
    scene.opal.photons_per_pass = 100_000
    return [
        [np.asarray(render(scene, engine, SIZE, samples, seed), np.float64)[..., :3] for seed in seeds]
        for engine, seeds in (("CYCLES", (1, 2)), ("OPAL", (3, 4)))
    ]


def unexplained(theirs, ours):
    """Root mean square of the difference that noise does not explain, relative to brightness; negative where it explains more than all."""
    spread = np.ptp(np.stack([*theirs, *ours]), axis=0).max(axis=-1)
    kept = spread <= np.quantile(spread, 0.995)
    variance = sum(0.5 * np.mean((a - b)[kept] ** 2) for a, b in (theirs, ours))
    difference = np.mean((np.mean(theirs, axis=0) - np.mean(ours, axis=0))[kept] ** 2)
    excess = difference - 0.5 * variance
    return math.copysign(math.sqrt(abs(excess)), excess) / np.mean(theirs)


def check(render, mean_tolerance=0.01, unexplained_tolerance=0.02, samples=1):
    """`samples` are in units of SAMPLES. Noise can hide no difference of the means: three of its standard errors are within the tolerance."""
    theirs, ours = four_renders(render, samples * SAMPLES)
    mean, found = np.mean(theirs, axis=(0, 1, 2)), np.mean(ours, axis=(0, 1, 2))
    assert mean.max() > 1e-3, "the scene is dark"
    # Standard error of the difference of the means, from the renders' own noise.
    error = sum(0.5 * np.mean((a - b) ** 2, axis=(0, 1)) for a, b in (theirs, ours))
    error = np.sqrt(0.5 * error / (SIZE[0] * SIZE[1]))
    rest = unexplained(theirs, ours)
    print(f"Opal / Cycles = {found / mean}, standard error {error / mean}, unexplained difference {rest:.4f}")
    assert (3 * error < mean_tolerance * mean).all(), f"too noisy to tell: a standard error of {error / mean}, for {mean_tolerance:.2g}"
    assert found == pytest.approx(mean, rel=mean_tolerance), f"Opal / Cycles = {found / mean} with a standard error of {error / mean}"
    assert rest < unexplained_tolerance, f"pixels differ by {100 * rest:.2f} % of the mean brightness beyond their noise"


# ---- Scenes ----


def cornell_box():
    white, red, green = diffuse("white", (0.73, 0.73, 0.73)), diffuse("red", (0.65, 0.05, 0.05)), diffuse("green", (0.12, 0.45, 0.15))
    place("floor", square("floor", white))
    place("ceiling", square("ceiling", white), (0, 0, 2))
    place("back", square("back", white), (0, 1, 1), (math.pi / 2, 0, 0))
    place("left", square("left", red), (-1, 0, 1), (0, math.pi / 2, 0))
    place("right", square("right", green), (1, 0, 1), (0, math.pi / 2, 0))
    place("tall", cube("tall", white), (-0.35, 0.3, 0.6), (0, 0, 0.3), (0.6, 0.6, 1.2))
    place("short", cube("short", white), (0.35, -0.3, 0.3), (0, 0, -0.3), (0.6, 0.6, 0.6))
    lamp("AREA", (0, 0, 1.98), energy=20, shape="SQUARE", size=0.5, color=(1, 0.85, 0.6))
    world()
    camera((0, -3.9, 1), (math.pi / 2, 0, 0), lens=40)


def ball_under_sky(sky, **inputs):
    place("floor", square("floor", diffuse("floor", (0.6, 0.55, 0.5)), 4))
    place("ball", ball("ball", principled("ball", **inputs)), (0, 0, 1.001))
    world(image=hdri(sky))
    camera((0, -6, 2.6), (1.32, 0, 0), lens=50)


def textured():
    image = bpy.data.images.new("tiles", 32, 32)
    pixels = np.random.default_rng(5).uniform(0.02, 1, (32, 32, 4)).astype(np.float32)
    pixels[..., 3] = 1
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    material = principled("tiles", Roughness=0.6)
    tree = material.node_tree
    texture, mapping, coordinates = (tree.nodes.new(f"ShaderNode{n}") for n in ("TexImage", "Mapping", "TexCoord"))
    texture.image = image
    mapping.inputs["Scale"].default_value = (2.0, 1.5, 1.0)
    mapping.inputs["Rotation"].default_value = (0, 0, 0.4)
    shader = next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED")
    tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    place("floor", square("floor", material, 3))
    place("box", cube("box", material), (0.4, 0.3, 0.5), (0, 0, 0.5))
    world((0.3, 0.4, 0.5))
    lamp("SUN", (0, 0, 3), (0.6, 0.3, 0), energy=2.0, angle=0.05)
    camera((0, -5, 3), (1.05, 0, 0), lens=45)


def colonnade():
    grey = diffuse("grey", (0.6, 0.6, 0.6))
    place("floor", square("floor", grey, 8))
    for i, colour in enumerate(((0.8, 0.2, 0.1), (0.7, 0.7, 0.2), (0.1, 0.5, 0.8), (0.4, 0.8, 0.3))):
        place(f"post {i}", cube(f"post {i}", diffuse(f"post {i}", colour)), (-1.5 + i, -1.5 + 1.6 * i, 0.7), (0, 0, 0.4), (0.5, 0.5, 1.4))
    world((0.25, 0.3, 0.4))
    lamp("AREA", (2, -2, 4), (0.5, 0.4, 0), energy=250, size=1.0)


def test_cornell_box(opal, render):
    cornell_box()
    check(render)


BALLS = {
    "metal": {"Base_Color": (0.95, 0.7, 0.35, 1), "Metallic": 1.0, "Roughness": 0.25},
    "mirror": {"Base_Color": (0.9, 0.9, 0.9, 1), "Metallic": 1.0, "Roughness": 0.0},
    "plastic": {"Base_Color": (0.1, 0.3, 0.8, 1), "Roughness": 0.3},
    "coated": {"Base_Color": (0.8, 0.1, 0.05, 1), "Roughness": 0.6, "Coat_Weight": 1.0, "Coat_Roughness": 0.1},
    "rough glass": {"Base_Color": (0.9, 1.0, 0.9, 1), "Transmission_Weight": 1.0, "Roughness": 0.3, "IOR": 1.45},
    "clear glass": {"Base_Color": (1, 1, 1, 1), "Transmission_Weight": 1.0, "Roughness": 0.0, "IOR": 1.45},
}


@pytest.mark.parametrize("kind", BALLS)
def test_ball_under_a_sky(opal, render, kind):
    """Courtyard is a bright sky without a sun."""
    ball_under_sky("courtyard", **BALLS[kind])
    check(render)


def test_ball_between_studio_lights(opal, render):
    """A tenth of a percent of studio's sky brings seven tenths of its light, which only importance sampling finds.
    Few bright pixels carry the noise, so that its own estimate is rough."""
    ball_under_sky("studio", **BALLS["plastic"])
    check(render, unexplained_tolerance=0.05, samples=2)


def test_textures(opal, render):
    textured()
    check(render)


def test_depth_of_field(opal, render):
    colonnade()
    data = camera((0, -6, 2), (1.35, 0, 0), lens=50)
    data.dof.use_dof = True
    data.dof.focus_distance, data.dof.aperture_fstop, data.dof.aperture_blades = 6.0, 0.1, 6
    check(render)


def test_orthographic(opal, render):
    colonnade()
    camera((3, -6, 5), (1.0, 0, 0.45), type="ORTHO", ortho_scale=6)
    check(render)


def test_instances(opal, render):
    """A collection placed five times, once mirrored and once sheared by uneven scale, beside objects that share a mesh."""
    place("floor", square("floor", diffuse("floor", (0.6, 0.6, 0.6)), 5))
    parts = bpy.data.collections.new("parts")
    for obj in (
        place("a", ball("a", principled("a", Base_Color=(0.8, 0.3, 0.1, 1), Roughness=0.4)), (0, 0, 0.4), scale=(0.3, 0.3, 0.4)),
        place("b", cube("b", diffuse("b", (0.2, 0.6, 0.7))), (0.4, 0, 0.2), (0, 0, 0.5), (0.4, 0.2, 0.4)),
    ):
        bpy.context.scene.collection.objects.unlink(obj)
        parts.objects.link(obj)
    for i, scale in enumerate(((1, 1, 1), (-1, 1, 1), (1.6, 0.7, 1.2), (1, 1, 1), (0.5, 0.5, 2))):
        empty = place(f"copy {i}", None, (-1.6 + 0.8 * i, 0.5 * (i % 2), 0), (0, 0, 0.7 * i), scale)
        empty.instance_type, empty.instance_collection = "COLLECTION", parts
    shared = ball("shared", principled("shared", Metallic=1.0, Roughness=0.35))
    for i in range(3):
        place(f"shared {i}", shared, (-1 + i, -1, 0.25), scale=(0.25, 0.25, 0.25))
    world((0.4, 0.45, 0.5))
    lamp("POINT", (1, -2, 3), energy=150, shadow_soft_size=0.3)
    camera((0, -5, 2.2), (1.2, 0, 0), lens=45)
    check(render)
