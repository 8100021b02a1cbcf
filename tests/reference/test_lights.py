# SPDX-License-Identifier: GPL-3.0-or-later
"""Every lamp and world beside Cycles: the same watts on a grey floor give the same picture.

Each case renders a floor with a tilted board on it, in both engines. Means agree within 0.3 % a channel, of which four standard errors of
Cycles' own (measured from two seeds) are the smaller part: where they are not, both take more samples.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

SIZE, SAMPLES, MOST_SAMPLES = (32, 24), 256, 65536


def grey(name="grey", value=0.5):
    material = bpy.data.materials.new(name)
    tree = material.node_tree
    if tree is None:
        material.use_nodes = True
        tree = material.node_tree
    tree.nodes.clear()
    output, diffuse = (
        tree.nodes.new("ShaderNodeOutputMaterial"),
        tree.nodes.new("ShaderNodeBsdfDiffuse"),
    )
    diffuse.inputs["Color"].default_value = (value, value, value, 1)
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    return material


def board(name, size, location=(0, 0, 0), rotation=(0, 0, 0), material=None):
    h = size / 2
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    obj = bpy.data.objects.new(name, mesh)
    obj.location, obj.rotation_euler = location, rotation
    bpy.context.scene.collection.objects.link(obj)
    return obj


def lamp(
    kind,
    location=(0.3, 0.2, 1.5),
    rotation=(0.2, -0.3, 0.1),
    scale=(1, 1, 1),
    **settings,
):
    data = bpy.data.lights.new(kind, kind)
    for name, value in settings.items():
        setattr(data, name, value)
    obj = bpy.data.objects.new(kind, data)
    obj.location, obj.rotation_euler, obj.scale = location, rotation, scale
    bpy.context.scene.collection.objects.link(obj)
    return obj


def camera(location=(0.0, -2.5, 3.5), rotation=(0.6, 0, 0), **settings):
    data = bpy.data.cameras.new("camera")
    for name, value in settings.items():
        setattr(data, name, value)
    obj = bpy.data.objects.new("camera", data)
    obj.location, obj.rotation_euler = location, rotation
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.scene.camera = obj
    return obj


def world(color=(0, 0, 0), strength=1.0):
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    if scene.world.node_tree is None:
        scene.world.use_nodes = True
    nodes = scene.world.node_tree.nodes
    nodes.clear()
    output, background = (
        nodes.new("ShaderNodeOutputWorld"),
        nodes.new("ShaderNodeBackground"),
    )
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    scene.world.node_tree.links.new(background.outputs[0], output.inputs["Surface"])
    return background


def stage():
    """A floor and a tilted board, both grey and diffuse, without bounces between them to speak of."""
    material = grey()
    board("floor", 6.0, material=material)
    board("board", 1.0, (-0.7, 0.4, 0.5), (0.9, 0.3, 0.2), material)


def measured(render, engine, seed, samples=SAMPLES):
    scene = bpy.context.scene
    scene.cycles.max_bounces = 8
    return np.asarray(render(scene, engine, SIZE, samples, seed), dtype=np.float64)[..., :3]


def check(render, tolerance=3e-3):
    samples = SAMPLES
    while True:
        theirs, again = (measured(render, "CYCLES", seed, samples) for seed in (1, 2))
        mean = 0.5 * (theirs + again).mean(axis=(0, 1))
        noise = np.std(theirs - again, axis=(0, 1)) / math.sqrt(2 * theirs[..., 0].size)  # of the mean of one render, by channel
        excess = float((4 * noise / (tolerance * np.maximum(mean, 1e-9))).max())
        if excess < 1 or samples >= MOST_SAMPLES:
            break
        # As many as this noise says, and a fifth more: it is itself known to a few percent.
        samples = min(MOST_SAMPLES, SAMPLES * math.ceil(1.2 * excess**2 * samples / SAMPLES))
    assert mean.max() > 1e-3, "the scene is dark"
    assert excess < 1, f"too noisy to tell: {noise / mean} after {samples} samples"
    ours = measured(render, "OPAL", 3, samples)
    found = ours.mean(axis=(0, 1))
    assert found == pytest.approx(mean, rel=tolerance), f"Opal / Cycles = {found / mean}"
    # Nothing is in another place: blocks of 8 x 8 pixels agree as well.
    blocks = [x.reshape(3, 8, 4, 8, 3).mean(axis=(1, 3)) for x in (ours, 0.5 * (theirs + again))]
    assert blocks[0] == pytest.approx(blocks[1], rel=0.02, abs=0.01 * mean.max() + 32 * noise.max())


LAMPS = {
    "point": ("POINT", {"energy": 60}),
    "point with a radius": ("POINT", {"energy": 60, "shadow_soft_size": 0.3}),
    "point as a sphere": (
        "POINT",
        {"energy": 60, "shadow_soft_size": 0.3, "use_soft_falloff": False},
    ),
    "point not normalized": (
        "POINT",
        {"energy": 30, "shadow_soft_size": 0.3, "normalize": False},
    ),
    "point without radius or normalize": ("POINT", {"energy": 30, "normalize": False}),
    "coloured point": (
        "POINT",
        {"energy": 60, "color": (0.9, 0.5, 0.1), "shadow_soft_size": 0.1},
    ),
    "warm point": (
        "POINT",
        {"energy": 60, "use_temperature": True, "temperature": 2800},
    ),
    "cool coloured point": (
        "POINT",
        {
            "energy": 60,
            "use_temperature": True,
            "temperature": 9000,
            "color": (0.5, 1, 0.8),
        },
    ),
    "point by exposure": ("POINT", {"energy": 15, "exposure": 2.0}),
    "spot": ("SPOT", {"energy": 200, "spot_size": 1.0, "spot_blend": 0.0}),
    "spot with blend": (
        "SPOT",
        {"energy": 200, "spot_size": 1.4, "spot_blend": 0.6, "shadow_soft_size": 0.2},
    ),
    "spot as a sphere": (
        "SPOT",
        {
            "energy": 200,
            "spot_size": 1.4,
            "spot_blend": 0.6,
            "shadow_soft_size": 0.2,
            "use_soft_falloff": False,
        },
    ),
    "wide spot": (
        "SPOT",
        {"energy": 200, "spot_size": 3.0, "spot_blend": 1.0, "shadow_soft_size": 0.1},
    ),
    "sun": ("SUN", {"energy": 2.0}),
    "wide sun": ("SUN", {"energy": 2.0, "angle": 0.5}),
    "sun not normalized": ("SUN", {"energy": 2.0, "angle": 0.5, "normalize": False}),
    "square": ("AREA", {"energy": 40, "shape": "SQUARE", "size": 0.6}),
    "rectangle": (
        "AREA",
        {"energy": 40, "shape": "RECTANGLE", "size": 1.2, "size_y": 0.3},
    ),
    "disk": ("AREA", {"energy": 40, "shape": "DISK", "size": 0.8}),
    "ellipse": ("AREA", {"energy": 40, "shape": "ELLIPSE", "size": 1.2, "size_y": 0.4}),
    "square with spread": (
        "AREA",
        {"energy": 40, "shape": "SQUARE", "size": 0.6, "spread": math.radians(60)},
    ),
    "disk with spread": (
        "AREA",
        {"energy": 40, "shape": "DISK", "size": 0.6, "spread": math.radians(20)},
    ),
    "rectangle not normalized": (
        "AREA",
        {
            "energy": 4,
            "shape": "RECTANGLE",
            "size": 1.2,
            "size_y": 0.3,
            "normalize": False,
        },
    ),
}


@pytest.mark.parametrize("name", LAMPS)
def test_lamp_lights_the_floor_as_in_cycles(opal, render, name):
    stage()
    world()
    camera()
    kind, settings = LAMPS[name]
    lamp(
        kind,
        **({"shadow_soft_size": 0.0} if kind in {"POINT", "SPOT"} else {"angle": 0.0} if kind == "SUN" else {}) | settings,
    )
    check(render)


@pytest.mark.parametrize("kind", ["SPOT", "AREA"])
def test_lamps_under_uneven_scale(opal, render, kind):
    stage()
    world()
    camera()
    settings = {"spot_size": 0.9, "shadow_soft_size": 0.0} if kind == "SPOT" else {"shape": "RECTANGLE", "size": 0.4, "size_y": 0.4}
    lamp(kind, scale=(2.0, 0.7, 1.3), energy=80, **settings)
    check(render)


@pytest.mark.parametrize(
    "name",
    [
        "point with a radius",
        "point as a sphere",
        "spot with blend",
        "disk",
        "square with spread",
        "wide sun",
    ],
)
def test_lamp_looks_as_in_cycles(opal, render, name):
    """Seen by the camera itself; the sun as a disc in the sky."""
    world()
    kind, settings = LAMPS[name]
    if kind == "SUN":
        lamp(kind, rotation=(0.05, 0.02, 0), **settings).visible_camera = True
        camera((0, 0, 0), (math.pi + 0.1, 0, 0))
    else:
        lamp(kind, (0, 0, 2), (0.1, 0.2, 0), **settings).visible_camera = True  # Blender hides new lamps
        camera((0.1, 0.0, -0.5), (math.pi, 0, 0))
    check(render, 0.01)


def test_lamp_hidden_from_the_camera(opal, render):
    stage()
    world()
    camera((0.3, 0.2, 5), (0, 0, 0))
    lamp("AREA", (0.3, 0.2, 3), (math.pi, 0, 0), energy=20, size=0.4).visible_camera = True  # looks up, at the camera
    lamp("AREA", (0.3, 0.2, 3.5), (math.pi, 0, 0), energy=20, size=1.0).visible_camera = False
    lamp("AREA", (0.3, 0.2, 3), energy=20, size=0.3).visible_camera = False
    check(render)


def test_lamp_without_shadow(opal, render):
    stage()
    world()
    camera()
    lamp("POINT", energy=60, shadow_soft_size=0.0, use_shadow=False)
    check(render)


def test_linked_lamp_lights_its_receivers_only(opal, render):
    stage()
    world((0.1, 0.1, 0.1))
    camera()
    linked = lamp("AREA", energy=40, size=0.5)
    collection = bpy.data.collections.new("receivers")
    collection.objects.link(bpy.data.objects["board"])
    linked.light_linking.receiver_collection = collection
    check(render)


def test_many_lamps(opal, render):
    stage()
    world()
    camera()
    rng = np.random.default_rng(1)
    for i in range(24):
        kind = ("POINT", "SPOT", "AREA")[i % 3]
        lamp(
            kind,
            (*rng.uniform(-2, 2, 2), rng.uniform(0.8, 2)),
            energy=10 ** rng.uniform(0, 1.3),
            color=rng.uniform(0.2, 1, 3),
        )
    check(render)


def test_uniform_world(opal, render):
    stage()
    camera()
    world((0.2, 0.5, 0.9), 1.5)
    check(render)


def test_world_seen_by_the_camera_only(opal, render):
    stage()
    camera()
    world((0.2, 0.5, 0.9), 1.5)
    seen = bpy.context.scene.world.cycles_visibility
    seen.diffuse = seen.glossy = seen.transmission = seen.scatter = False
    lamp("POINT", energy=30)
    camera((0, -4, 1), (1.4, 0, 0))
    check(render)


def test_world_of_a_picture(opal, render):
    """A picture with one small bright spot: found by the importance map, or else only noise."""
    stage()
    camera()
    background = world()
    image = bpy.data.images.new("sky", 64, 32, float_buffer=True)
    pixels = np.ones((32, 64, 4), np.float32) * (0.1, 0.2, 0.4, 1)
    pixels[24:26, 20:22, :3] = (60, 40, 20)
    image.pixels.foreach_set(pixels.reshape(-1).astype(np.float32))
    image.update()
    tree = bpy.context.scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    check(render)


@pytest.mark.parametrize("size", [0.5, 3.0])
def test_emissive_mesh(opal, render, size):
    stage()
    world()
    camera()
    material = grey("glow")
    tree = material.node_tree
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = (1.0, 0.6, 0.2, 1)
    emission.inputs["Strength"].default_value = 5.0
    tree.links.new(
        emission.outputs[0],
        next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL").inputs["Surface"],
    )
    board("glow", size, (0.5, 0.5, 1.2), (0.4, 0.2, 0), material)
    check(render)


def test_lamp_with_nodes(opal, render):
    stage()
    world()
    camera()
    data = lamp("POINT", energy=20, color=(1.0, 0.8, 0.6)).data
    data.use_nodes = True
    emission = next(n for n in data.node_tree.nodes if n.type == "EMISSION")
    emission.inputs["Color"].default_value = (0.3, 0.9, 0.5, 1)
    emission.inputs["Strength"].default_value = 2.5
    check(render)
