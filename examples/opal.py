# SPDX-License-Identifier: GPL-3.0-or-later
"""Opal's three materials in one picture: a set diamond and loose stones on a parapet, a fountain's spray in the garden, a bow in the rain.

The sun stands 24° high behind the camera's left shoulder. Through the leaves of an arbour it falls on the stones and throws their colours
along the marble, lights the fountain, and makes a double rainbow round the point opposite to it, 24° under the horizon: the first bow's top
is 42° − 24° = 18° high, its foot stands in the fountain's spray, whose drops show it too. Everything has its real size, from stones of 8 mm
to hills at 4 km, and one render draws it all.
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

SUN_HEIGHT, SUN_AZIMUTH = math.radians(24.0), math.radians(13.0)
"""Of the sun above the horizon, and of the point opposite to it, to the right of the view."""
GARDEN = -4.5
"""Height of the garden, m, below the parapet's top."""
LEDGE = 0.30
"""Depth of the parapet, m."""
# Species, cut, the facet it lies on, width (m), place (m), and the azimuth (degrees) towards which its table leans.
STONES = (
    ("RUBY", "OVAL", "main", 0.0088, (0.0215, 0.0050), -125),
    ("EMERALD", "EMERALD", "pavilion 2", 0.0078, (0.0135, -0.0075), -70),
    ("SAPPHIRE_BLUE", "CUSHION", "main", 0.0082, (-0.0240, 0.0080), -60),
    ("AMETHYST", "PEAR", "main", 0.0084, (-0.0165, -0.0050), -95),
    ("CITRINE", "TRILLION", "main", 0.0074, (0.0005, -0.0105), -100),
)
TIME_LIMIT = 130.0
"""Of the render, s."""


def marble() -> bpy.types.Material:
    """Honed warm stone: a fine cloudy ground and thin dark veins where a folded noise passes its middle."""
    material = _scene.surface("Marble", (0.3, 0.29, 0.27), roughness=0.22, specular=0.5)
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


def farmland() -> bpy.types.Material:
    """Fields of several greens and ochres with dark hedges between them, and woods where a broad noise is high."""
    material = _scene.matte("Farmland", (0.05, 0.07, 0.02))
    nodes, links = material.node_tree.nodes, material.node_tree.links
    coordinates = nodes.new("ShaderNodeTexCoord")

    def ramp(source, stops):
        node = nodes.new("ShaderNodeValToRGB")
        while len(node.color_ramp.elements) < len(stops):
            node.color_ramp.elements.new(0.5)
        for stop, (place, colour) in zip(node.color_ramp.elements, stops, strict=True):
            stop.position, stop.color = place, (*colour, 1.0)
        links.new(source, node.inputs["Fac"])
        return node.outputs["Color"]

    def noise(scale, detail):
        node = nodes.new("ShaderNodeTexNoise")
        node.inputs["Scale"].default_value, node.inputs["Detail"].default_value = scale, detail
        links.new(coordinates.outputs["Object"], node.inputs["Vector"])
        return node.outputs[0]

    def cells(feature):
        node = nodes.new("ShaderNodeTexVoronoi")
        node.feature, node.voronoi_dimensions = feature, "2D"
        node.inputs["Scale"].default_value = 0.02
        links.new(coordinates.outputs["Object"], node.inputs["Vector"])
        return node.outputs

    def mix(factor, first, second, blend="MIX"):
        node = nodes.new("ShaderNodeMix")
        node.data_type, node.blend_type = "RGBA", blend
        colours = [socket for socket in node.inputs if socket.type == "RGBA"]
        if isinstance(factor, float):
            node.inputs["Factor"].default_value = factor
        else:
            links.new(factor, node.inputs["Factor"])
        for socket, source in zip(colours, (first, second), strict=True):
            if isinstance(source, tuple):
                socket.default_value = (*source, 1.0)
            else:
                links.new(source, socket)
        return next(socket for socket in node.outputs if socket.type == "RGBA")

    fields = ramp(
        cells("F1")["Color"],
        (
            (0.20, (0.045, 0.085, 0.018)),
            (0.40, (0.085, 0.120, 0.026)),
            (0.55, (0.050, 0.095, 0.024)),
            (0.68, (0.170, 0.145, 0.050)),
            (0.80, (0.075, 0.105, 0.022)),
        ),
    )
    fields = mix(0.5, fields, ramp(noise(0.06, 8.0), ((0.3, (0.6, 0.6, 0.6)), (0.7, (1.4, 1.4, 1.4)))), "MULTIPLY")
    hedge = ramp(cells("DISTANCE_TO_EDGE")["Distance"], ((0.02, (1.0, 1.0, 1.0)), (0.05, (0.0, 0.0, 0.0))))
    trees = ramp(noise(0.25, 4.0), ((0.35, (0.010, 0.022, 0.008)), (0.65, (0.035, 0.055, 0.018))))
    woods = ramp(noise(0.0045, 7.0), ((0.50, (0.0, 0.0, 0.0)), (0.53, (1.0, 1.0, 1.0))))
    colour = mix(woods, mix(hedge, fields, trees), trees)
    links.new(colour, next(node for node in nodes if node.type == "BSDF_DIFFUSE").inputs["Color"])
    return material


