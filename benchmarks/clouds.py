# SPDX-License-Identifier: GPL-3.0-or-later
"""A cloud of noise under a sun and a sky, thin to thick, beside Cycles: processor time to equal error.

The cloud of `examples/cloud_milk_fire.py`, alone and through its Cycles twin, rendered by both engines with two seeds, neither denoised
nor clamped. The error is that of two renders of one engine; paths average, so that time to equal error is time times squared error. The
pixels are those of the cloud. Runs inside `tools/with_extension.py`.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
EXTINCTIONS = (3.0, 12.0, 60.0)
"""Of the densest parts, 1/m; the cloud is 0.2 m across."""
SIZE = 192, 128
PASSES, SAMPLES = 16, 64


def cloud(extinction: float) -> bpy.types.Scene:
    """The example's cloud without its neighbours."""
    import cloud_milk_fire

    scene = cloud_milk_fire.build()
    for name in ("Milk", "Smoke"):
        bpy.data.objects.remove(bpy.data.objects[name])
    bpy.data.materials["Cloud"].opal.medium.extinction = extinction
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    opal, cycles = scene.opal, scene.cycles
    opal.denoise, opal.time_limit, opal.passes = False, 0.0, PASSES
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.sample_clamp_indirect, cycles.samples = 0.0, SAMPLES
    cycles.volume_bounces = cycles.max_bounces = 128
    return scene


def run(scene: bpy.types.Scene, engine: str, seed: int, folder: Path) -> tuple[float, np.ndarray]:
    """Processor seconds of one render, and the cloud's pixels."""
    scene.render.engine = engine
    scene.opal.seed = scene.cycles.seed = seed
    scene.render.filepath = str(folder / f"{engine}{seed}.exr")
    begun = os.times()
    bpy.ops.render.render(write_still=True)
    seconds = os.times().user - begun.user
    image = bpy.data.images.load(scene.render.filepath)
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    picture = pixels.reshape(height, width, 4)[..., :3].astype(np.float64)
    return seconds, picture[height // 3 : 2 * height // 3, width // 8 : 3 * width // 8]


def measure() -> list[dict]:
    """One record an extinction."""
    sys.path.insert(0, str(ROOT / "examples"))
    records = []
    for extinction in EXTINCTIONS:
        record = {"what": "cloud", "extinction": extinction}
        with tempfile.TemporaryDirectory() as folder:
            for engine in ("OPAL", "CYCLES"):
                scene = cloud(extinction)
                (first, a), (second, b) = (run(scene, engine, seed, Path(folder)) for seed in (1, 2))
                mean = 0.5 * (a + b).mean()
                error = float(((a - b) ** 2).mean() / 2 / mean**2)
                record[engine.lower()] = {"seconds": 0.5 * (first + second), "error": error, "mean": float(mean)}
        ours, theirs = record["opal"], record["cycles"]
        record["ratio"] = ours["seconds"] * ours["error"] / (theirs["seconds"] * theirs["error"])
        records.append(record)
    return records


def report(records: list[dict]) -> None:
    """A table in Markdown."""
    print("| extinction of the cloud | Opal: processor time, squared error | Cycles | Opal's time to equal error / Cycles' | means |")
    print("|---|---|---|---|---|")
    for r in records:
        ours, theirs = (f"{r[e]['seconds']:.1f} s, {r[e]['error']:.4f}" for e in ("opal", "cycles"))
        print(f"| {r['extinction']:g} /m | {ours} | {theirs} | {r['ratio']:.2f} | {r['opal']['mean'] / r['cycles']['mean']:.4f} |")
