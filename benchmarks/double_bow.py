# SPDX-License-Identifier: GPL-3.0-or-later
"""A double bow over a landscape, 960 x 540: seconds, and how much noise an eye could see.

    make bench ARGS="double-bow"
    .venv/bin/python tools/with_extension.py benchmarks/double_bow.py [rainbow] [rainbow_horizon] [--percent 100]

The example is rendered with all the passes that it asks for, twice with different random numbers, without its time limit: a slow machine shows in the
seconds, not in the noise. What differs between the two pictures is noise: its root mean
square over sky and land is given in steps of an 8-bit picture, of which an eye sees one or two at best in an even field; neighbouring pixels'
means over 3 x 3 show the blotches that a denoiser may leave.
"""

from __future__ import annotations

import argparse
import importlib
import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
SCENES = ("rainbow", "rainbow_horizon")


def picture(scene: bpy.types.Scene, seed: int, path: Path) -> tuple[np.ndarray, float]:
    """8-bit values as they are shown, and seconds."""
    scene.opal.seed = seed
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(path)
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    seconds = time.perf_counter() - start
    image = bpy.data.images.load(str(path))
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    bpy.data.images.remove(image)
    return 255.0 * pixels.reshape(height, width, -1)[..., :3], seconds


def measure(name: str, percent: int) -> dict:
    """Seconds of the first picture and of the second (whose table is at hand), and the noise of one."""
    scene = importlib.import_module(name).build()
    scene.render.engine = "OPAL"
    scene.render.resolution_percentage = percent
    limit, scene.opal.time_limit = scene.opal.time_limit, 0.0
    with tempfile.TemporaryDirectory() as folder:
        (one, first), (two, second) = (picture(scene, seed, Path(folder) / f"{seed}.png") for seed in (1, 2))
    noise = (one - two) / np.sqrt(2)
    rows, columns = noise.shape[0] // 3 * 3, noise.shape[1] // 3 * 3
    blotches = noise[:rows, :columns].reshape(rows // 3, 3, columns // 3, 3, 3).mean(axis=(1, 3))
    half = noise.shape[0] * 2 // 5
    return {
        "scene": name,
        "size": f"{one.shape[1]} x {one.shape[0]}",
        "passes": scene.opal.passes,
        "limit": limit,
        "seconds": first,
        "again": second,
        "sky": float(np.sqrt((noise[half:] ** 2).mean())),
        "land": float(np.sqrt((noise[:half] ** 2).mean())),
        "blotches": float(np.sqrt((blotches**2).mean())),
    }


def report(records: list[dict]) -> None:
    """One line a scene."""
    for row in records:
        over = (
            ""
            if row["seconds"] <= row["limit"]
            else f", beyond the example's own limit of {row['limit']:.0f} s, which would have ended it before"
        )
        print(
            f"{row['scene']} {row['size']}, {row['passes']} passes: {row['seconds']:.1f} s, {row['again']:.1f} s with its table at hand{over}; "
            f"noise in 8-bit steps: sky {row['sky']:.2f}, land {row['land']:.2f}, blotches {row['blotches']:.2f}",
            flush=True,
        )


def measure_all(names: list[str] | tuple[str, ...] = SCENES, percent: int = 100) -> list[dict]:
    """A record a scene."""
    sys.path.insert(0, str(ROOT / "examples"))
    return [measure(name, percent) for name in names]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=list(SCENES))
    parser.add_argument("--percent", type=int, default=100)
    options = parser.parse_args()
    report(measure_all(options.scenes, options.percent))


if __name__ == "__main__":
    main()
