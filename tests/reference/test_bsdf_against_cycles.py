# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes beside Cycles': the furnace's answer from four views, and the lobe's value under a distant sun.

All materials lie side by side as strips in one plane, so a view of all of them is one small render. Needs `bpy`.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "kernels"))
from bsdf_under_test import Bsdf, direction  # noqa: E402

GRAY, ROSE = (0.8, 0.5, 0.2), (0.9, 0.3, 0.6)
TANGENT = (1.0, 0.3, 0.0)
TILTED, LYING = (0.3, -0.4, 0.8), (0.8, 0.5, 0.25)  # as bump maps give; the second mirrors into the surface
VIEWS = (0, 30, 60, 80)
SUNS = ((10, 60), (50, -100), (50, 100), (75, 90), (75, 0))  # degrees from the normal and round it; the view is at -90
SHEEN_FIT = 0.012  # Cycles interpolates the sheen's parameters, Opal has polynomials through them (sheen_fit.inc)
PIXELS = 4  # a strip is this many wide and high; the inner ones are used

NODES = {
    "DIFFUSE": "ShaderNodeBsdfDiffuse", "GLOSSY": "ShaderNodeBsdfAnisotropic", "GLASS": "ShaderNodeBsdfGlass",
    "REFRACTION": "ShaderNodeBsdfRefraction", "METAL_F82": "ShaderNodeBsdfMetallic", "CONDUCTOR": "ShaderNodeBsdfMetallic",
    "PRINCIPLED": "ShaderNodeBsdfPrincipled", "SHEEN": "ShaderNodeBsdfSheen", "TRANSLUCENT": "ShaderNodeBsdfTranslucent",
}  # fmt: skip
SOCKETS = {
    "roughness": "Roughness", "ior": "IOR", "metallic": "Metallic", "alpha": "Alpha", "diffuse_roughness": "Diffuse Roughness",
    "specular": "Specular IOR Level", "transmission": "Transmission Weight", "coat": "Coat Weight", "coat_roughness": "Coat Roughness",
    "coat_ior": "Coat IOR", "sheen": "Sheen Weight", "sheen_roughness": "Sheen Roughness", "specular_tint": "Specular Tint",
    "coat_tint": "Coat Tint", "sheen_tint": "Sheen Tint", "tangent": "Tangent", "normal": "Normal",
}  # fmt: skip


def _cases():
    yield "translucent", "TRANSLUCENT", {}
    for r in (0, 0.3, 0.6, 1):
        many = {"roughness": r, "multiscatter": 1}
        yield f"diffuse {r}", "DIFFUSE", {"roughness": r}
        yield f"glossy {r}", "GLOSSY", many
        yield f"glossy once {r}", "GLOSSY", {"roughness": r}
        yield f"glass {r}", "GLASS", many | {"ior": 1.5}
        yield f"glass from inside {r}", "GLASS", many | {"ior": 1.5, "backfacing": 1}
        yield f"glass once {r}", "GLASS", {"roughness": r, "ior": 1.5}
        yield f"refraction {r}", "REFRACTION", {"roughness": r, "ior": 1.5}
        yield f"F82 {r}", "METAL_F82", many | {"color_2": (0.2, 0.9, 0.5)}
        yield f"conductor {r}", "CONDUCTOR", many | {"color": (0.2, 0.9, 1.1), "color_2": (3.1, 2.3, 2.2)}
        yield f"principled {r}", "PRINCIPLED", many | {"diffuse_roughness": r}
        yield f"principled once {r}", "PRINCIPLED", {"roughness": r, "ior": 1.8, "specular": 0.8}
        yield f"principled metal {r}", "PRINCIPLED", many | {"metallic": 0.7, "specular_tint": (0.3, 0.9, 0.5)}
        yield f"principled glass {r}", "PRINCIPLED", many | {"transmission": 0.8}
        yield f"principled glass from inside {r}", "PRINCIPLED", many | {"transmission": 1, "backfacing": 1}
        yield (
            f"principled coat {r}",
            "PRINCIPLED",
            many | {"roughness": 0.5, "coat_roughness": r, "coat": 0.8, "coat_tint": ROSE, "coat_ior": 1.7},
        )
    for r in (0.1, 0.3, 0.6, 1):
        yield f"sheen {r}", "SHEEN", {"roughness": r}
        yield (
            f"principled sheen {r}",
            "PRINCIPLED",
            {"roughness": 0.5, "multiscatter": 1, "sheen": 0.9, "sheen_roughness": r, "sheen_tint": ROSE},
        )
    for a in (-0.6, 0.7):
        yield f"glossy stretched {a}", "GLOSSY", {"roughness": 0.6, "multiscatter": 1, "anisotropy": a, "rotation": 0.1, "tangent": TANGENT}
    yield "F82 stretched", "METAL_F82", {"roughness": 0.6, "color_2": ROSE, "anisotropy": 0.7, "rotation": 0.1, "tangent": TANGENT}
    for name, normal in (("tilted", TILTED), ("lying", LYING)):
        normal = {"normal": tuple(np.array(normal) / np.linalg.norm(normal))}
        yield f"diffuse {name}", "DIFFUSE", {"roughness": 0.3} | normal
        yield f"lambert {name}", "DIFFUSE", normal
        yield f"glossy {name}", "GLOSSY", {"roughness": 0.5} | normal
        yield f"glass {name}", "GLASS", {"roughness": 0.5} | normal
        yield f"sheen {name}", "SHEEN", {"roughness": 0.5} | normal
        yield f"principled {name}", "PRINCIPLED", {"roughness": 0.4, "coat": 0.5, "coat_roughness": 0.3, "sheen": 0.4} | normal
    yield "principled stretched", "PRINCIPLED", {"roughness": 0.6, "metallic": 1, "anisotropy": 0.7, "rotation": 0.1, "tangent": TANGENT}


