# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal's three materials in one picture: a set diamond and loose stones on a parapet, a fountain's spray in the garden, a bow in the rain.

The sun stands 24° high behind the camera's left shoulder. It throws the stones' caustics along the marble, lights the spray, and makes a
double rainbow round the point opposite to it, 24° under the horizon: the first bow's top is 42° − 24° = 18° high. Everything has its real
size, from stones of 8 mm to hills at 2 km, and one render draws it all.
"""

import math
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

sys.path.append(str(Path(__file__).resolve().parent))
import _scene
import ring

SUN_HEIGHT, SUN_AZIMUTH = math.radians(24.0), math.radians(7.0)
"""Of the sun above the horizon, and of the point opposite to it, to the right of the view."""
LEDGE = 0.30
"""Depth of the parapet, m."""
# Species, cut, the facet it lies on, width (m), place (m), and the azimuth (degrees) towards which its table leans.
STONES = (
    ("RUBY", "OVAL", "main", 0.0086, (0.0225, 0.0060), -125),
    ("EMERALD", "EMERALD", "pavilion 2", 0.0074, (0.0125, -0.0055), -70),
    ("SAPPHIRE_BLUE", "CUSHION", "main", 0.0082, (-0.0240, 0.0080), -60),
    ("AMETHYST", "PEAR", "main", 0.0084, (-0.0165, -0.0050), -95),
    ("CITRINE", "TRILLION", "main", 0.0070, (0.0010, -0.0090), -110),
)
TIME_LIMIT = 130.0
"""Of the render, s."""


def marble() -> bpy.types.Material:
    """Honed warm stone: a fine cloudy ground and thin dark veins where a folded noise passes its middle."""
    material = _scene.surface("Marble", (0.3, 0.29, 0.27), roughness=0.35, specular=0.3)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    coordinates, mix = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMix")
    mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
    mix.inputs["Factor"].default_value = 1.0
    colours = [socket for socket in mix.inputs if socket.type == "RGBA"]
    ground = ((0.40, (0.235, 0.22, 0.20, 1)), (0.62, (0.31, 0.295, 0.27, 1)))
    veins = ((0.470, (1, 1, 1, 1)), (0.497, (0.42, 0.40, 0.38, 1)), (0.512, (1, 1, 1, 1)))
    for socket, scale, distortion, stops in ((colours[0], 260.0, 0.4, ground), (colours[1], 32.0, 1.1, veins)):
        noise, ramp = nodes.new("ShaderNodeTexNoise"), nodes.new("ShaderNodeValToRGB")
        noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = scale, 9.0
        noise.inputs["Distortion"].default_value = distortion
        while len(ramp.color_ramp.elements) < len(stops):
            ramp.color_ramp.elements.new(0.5)
        for stop, (place, colour) in zip(ramp.color_ramp.elements, stops, strict=True):
            stop.position, stop.color = place, colour
        links.new(coordinates.outputs["Object"], noise.inputs["Vector"])
        links.new(noise.outputs[0], ramp.inputs["Fac"])
        links.new(ramp.outputs["Color"], socket)
    links.new(next(socket for socket in mix.outputs if socket.type == "RGBA"), shader.inputs["Base Color"])
    return material


def meadow(name: str, scale: float, dark: tuple, light: tuple) -> bpy.types.Material:
    """Grass and trees from afar: two greens by a noise of so many cells a metre."""
    material = _scene.matte(name, dark)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    coordinates, noise, ramp = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeTexNoise"), nodes.new("ShaderNodeValToRGB")
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = scale, 6.0
    for stop, place, colour in zip(ramp.color_ramp.elements, (0.42, 0.60), ((*dark, 1.0), (*light, 1.0)), strict=True):
        stop.position, stop.color = place, colour
    links.new(coordinates.outputs["Object"], noise.inputs["Vector"])
    links.new(noise.outputs[0], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], next(node for node in nodes if node.type == "BSDF_DIFFUSE").inputs["Color"])
    return material


def land() -> None:
    """The garden 12 m below the parapet, and wooded hills from 300 m on."""
    n = 240
    x, y = np.meshgrid(np.linspace(-2600.0, 2600.0, n), np.linspace(2.0, 3200.0, n))
    far = np.clip((y - 260.0) / 1200.0, 0.0, 1.0)
    ridges = 75.0 * np.sin(x / 420.0 + 0.7) * np.cos(y / 510.0) + 38.0 * np.sin(x / 170.0 + y / 330.0) + 15.0 * np.sin(x / 61.0 - y / 97.0)
    z = far * (ridges + 95.0) - 12.0 + 0.6 * np.sin(x / 19.0) * np.sin(y / 23.0)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3).tolist()
    faces = [(i, i + 1, i + n + 1, i + n) for r in range(n - 1) for i in range(r * n, r * n + n - 1)]
    _scene.mesh("Land", vertices, faces, meadow("Woods", 0.035, (0.022, 0.042, 0.016), (0.14, 0.16, 0.045)), smooth=True)


def turned(name: str, profile: list, material: bpy.types.Material, place: tuple, around: int = 96) -> bpy.types.Object:
    """A closed body of revolution about z from (radius, height) points, its first and last on the axis."""
    inner = profile[1:-1]
    vertices = [(0.0, 0.0, profile[0][1])]
    vertices += [(r * math.cos(a), r * math.sin(a), h) for r, h in inner for a in (math.tau * i / around for i in range(around))]
    vertices.append((0.0, 0.0, profile[-1][1]))
    last = len(vertices) - 1
    faces = [(0, 1 + (i + 1) % around, 1 + i) for i in range(around)]
    for k in range(len(inner) - 1):
        a, b = 1 + k * around, 1 + (k + 1) * around
        faces += [(a + i, a + (i + 1) % around, b + (i + 1) % around, b + i) for i in range(around)]
    b = 1 + (len(inner) - 1) * around
    faces += [(last, b + i, b + (i + 1) % around) for i in range(around)]
    obj = _scene.mesh(name, vertices, faces, material, smooth=True)
    obj.location = place
    return obj


def fountain(place: tuple) -> None:
    """A stone basin with a plume of spray."""
    stone = _scene.matte("Sandstone", (0.34, 0.30, 0.25))
    turned("Basin", [(0, 0), (3.0, 0), (3.3, 0.9), (2.95, 0.9), (2.8, 0.55), (0, 0.55)], stone, place)
    turned("Stem", [(0, 0.5), (0.35, 0.5), (0.22, 1.6), (1.1, 2.1), (1.0, 2.15), (0, 2.0)], stone, place)
    # A dense jet that falls back about itself, in a veil of finer spray; where two media overlap their densities add.
    jet = [(0, 13.8), (0.14, 13.5), (0.32, 12.4), (0.5, 10.5), (0.68, 7.5), (0.85, 4.5), (1.0, 1.8), (0.9, 0.8), (0, 0.6)]
    veil = [(0, 14.4), (0.3, 14.0), (0.9, 12.4), (1.5, 9.8), (2.0, 6.5), (2.4, 3.5), (2.6, 1.2), (2.4, 0.7), (0, 0.6)]
    for name, extinction, lumps, contrast, profile in (("Jet", 1.1, 1.1, 4.0, jet), ("Veil", 0.16, 1.6, 4.0, veil)):
        water = bpy.data.materials.new(name)
        water.opal.kind = "MEDIUM"
        medium = water.opal.medium
        medium.extinction, medium.albedo = extinction, (0.99, 0.99, 0.99)
        medium.density, medium.noise_scale, medium.noise_detail, medium.noise_contrast = "NOISE", lumps, 4.0, contrast
        medium.phase, medium.anisotropy = "HENYEY_GREENSTEIN", 0.3
        turned(name, list(reversed(profile)), water, place)


def rain() -> None:
    """A shower 160 m deep, from 220 m away."""
    drops = bpy.data.materials.new("Rain")
    drops.opal.kind = "RAINBOW"
    drops.opal.rainbow.radius, drops.opal.rainbow.extinction = 0.35, 0.0035
    _scene.box("Rain", (-1400.0, 220.0, -40.0), (1400.0, 380.0, 520.0), drops)


def clouds() -> None:
    """A rain sky: lead-blue overhead, brighter towards the horizon and behind the camera."""
    world = _scene.plain_world((1.0, 1.0, 1.0), 0.42)
    nodes, links = world.node_tree.nodes, world.node_tree.links
    background = next(node for node in nodes if node.type == "BACKGROUND")
    coordinates, split = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeSeparateXYZ")
    stretch, noise = nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeTexNoise")
    height, shade, mix = nodes.new("ShaderNodeValToRGB"), nodes.new("ShaderNodeValToRGB"), nodes.new("ShaderNodeMix")
    stretch.inputs["Scale"].default_value = (1.0, 1.0, 3.5)
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 2.2, 7.0
    for ramp, stops in (
        (height, ((0.0, (0.30, 0.33, 0.36, 1)), (0.6, (0.085, 0.105, 0.14, 1)))),
        (shade, ((0.35, (0.55, 0.57, 0.60, 1)), (0.70, (1.25, 1.22, 1.18, 1)))),
    ):
        for stop, (place, colour) in zip(ramp.color_ramp.elements, stops, strict=True):
            stop.position, stop.color = place, colour
    mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
    mix.inputs["Factor"].default_value = 1.0
    links.new(coordinates.outputs["Generated"], split.inputs["Vector"])
    links.new(coordinates.outputs["Generated"], stretch.inputs["Vector"])
    links.new(stretch.outputs["Vector"], noise.inputs["Vector"])
    links.new(split.outputs["Z"], height.inputs["Fac"])
    links.new(noise.outputs[0], shade.inputs["Fac"])
    colours = [socket for socket in mix.inputs if socket.type == "RGBA"]
    links.new(height.outputs["Color"], colours[0])
    links.new(shade.outputs["Color"], colours[1])
    links.new(next(socket for socket in mix.outputs if socket.type == "RGBA"), background.inputs["Color"])
    # The sun's side is clear: what the stones' facets show of it is what makes them bright.
    clearing = nodes.new("ShaderNodeMapRange")
    clearing.inputs["From Min"].default_value, clearing.inputs["From Max"].default_value = 0.1, -0.9
    clearing.inputs["To Min"].default_value, clearing.inputs["To Max"].default_value = 0.42, 1.6
    links.new(split.outputs["Y"], clearing.inputs["Value"])
    links.new(clearing.outputs["Result"], background.inputs["Strength"])


def ring_with_diamond() -> None:
    """The ring of `ring.py` with a larger stone, standing on the marble."""
    from opal_kernels.cuts import round_brilliant

    before = set(bpy.context.scene.objects)
    gold = _scene.surface("Gold", (1.0, 0.72, 0.29), roughness=0.06, metallic=1.0)
    ring.band(gold)
    top = 2.0 * (ring.INNER + ring.THICK)
    size = 1.25 * ring.STONE
    stone = _scene.stone("Diamond", round_brilliant(), size, _scene.gem("Diamond", "DIAMOND"))
    seat = top + 0.46 * size
    stone.location = (0.0, 0.0, seat)
    for i in range(4):
        angle = math.radians(45.0 + 90.0 * i)
        c, s = math.cos(angle), math.sin(angle)
        ring.claw((0.0004 * c, 0.0004 * s, top - 0.4e-3), (0.53 * size * c, 0.53 * size * s, seat + 0.10 * size), 0.00032, gold)
    bpy.context.view_layer.update()
    parts = [obj for obj in bpy.context.scene.objects if obj not in before]
    lean = Matrix.Rotation(math.radians(24.0), 4, "X")
    pose = Matrix.Rotation(math.radians(28.0), 4, "Z") @ lean
    placed = [(obj, pose @ obj.matrix_world) for obj in parts]
    lowest = min((matrix @ vertex.co).z for obj, matrix in placed for vertex in obj.data.vertices)
    for obj, matrix in placed:
        obj.matrix_world = Matrix.Translation((-0.002, 0.006, 1e-6 - lowest)) @ matrix


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    from opal_kernels.cuts import CUTS

    scene = _scene.empty()
    ring_with_diamond()
    for species, cut_name, facet, width, place, facing in STONES:
        cut = CUTS[cut_name].build()
        stone = _scene.stone(f"{species.title()} {cut_name.title()}", cut, width, _scene.gem(species.title(), species))
        _scene.rest_on_facet(stone, cut.names.index(facet), place, math.radians(facing))
    _scene.box("Parapet", (-1.5, -0.16, -0.4), (1.5, LEDGE - 0.16, 0.0), marble())
    land()
    fountain((21.0, 46.0, -12.0))
    rain()
    clouds()
    away = Vector((math.sin(SUN_AZIMUTH) * math.cos(SUN_HEIGHT), math.cos(SUN_AZIMUTH) * math.cos(SUN_HEIGHT), -math.sin(SUN_HEIGHT)))
    _scene.lamp("Sun", "SUN", -away, (0.0, 0.0, 0.0), 4.0, angle=math.radians(0.53))
    _scene.lamp("Lantern", "AREA", (-0.045, 0.105, 0.060), (0.0, 0.0, 0.0), 0.60, shape="DISK", size=0.004)
    _scene.camera((0.001, -0.058, 0.042), (0.001, 0.0, 0.0315), 21.0, fstop=64.0, focus=(0.0, 0.0, 0.02))
    scene.camera.data.clip_end = 1e4
    scene.render.resolution_x, scene.render.resolution_y = 720, 576
    scene.view_settings.exposure = 0.45
    _scene.limit(scene, 192, 400_000, TIME_LIMIT)
    return scene


if __name__ == "__main__":
    _scene.run(build, "opal")
