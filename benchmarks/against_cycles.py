# SPDX-License-Identifier: GPL-3.0-or-later
"""Ordinary scenes beside Cycles: time to the relative MSE that Cycles has at 64 samples, each against a reference of its own.

A Cornell box, and balls under an HDRI without caustics to speak of; built by the functions of `tests/reference/test_scenes.py`. Runs inside
`tools/with_extension.py`, interleaved, medians taken; times are of the whole render, translation included.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import bpy
import numpy as np
from error import relative_mse

ROOT = Path(__file__).resolve().parent.parent
SIZE = (256, 192)
SAMPLES = 64
OPAL_SAMPLES = 16


def picture(engine: str, samples: int, seed: int) -> tuple[float, np.ndarray]:
    """Seconds and (height, width, 3) of one render of the scene at hand."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    if engine == "CYCLES":
        scene.cycles.samples, scene.cycles.seed = samples, seed
    else:
        scene.opal.samples_per_pass, scene.opal.passes, scene.opal.seed = min(OPAL_SAMPLES, samples), max(1, samples // OPAL_SAMPLES), seed
    image_settings = scene.render.image_settings
    if hasattr(image_settings, "media_type"):
        image_settings.media_type = "IMAGE"
    image_settings.file_format, image_settings.color_depth = "OPEN_EXR", "32"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = f"{folder}/picture.exr"
        started = time.perf_counter()
        bpy.ops.render.render(write_still=True)
        seconds = time.perf_counter() - started
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
    return seconds, pixels.reshape(SIZE[1], SIZE[0], 4)[..., :3].astype(np.float64)


def settle() -> None:
    """The same transport for both: 32 bounces, nothing clamped or blurred, no threshold, no photons where no caustic is."""
    scene = bpy.context.scene
    cycles = scene.cycles
    for kind in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(cycles, f"{kind}_bounces", 32)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.device = "CPU"
    scene.opal.max_depth, scene.opal.photons_per_pass = 33, 0


def measure(repeats: int, reference_samples: int) -> list[dict]:
    """One record a scene."""
    sys.path.insert(0, str(ROOT / "tests" / "reference"))
    import test_scenes as scenes

    records = []
    for name, build in (
        ("Cornell box", scenes.cornell_box),
        ("ball under an HDRI", lambda: scenes.ball_under_sky("courtyard", **scenes.BALLS["plastic"])),
    ):
        for collection in (bpy.data.objects, bpy.data.meshes, bpy.data.lights, bpy.data.cameras, bpy.data.materials, bpy.data.worlds):
            for block in list(collection):
                collection.remove(block)
        build()
        settle()
        references = {e: picture(e, reference_samples, 1000)[1] for e in ("CYCLES", "OPAL")}
        # A picture without samples to speak of tells what of a render's time is not sampling.
        overhead = {e: picture(e, 1, 1)[0] for e in references}
        runs = {e: [] for e in references}
        for repeat in range(repeats):
            for engine in references:
                seconds, image = picture(engine, SAMPLES, repeat + 1)
                # The reference has noise of its own, 1/n of that of a picture with n times fewer samples.
                error = relative_mse(image, references[engine]) / (1 + SAMPLES / reference_samples)
                runs[engine].append((seconds, error))
        times = {e: median(s for s, _ in r) for e, r in runs.items()}
        errors = {e: median(x for _, x in r) for e, r in runs.items()}
        needed = overhead["OPAL"] + max(times["OPAL"] - overhead["OPAL"], 1e-3) * errors["OPAL"] / errors["CYCLES"]
        records.append(
            {
                "scene": name,
                "cycles_seconds": times["CYCLES"],
                "cycles_error": errors["CYCLES"],
                "opal_seconds_at_64": times["OPAL"],
                "opal_error_at_64": errors["OPAL"],
                "opal_seconds_to_equal_error": needed,
                "ratio": needed / times["CYCLES"],
                "mean_ratio": [float(v) for v in references["OPAL"].mean(axis=(0, 1)) / references["CYCLES"].mean(axis=(0, 1))],
            }
        )
    return records


def translation() -> dict:
    """Seconds from pressing render to the end of a picture of 16 x 16 pixels and one sample, with a million triangles in the scene."""
    from rays import terrain

    for block in list(bpy.data.objects):
        bpy.data.objects.remove(block)
    corners, faces = terrain(1_000_000)
    mesh = bpy.data.meshes.new("terrain")
    mesh.vertices.add(len(corners))
    mesh.vertices.foreach_set("co", corners.ravel())
    mesh.loops.add(faces.size)
    mesh.loops.foreach_set("vertex_index", faces.ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, 3, dtype=np.int32))
    mesh.update()
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("terrain", mesh))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0, 0, 3)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 16
    settle()
    seconds = {e: picture_time(e) for e in ("CYCLES", "OPAL")}
    return {
        "what": "a million triangles, translated, built and one sample",
        "triangles": len(faces),
        "opal_seconds": seconds["OPAL"],
        "cycles_seconds": seconds["CYCLES"],
    }


def picture_time(engine: str) -> float:
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.cycles.samples = scene.opal.samples_per_pass = scene.opal.passes = 1
    started = time.perf_counter()
    bpy.ops.render.render()
    return time.perf_counter() - started


def report(records: list[dict]) -> None:
    print("\nbeside Cycles at 64 samples")
    for r in records:
        if "ratio" in r:
            print(
                f"  {r['scene']:20s} Cycles {r['cycles_seconds']:.2f} s to {r['cycles_error']:.3g}; Opal {r['opal_seconds_at_64']:.2f} s to "
                f"{r['opal_error_at_64']:.3g}, so {r['opal_seconds_to_equal_error']:.2f} s: ratio {r['ratio']:.2f} (target 1.5); mean {r['mean_ratio']}"
            )
        else:
            print(f"  {r['what']}: Opal {r['opal_seconds']:.2f} s, Cycles {r['cycles_seconds']:.2f} s")
