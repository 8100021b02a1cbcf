# SPDX-License-Identifier: GPL-3.0-or-later
"""Looks at the rendered view value for value: its colours beside a saved picture's, and where it draws a border.

    blender --python tests/ui/view.py -- ZIP FOLDER

Writes its pictures and `result.json` into FOLDER. Any exception is written there too, and Blender quits either way.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.append(str(Path(__file__).resolve().parent))
import window as w  # noqa: E402

RESULT = w.RESULT
# View transform, exposure, the radiance of what fills the frame, and whether the view looks through the camera or is free.
LOOKS = (
    ("Standard", 0.0, (0.7, 0.25, 0.05), "PERSP"),
    ("AgX", 1.0, (0.05, 0.3, 0.8), "CAMERA"),
)
# What is marked with Ctrl B, in pixels of the view: left, bottom, right, top; how much round it is looked at.
MARKED, AROUND = (400, 300, 560, 400), 40
# How far a display value may be from a picture's to count as its colour.
NEAR = 0.1


def prepare():
    """A coloured glowing plane before the camera, and nothing else; returns the node that says how it glows."""
    scene = bpy.context.scene
    for obj in [o for o in bpy.data.objects if o.type != "CAMERA"]:
        bpy.data.objects.remove(obj)
    scene.render.engine = "OPAL"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 64, 36, 100
    scene.render.dither_intensity = 0.0
    scene.render.image_settings.file_format = "PNG"
    scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = 24, 1, 0
    scene.opal.use_adaptive_sampling = False
    scene.camera.location, scene.camera.rotation_euler = (0, 0, 5), (0, 0, 0)
    bpy.ops.mesh.primitive_plane_add(size=1000)
    material = bpy.data.materials.new("Glow")
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    bpy.context.object.data.materials.append(material)
    return shader


def mean(part):
    return [float(v) for v in part.reshape(-1, 3).mean(axis=0)]


def saved(transform):
    """Means of a picture's display values as F12 saves it."""
    scene = bpy.context.scene
    scene.render.filepath = str(w.FOLDER / f"{transform}_saved.png")
    bpy.ops.render.render(write_still=True)
    return mean(w.pixels(Path(scene.render.filepath)))


def region_of(view):
    return next(r for r in view.regions if r.type == "WINDOW")


def mark(view):
    """What Ctrl B and a drag of the mouse do."""
    left, bottom, right, top = MARKED
    with bpy.context.temp_override(window=w.window(), area=view, region=region_of(view)):
        bpy.ops.view3d.render_border(xmin=left, xmax=right, ymin=bottom, ymax=top)


def near(picture, colour):
    return np.abs(picture - np.array(colour)).max(axis=-1) < NEAR


def looked_at(view, name, is_there, seconds=20.0):
    """Takes pictures of what lies in and round the marked part until one is as expected and as the one before; the last."""
    corner = np.array((region_of(view).x, region_of(view).y) * 2)
    box = np.array(MARKED) + corner + AROUND * np.array((-1, -1, 1, 1))
    end, before, now = time.monotonic() + seconds, None, None
    while now is None or (time.monotonic() < end and not (is_there(now) and np.array_equal(before, now))):
        yield 0.2
        before, now = now, w.pixels(w.screenshot(name, tuple(int(edge) for edge in box)))
    return now


def place_of(picture, colour):
    """Left, bottom, right, top of what has a colour, in pixels of the view (ends excluded), and which part of that has it."""
    there = near(picture, colour)
    columns, rows = np.flatnonzero(there.any(axis=0)), np.flatnonzero(there.any(axis=1))
    if not len(columns):
        return {"edges": [], "filled": 0.0}
    x0, y0, x1, y1 = int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1
    left, bottom = MARKED[0] - AROUND, MARKED[1] - AROUND
    return {"edges": [x0 + left, y0 + bottom, x1 + left, y1 + bottom], "filled": float(there[y0:y1, x0:x1].mean())}


def look_through_a_border(view, shader, transform, exposure, radiance, perspective):
    """Mean display values of a saved picture and of what the view draws; where that is; how much values differ beyond it."""
    scene, space = bpy.context.scene, view.spaces.active
    scene.view_settings.view_transform, scene.view_settings.exposure = transform, exposure
    shader.inputs["Color"].default_value = (*radiance, 1)
    found = RESULT[transform] = {"saved": saved(transform)}
    space.region_3d.view_perspective = perspective
    mark(view)
    space.shading.type = "RENDERED"
    picture = yield from looked_at(view, f"{transform}_border", lambda p: near(p, found["saved"]).any())
    inner, outer = AROUND + 2, AROUND - 2  # Blender draws dashes along the border
    found["shown"] = mean(picture[inner:-inner, inner:-inner])
    found["place"] = place_of(picture, found["saved"])
    beyond = np.ones(picture.shape[:2], bool)
    beyond[outer:-outer, outer:-outer] = False
    found["beyond"] = float(np.ptp(picture[beyond], axis=0).max())
    space.shading.type = "SOLID"


def look_at_all_again(view):
    """The border's checkbox is cleared while the view through the camera shows it."""
    colour, space = RESULT["AgX"]["saved"], view.spaces.active
    bpy.context.scene.opal.passes = 1
    space.shading.type = "RENDERED"
    yield from looked_at(view, "part", lambda p: near(p, colour).any())
    bpy.context.scene.render.use_border = False
    picture = yield from looked_at(view, "whole", lambda p: near(p, colour)[:AROUND].any())
    RESULT["whole"] = place_of(picture, colour)


def steps():
    yield 0.5
    with bpy.context.temp_override(window=w.window()):
        w.install()
    shader, view = prepare(), w.area("VIEW_3D")
    space = view.spaces.active
    space.overlay.show_overlays = space.show_gizmo = False
    yield 0.2
    for look in LOOKS:
        yield from look_through_a_border(view, shader, *look)
    yield from look_at_all_again(view)


w.run(steps())
