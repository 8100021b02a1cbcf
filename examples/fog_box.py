# SPDX-License-Identifier: GPL-3.0-or-later
"""The Cornell box full of fog under a directed light, as three pictures of one render: the things alone, the medium alone, and both.

The fog box of the report of 2013, extinction 0.5 and a light that goes straight down. All three come from the render's passes: the pass
Medium holds what the fog scattered towards the camera, Combined less Medium what the things did, seen through the fog. The walls' red and
green bleed into the fog. Written beside the picture: `fog_box_things.png` and `fog_box_medium.png`.
"""

import math
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.append(str(Path(__file__).resolve().parent))
import _scene

SIDE = 2.0
"""Of the box, m."""
EXTINCTION = 0.5


def room() -> None:
    """White, red and green walls, open to the camera."""
    white, red, green = (
        _scene.matte(name, colour)
        for name, colour in (("White", (0.75, 0.75, 0.75)), ("Red", (0.63, 0.06, 0.05)), ("Green", (0.12, 0.48, 0.10)))
    )
    w = 0.5 * SIDE
    for name, corners, material in (
        ("Floor", [(-w, -w, 0), (w, -w, 0), (w, w, 0), (-w, w, 0)], white),
        ("Ceiling", [(-w, -w, SIDE), (-w, w, SIDE), (w, w, SIDE), (w, -w, SIDE)], white),
        ("Back", [(-w, w, 0), (w, w, 0), (w, w, SIDE), (-w, w, SIDE)], white),
        ("Left", [(-w, -w, 0), (-w, w, 0), (-w, w, SIDE), (-w, -w, SIDE)], red),
        ("Right", [(w, -w, 0), (w, -w, SIDE), (w, w, SIDE), (w, w, 0)], green),
    ):
        _scene.mesh(name, corners, [(0, 1, 2, 3)], material)


def build() -> bpy.types.Scene:
    """Make the scene and return it."""
    scene = _scene.empty()
    scene.unit_settings.length_unit = "METERS"
    room()
    inside = 0.5 * SIDE - 1e-3
    fog = _scene.medium("Fog", EXTINCTION, (0.95, 0.95, 0.95))
    _scene.box("Fog", (-inside, -inside, 1e-3), (inside, inside, SIDE - 1e-3), fog)
    _scene.sphere("Glass ball", (0.42, -0.28, 0.36), 0.35, _scene.glass("Glass", 1.5))
    block = _scene.box("Block", (-0.30, -0.30, 0.0), (0.30, 0.30, 1.15), _scene.matte("Block", (0.75, 0.75, 0.75)))
    block.location, block.rotation_euler = (-0.38, 0.36, 2e-3), (0.0, 0.0, math.radians(20.0))
    _scene.lamp(
        "Directed light",
        "SPOT",
        (0.0, 0.0, SIDE - 0.02),
        (0.0, 0.0, 0.0),
        220.0,
        spot_size=math.radians(70),
        spot_blend=0.1,
        shadow_soft_size=0.05,
    )
    _scene.plain_world((0.0, 0.0, 0.0), 0.0)
    _scene.camera((0.0, -5.2, 1.0), (0.0, 0.0, 1.0), 60.0)
    scene.render.resolution_x, scene.render.resolution_y = 640, 360
    # The walls' light by photons: many for surfaces, which take them cheaply, few for the fog, where each flight is a beam. The two are
    # counted apart and not weighed against each other. What scatters twice has no edges that a wide kernel
    # would blur; the ball's faint focus in the fog has, and is blurred in the first passes.
    _scene.limit(
        scene,
        30,
        200_000,
        samples_per_pass=2,
        use_adaptive_sampling=False,
        photons_carry="INDIRECT",
        volume_photons_per_pass=3_000,
        volume_radius=0.12,
    )
    if hasattr(scene, "opal"):
        scene.opal.denoise = False  # the parts are denoised by themselves
        layer = scene.view_layers[0].opal
        layer.use_pass_medium = layer.use_pass_albedo = scene.view_layers[0].use_pass_normal = True
    return scene


def parts(passes: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The pictures, linear, from the passes of one render: what the things and what the medium show, and both."""
    from opal_kernels import denoise

    medium, guides = passes["Medium"], (passes["Albedo"], passes["Normal"])
    found = {"things": passes["Combined"][..., :3] - medium, "medium": medium}
    if not denoise.unavailable():
        found = {name: denoise.denoise(np.ascontiguousarray(picture), *guides) for name, picture in found.items()}
    return {**found, "both": found["things"] + found["medium"]}


def write_parts(scene: bpy.types.Scene, path: Path) -> None:
    """Writes the three pictures: both to `path`, the parts beside it."""
    for name, picture in parts(_scene.passes_of_render(scene, path.with_suffix(".exr"))).items():
        place = path if name == "both" else path.with_name(f"{path.stem}_{name}.png")
        _scene.write_picture(scene, picture, place)
        print(place, flush=True)


if __name__ == "__main__":
    _scene.run(build, "fog_box", write_parts)