CASES = {name: (node, {"color": GRAY} | fields) for name, node, fields in _cases()}


def _material(name):
    node, fields = CASES[name]
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(NODES[node]), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    if node in ("GLOSSY", "GLASS", "METAL_F82", "CONDUCTOR", "PRINCIPLED"):
        shader.distribution = "MULTI_GGX" if fields.get("multiscatter") else "GGX"
    elif node == "REFRACTION":
        shader.distribution = "GGX"
    if node == "CONDUCTOR":
        shader.fresnel_type = "PHYSICAL_CONDUCTOR"
        shader.inputs["IOR"].default_value, shader.inputs["Extinction"].default_value = fields["color"], fields["color_2"]
    else:
        shader.inputs["Color" if "Color" in shader.inputs else "Base Color"].default_value = (*fields["color"], 1)
    if node == "METAL_F82":
        shader.fresnel_type = "F82"
        shader.inputs["Edge Tint"].default_value = (*fields["color_2"], 1)
    stretched = {"anisotropy": ("Anisotropy", "Anisotropic"), "rotation": ("Rotation", "Anisotropic Rotation")}
    for field, value in fields.items():
        socket = next((s for s in (SOCKETS.get(field), *stretched.get(field, ())) if s and s in shader.inputs), None)
        if socket is None:
            continue
        if field in ("tangent", "normal"):  # sockets without a value of their own
            vector = tree.nodes.new("ShaderNodeCombineXYZ")
            for i in range(3):
                vector.inputs[i].default_value = value[i]
            tree.links.new(vector.outputs[0], shader.inputs[socket])
        else:
            shader.inputs[socket].default_value = (*value, 1) if isinstance(value, tuple) else value
    return material


@pytest.fixture
def strips(tmp_path):
    """A function from (view angle, world radiance, sun direction or None, samples) to {case: RGB}."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    for i, name in enumerate(CASES):
        corners = [(i, -50, 0), (i + 1, -50, 0), (i + 1, 50, 0), (i, 50, 0)]
        if CASES[name][1].get("backfacing"):
            corners.reverse()
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
        mesh.materials.append(_material(name))
        scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    world = scene.world = bpy.data.worlds.new("furnace")
    if world.node_tree is None:
        world.use_nodes = True
    background = next(n for n in world.node_tree.nodes if n.type == "BACKGROUND")
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", len(CASES)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.angle = 0
    for thing in (camera, sun):
        scene.collection.objects.link(thing)
    scene.camera = camera
    render = scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = PIXELS * len(CASES), PIXELS, 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    cycles = scene.cycles
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_indirect = 0
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 0.01
    path = str(tmp_path / "strips.exr")
    middle = len(CASES) / 2

    def shoot(view, radiance, sun_direction, samples):
        camera.location = direction(view, -90) * 20 + (middle, 0, 0)
        camera.rotation_euler = (math.radians(view), 0, 0)
        background.inputs["Color"].default_value = (radiance, radiance, radiance, 1)
        sun.hide_render = sun_direction is None
        if sun_direction is not None:
            sun.data.energy = 1
            theta, phi = np.radians(sun_direction)
            sun.rotation_euler = (theta, 0, phi + math.pi / 2)
        cycles.samples = samples
        render.filepath = path
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(path, check_existing=False)
        pixels = np.array(image.pixels[:]).reshape(PIXELS, len(CASES), PIXELS, 4)
        bpy.data.images.remove(image)
        return dict(zip(CASES, pixels[1:-1, :, 1:-1, :3].mean(axis=(0, 2)), strict=True))

    return shoot


def _worst(found, expected, relative, absolute):
    """Lines for what differs by more than the tolerances."""
    lines = []
    for name in CASES:
        granted = absolute + (max(relative, SHEEN_FIT) if "sheen" in name else relative) * np.abs(expected[name])
        if (np.abs(found[name] - expected[name]) > granted).any():
            lines.append(f"{name}: Cycles {np.round(expected[name], 4)}, Opal {np.round(found[name], 4)}")
    return lines


@pytest.mark.parametrize("view", VIEWS)
def test_a_furnace_gets_back_what_cycles_gives(strips, view):
    """Noise of 4 pixels of 2048 samples: up to 0.002 (one standard error); four of them are granted."""
    cycles = strips(view, 1, None, 2048)
    opal = {name: Bsdf(node, direction(view, -90), **fields).furnace(1 << 14)[:3] for name, (node, fields) in CASES.items()}
    assert not (bad := _worst(opal, cycles, 0.002, 0.006)), "\n".join(bad)


@pytest.mark.parametrize("sun", SUNS)
def test_lobes_have_cycles_shape(strips, sun):
    """A distant sun of irradiance 1 shows f |cos|. No noise."""
    view, wi = 50, direction(*sun)
    cycles = strips(view, 0, sun, 4)
    opal = {name: Bsdf(node, direction(view, -90), **fields).eval(wi)[0][0, :3] for name, (node, fields) in CASES.items()}
    assert not (bad := _worst(opal, cycles, 2e-4, 2e-4)), "\n".join(bad)


def test_transmission_has_cycles_shape(strips):
    view, below = 50, (150, 80)
    cycles = strips(view, 0, below, 4)
    opal = {name: Bsdf(node, direction(view, -90), **fields).eval(direction(*below))[0][0, :3] for name, (node, fields) in CASES.items()}
    assert opal["glass once 0.6"][0] > 0.05
    assert not (bad := _worst(opal, cycles, 2e-4, 2e-4)), "\n".join(bad)
