# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders that come to no picture, one after the other, written and saved as OpenEXR; prints what the files hold as JSON.

    python tools/with_extension.py tests/addon/render_to_nothing.py FOLDER

A process of its own, because Blender may end on such a file. A render is stopped by an engine whose person presses Escape at once.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.append(str(Path(__file__).resolve().parent))
import stage  # noqa: E402

FOLDER = Path(sys.argv[-1])
MARK = "RESULT "
final_render = stage.addon("final_render")
Render = final_render._FinalRender


class Pressed:
    """An engine whose person has pressed Escape."""

    def __init__(self, engine):
        self._engine = engine

    def test_break(self):
        return True

    def __getattr__(self, name):
        return getattr(self._engine, name)


class Stopped(Render):
    def __init__(self, engine, *arguments):
        super().__init__(Pressed(engine), *arguments)


class Failing(Render):
    """Something breaks after there is a picture: that is the one to keep."""

    def _write_film(self, render):
        raise ValueError("the film is lost")


def prepare():
    """A plane of radiance 1 fills the frame."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = stage.scene(passes=1)
    stage.camera((0, 0, 5))
    stage.plane(size=20, material=stage.glowing())
    image_settings = scene.render.image_settings
    if hasattr(image_settings, "media_type"):
        image_settings.media_type = "IMAGE"
    image_settings.file_format, image_settings.color_depth = "OPEN_EXR", "32"
    return scene


def facts(path):
    """Size, mean colour and mean alpha of an image file."""
    image = bpy.data.images.load(str(path), check_existing=False)
    pixels = np.array(image.pixels[:]).reshape(-1, 4)
    size = list(image.size)
    bpy.data.images.remove(image)
    return {"size": size, "colour": float(pixels[:, :3].mean()), "alpha": float(pixels[:, 3].mean())}


def written(scene, name):
    scene.render.filepath = str(FOLDER / f"{name}.exr")
    bpy.ops.render.render(write_still=True)
    return facts(FOLDER / f"{name}.exr")


def refused(name):
    """What a render says that is refused, and what the image editor's Save As writes of it."""
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        said = str(error)
    bpy.data.images["Render Result"].save_render(str(FOLDER / f"{name}.exr"))
    return facts(FOLDER / f"{name}.exr") | {"said": said}


def of_two_layers(scene):
    """Names of the passes of a stopped render's layers, and their greatest value."""
    scene.view_layers.new("Second").use_pass_z = True
    layers = {}
    stage.render_passes(FOLDER)
    for layer, passes in stage.read_layers(FOLDER / "render.exr").items():
        layers[layer] = {name: float(np.abs(pixels).max()) for name, pixels in passes.items()}
    scene.view_layers.remove(scene.view_layers["Second"])
    return layers


def main():
    scene, found = prepare(), {}
    final_render._FinalRender = Stopped
    found["stopped"] = written(scene, "stopped")
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_max_x = 0.5
    found["stopped_border"] = written(scene, "stopped_border")
    scene.render.use_border = False
    final_render._FinalRender = Failing
    found["failed_later"] = refused("failed_later")
    final_render._FinalRender = Render
    scene.camera.data.shift_x = float("nan")
    found["no_camera"] = refused("no_camera")
    scene.camera.data.shift_x = 0.0
    name = final_render.__name__
    sys.modules[name] = None
    found["no_kernels"] = refused("no_kernels")
    sys.modules[name] = final_render
    found["afterwards"] = written(scene, "afterwards")
    final_render._FinalRender = Stopped
    found["layers"] = of_two_layers(scene)
    print(MARK + json.dumps(found), flush=True)
    os._exit(0)  # bpy 4.5 hangs at its own end


main()