def land() -> None:
    """A garden below the parapet, fields from 60 m on, and hills behind each other to 4 km."""
    n = 360
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, n), np.linspace(0.0, 1.0, n) ** 2.2)
    y = 3.0 + 4200.0 * y
    x = x * (60.0 + 1.15 * y)
    rise = np.clip((y - 300.0) / 1500.0, 0.0, 1.6) ** 1.2
    hills = 60.0 * np.sin(x / 380.0 + 0.7) * np.cos(y / 430.0) + 34.0 * np.sin(x / 170.0 + y / 260.0) + 14.0 * np.sin(x / 73.0 - y / 97.0)
    hills += 6.0 * np.sin(x / 31.0 + y / 41.0)
    z = rise * (hills + 55.0) + GARDEN + np.clip((y - 40.0) / 200.0, 0.0, 1.0) * 2.0 * np.sin(x / 57.0 + 1.0) * np.sin(y / 71.0)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3).tolist()
    faces = [(i, i + 1, i + n + 1, i + n) for r in range(n - 1) for i in range(r * n, r * n + n - 1)]
    _scene.mesh("Land", vertices, faces, farmland(), smooth=True)


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
    """A stone basin in which a jet of white water falls back about itself; the drops round it are fine enough to show their own bow."""
    stone = _scene.matte("Sandstone", (0.34, 0.30, 0.25))
    turned("Basin", [(0, 0), (2.6, 0), (2.8, 0.7), (2.5, 0.7), (2.35, 0.45), (0, 0.45)], stone, place)
    turned("Stem", [(0, 0.4), (0.3, 0.4), (0.2, 1.3), (0.95, 1.7), (0.85, 1.75), (0, 1.65)], stone, place)
    jet = [(0, 6.6), (0.10, 6.5), (0.22, 6.0), (0.33, 5.0), (0.42, 3.8), (0.5, 2.6), (0.58, 1.7), (0.5, 1.0), (0, 0.6)]
    veil = [(0, 7.2), (0.35, 6.9), (0.8, 6.0), (1.25, 4.6), (1.6, 3.0), (1.9, 1.4), (1.8, 0.75), (0, 0.6)]
    water = bpy.data.materials.new("Jet")
    water.opal.kind = "MEDIUM"
    medium = water.opal.medium
    medium.extinction, medium.albedo = 2.6, (0.99, 0.99, 0.99)
    medium.density, medium.noise_scale, medium.noise_detail, medium.noise_contrast = "NOISE", 0.55, 4.0, 4.0
    medium.phase, medium.anisotropy = "HENYEY_GREENSTEIN", 0.3
    turned("Jet", list(reversed(jet)), water, place)
    drops = bpy.data.materials.new("Spray")
    drops.opal.kind = "RAINBOW"
    drops.opal.rainbow.radius, drops.opal.rainbow.extinction = 0.35, 0.10
    turned("Spray", list(reversed(veil)), drops, place)


def arbour(to_sun: Vector) -> None:
    """Leaves behind the camera that shade the parapet but for a pool of sun about the stones, so that their sparks show on the marble."""
    leaf = _scene.matte("Leaves", (0.05, 0.08, 0.03))
    around, far = 96, 1.5
    vertices = []
    for i in range(around):
        a = math.tau * i / around
        wave = 1.0 + 0.10 * math.sin(5 * a + 1.0) + 0.06 * math.sin(9 * a)
        vertices += [(0.066 * wave * math.cos(a), 0.029 * wave * math.sin(a), 0.0), (0.36 * math.cos(a), 0.26 * math.sin(a), 0.0)]
    faces = [(2 * i, 2 * i + 1, (2 * i + 3) % (2 * around), (2 * i + 2) % (2 * around)) for i in range(around)]
    shade = _scene.mesh("Leaves", vertices, faces, leaf)
    shade.matrix_world = (
        Matrix.Translation(Vector((0.004, 0.016, 0.008)) + far * to_sun) @ to_sun.to_track_quat("Z", "Y").to_matrix().to_4x4()
    )


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
        (shade, ((0.40, (0.42, 0.45, 0.50, 1)), (0.62, (1.35, 1.30, 1.22, 1)))),
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
    size = 1.45 * ring.STONE
    stone = _scene.stone("Diamond", round_brilliant(), size, _scene.gem("Diamond", "DIAMOND"))
    seat = top + 0.46 * size
    stone.location = (0.0, 0.0, seat)
    for i in range(4):
        angle = math.radians(45.0 + 90.0 * i)
        c, s = math.cos(angle), math.sin(angle)
        ring.claw((0.0004 * c, 0.0004 * s, top - 0.4e-3), (0.53 * size * c, 0.53 * size * s, seat + 0.10 * size), 0.00032, gold)
    bpy.context.view_layer.update()
    parts = [obj for obj in bpy.context.scene.objects if obj not in before]
    lean = Matrix.Rotation(math.radians(40.0), 4, "X")
    pose = Matrix.Rotation(math.radians(20.0), 4, "Z") @ lean
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
    away = Vector((math.sin(SUN_AZIMUTH) * math.cos(SUN_HEIGHT), math.cos(SUN_AZIMUTH) * math.cos(SUN_HEIGHT), -math.sin(SUN_HEIGHT)))
    land()
    fountain((-11.0, 23.6, GARDEN))
    arbour(-away)
    rain()
    clouds()
    _scene.lamp("Sun", "SUN", -away, (0.0, 0.0, 0.0), 6.0, angle=math.radians(0.53), color=(1.0, 0.93, 0.84))
    _scene.camera((0.001, -0.052, 0.036), (0.001, 0.0, 0.0262), 22.0, fstop=64.0, focus=(0.0, 0.0, 0.015))
    scene.camera.data.clip_end = 1e4
    scene.render.resolution_x, scene.render.resolution_y = 720, 576
    scene.view_settings.look = "AgX - Medium High Contrast"
    scene.view_settings.exposure = 0.6
    _scene.limit(scene, 192, 400_000, TIME_LIMIT)
    return scene


if __name__ == "__main__":
    _scene.run(build, "opal")
