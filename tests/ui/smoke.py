# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes a small fire with Blender's own simulation and renders its domain with Opal.

    blender --background --python tests/ui/smoke.py -- ZIP FOLDER

Writes into FOLDER the picture, and `result.json` with what the grids hold and what the picture shows. bpy as a module cannot bake: its
Mantaflow ends the process.
"""

from __future__ import annotations

import json
import os
import sys
import traceback
from pathlib import Path

import bpy
import numpy as np

ZIP, FOLDER = sys.argv[-2], Path(sys.argv[-1])
FRAMES, CELLS, SIZE, SKY = 6, 24, 64, 0.3


def bake():
    """A domain of 2 m about the origin, a burning ball in its lower half; the domain object."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=2)
    domain = bpy.context.object
    modifier = domain.modifiers.new("Fluid", "FLUID")
    modifier.fluid_type = "DOMAIN"
    settings = modifier.domain_settings
    settings.domain_type, settings.resolution_max, settings.use_adaptive_domain = "GAS", CELLS, True
    settings.cache_directory, settings.cache_type = str(FOLDER / "cache"), "ALL"
    settings.cache_frame_start, settings.cache_frame_end = 1, FRAMES
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.4, location=(0, 0, -0.5))
    source = bpy.context.object
    source.hide_render = True
    flow = source.modifiers.new("Fluid", "FLUID")
    flow.fluid_type = "FLOW"
    flow.flow_settings.flow_type, flow.flow_settings.flow_behavior = "BOTH", "INFLOW"
    bpy.context.scene.frame_end = FRAMES
    bpy.ops.object.select_all(action="DESELECT")
    domain.select_set(True)
    bpy.context.view_layer.objects.active = domain
    bpy.ops.fluid.bake_all()
    bpy.context.scene.frame_set(FRAMES)
    return domain


def light_and_look(domain):
    """A sun, an even sky, a camera in front; the domain's material by nodes, absorbing and glowing by temperature."""
    material = bpy.data.materials.new("fire")
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new("ShaderNodeVolumePrincipled"), tree.nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Density"].default_value = 5.0
    tree.links.new(shader.outputs[0], output.inputs["Volume"])
    domain.data.materials.append(material)
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    if world.node_tree is None:
        world.use_nodes = True
    next(n for n in world.node_tree.nodes if n.type == "BACKGROUND").inputs["Color"].default_value = (SKY, SKY, SKY, 1)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (0, -5, 0), (np.pi / 2, 0, 0)
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2.0
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    return shader


def picture(name):
    scene = bpy.context.scene
    scene.render.engine = "OPAL"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = 4, 16, 0
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(FOLDER / f"{name}.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.empty(SIZE * SIZE * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(SIZE, SIZE, 4)[..., :3]


def expected_picture(domain):
    """The sky times exp(-5 x density summed along y), by the simulation's own numbers, where its cells are (SIZE, SIZE)."""
    evaluated = domain.evaluated_get(bpy.context.evaluated_depsgraph_get())
    settings = evaluated.modifiers["Fluid"].domain_settings
    nx, ny, nz = settings.domain_resolution  # an adaptive domain has fewer cells than were asked for, in a smaller box
    box = np.array(evaluated.bound_box)
    low, size = box.min(axis=0), np.ptp(box, axis=0)
    density = np.array(settings.density_grid, np.float32).reshape(nz, ny, nx)
    depth = 5.0 * density.sum(axis=1) * size[1] / ny  # (z, x)
    edge = (np.arange(SIZE) + 0.5) / SIZE * 2 - 1  # the camera sees 2 m
    x, z = (edge - low[0]) / size[0] * nx, (edge - low[2]) / size[2] * nz
    inside = np.ix_((z >= 0) & (z < nz), (x >= 0) & (x < nx))
    picture = np.full((SIZE, SIZE), SKY)
    picture[inside] *= np.exp(-depth[np.ix_(z[(z >= 0) & (z < nz)].astype(int), x[(x >= 0) & (x < nx)].astype(int))])
    return picture, (nx, ny, nz)


def main():
    bpy.ops.extensions.package_install_files(filepath=ZIP, repo="user_default", enable_on_install=True)
    domain = bake()
    bpy.ops.preferences.addon_enable(module="bl_ext.user_default.opal")
    shader = light_and_look(domain)
    shader.inputs["Color"].default_value = (0, 0, 0, 1)  # absorbs only: the picture is the sky times the transmittance
    expected, cells = expected_picture(domain)
    black = picture("absorbing").mean(axis=-1)
    shader.inputs["Blackbody Intensity"].default_value = 1.0
    fire = picture("glowing")
    shader.inputs["Blackbody Intensity"].default_value = 0.0
    domain.scale, bpy.context.scene.camera.data.ortho_scale = (2, 2, 2), 4.0
    doubled = picture("doubled")
    return {
        "cells": list(cells),
        "darkest": float(expected.min()),
        "absorbing_mean": float(black.mean()),
        "expected_mean": float(expected.mean()),
        "correlation": float(np.corrcoef(black.ravel(), expected.ravel())[0, 1]),
        "doubled_mean": float(doubled.mean()),
        "expected_doubled_mean": float((expected**2 / SKY).mean()),
        "glow": [float(c) for c in (fire - black[..., None]).clip(0).reshape(-1, 3).mean(axis=0)],
    }


try:
    RESULT = main()
except Exception:
    RESULT = {"error": traceback.format_exc()}
(FOLDER / "result.json").write_text(json.dumps(RESULT))
sys.stdout.flush()
os._exit(0)
