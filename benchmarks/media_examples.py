# SPDX-License-Identifier: GPL-3.0-or-later
"""The three volume estimates on the examples of media, at equal processor time: what the default of `volume_estimate` is chosen by.

Each example is rendered small by each estimate for the same time, denoised as the examples are, so that what counts is what an artist sees:
the noise of photons and the blur of shafts and foci, not the fine grain of camera paths that all three share. The reference is the mean of
longer runs of `BEAM_RADIANCE` and `BEAMS` with other seeds and a kernel as narrow as a pixel, so that it lacks the blur of either. What is
compared is the relative MSE times the processor time, and its geometric mean over the examples. Runs inside `tools/with_extension.py`.
"""

from __future__ import annotations

import importlib
import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np
from error import relative_mse

ROOT = Path(__file__).resolve().parent.parent
SCENES = ("fog_box", "glass_ball_in_fog", "prism_in_mist", "stained_glass")
ESTIMATES = ("POINTS", "BEAM_RADIANCE", "BEAMS")
SHARP = {"fog_box": 0.03, "glass_ball_in_fog": 0.02, "prism_in_mist": 0.006, "stained_glass": 0.03}
"""Radius of the references' kernels in the first pass, m: about a pixel."""
PERCENT = 25


def picture(name: str, estimate: str, seconds: float, seed: int, path: Path, radius: float = 0.0) -> tuple[float, np.ndarray]:
    """Processor seconds of one render of an example and its linear picture, (height, width, 3)."""
    scene = importlib.import_module(name).build()
    scene.render.engine = "OPAL"
    scene.render.resolution_percentage = PERCENT
    opal = scene.opal
    opal.denoise, opal.passes, opal.seed, opal.time_limit = True, 4096, seed, seconds
    opal.volume_estimate, opal.volume_radius = estimate, radius
    image_settings = scene.render.image_settings
    if hasattr(image_settings, "media_type"):
        image_settings.media_type = "IMAGE"
    image_settings.file_format, image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = str(path)
    started = time.process_time()
    bpy.ops.render.render(write_still=True)
    used = time.process_time() - started
    image = bpy.data.images.load(str(path))
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    bpy.data.images.remove(image)
    return used, pixels.reshape(height, width, 4)[..., :3].astype(np.float64)


def measure(seconds: float, scenes: tuple[str, ...] = SCENES, pictures: Path | None = None) -> list[dict]:
    """One record an example and estimate; with a folder the pictures stay there, to be looked at."""
    sys.path.insert(0, str(ROOT / "examples"))
    records = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pictures or Path(scratch)
        for name in scenes:
            longer = [
                picture(name, e, 2.0 * seconds, 1000 + i, folder / f"{name}-{e}-long.exr", SHARP[name])[1]
                for i, e in enumerate(ESTIMATES[1:])
            ]
            reference = np.mean(longer, axis=0)
            for estimate in ESTIMATES:
                used, image = picture(name, estimate, seconds, 1, folder / f"{name}-{estimate}.exr")
                records.append(
                    {"scene": name, "estimate": estimate, "seconds": used, "error": relative_mse(image, reference),
                     "mean_ratio": float(image.mean() / reference.mean())}
                )  # fmt: skip
    return records


def report(records: list[dict]) -> None:
    """A table in Markdown: error times processor time as a multiple of the least, and in brackets the relative MSE."""
    names = list(dict.fromkeys(r["scene"] for r in records))
    cost = {(r["scene"], r["estimate"]): r["seconds"] * r["error"] for r in records}
    error = {(r["scene"], r["estimate"]): r["error"] for r in records}
    print(f"| | {' | '.join(names)} | geometric mean |")
    print("|---" * (len(names) + 2) + "|")
    for estimate in ESTIMATES:
        times = [cost[n, estimate] / min(cost[n, e] for e in ESTIMATES) for n in names]
        cells = [f"{t:.2f} ({error[n, estimate]:.4f})" for n, t in zip(names, times, strict=True)]
        print(f"| {estimate} | {' | '.join(cells)} | {np.exp(np.mean(np.log(times))):.2f} |")
