# SPDX-License-Identifier: GPL-3.0-or-later
"""A double bow over a landscape, 960 x 540: seconds, and how much noise an eye could see.

    .venv/bin/python tools/with_extension.py benchmarks/double_bow.py [rainbow] [rainbow_horizon] [--percent 100]

The example is rendered as it comes, twice with different random numbers. What differs between the two pictures is noise: its root mean
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
    with tempfile.TemporaryDirectory() as folder:
        (one, first), (two, second) = (picture(scene, seed, Path(folder) / f"{seed}.png") for seed in (1, 2))
    noise = (one - two) / np.sqrt(2)
    rows, columns = noise.shape[0] // 3 * 3, noise.shape[1] // 3 * 3
    blotches = noise[:rows, :columns].reshape(rows // 3, 3, columns // 3, 3, 3).mean(axis=(1, 3))
    half = noise.shape[0] * 2 // 5
    return {
        "scene": name,
        "size": f"{one.shape[1]} x {one.shape[0]}",
        "seconds": first,
        "again": second,
        "sky": float(np.sqrt((noise[half:] ** 2).mean())),
        "land": float(np.sqrt((noise[:half] ** 2).mean())),
        "blotches": float(np.sqrt((blotches**2).mean())),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=["rainbow", "rainbow_horizon"])
    parser.add_argument("--percent", type=int, default=100)
    options = parser.parse_args()
    sys.path.insert(0, str(ROOT / "examples"))
    for name in options.scenes:
        row = measure(name, options.percent)
        print(
            f"{row['scene']} {row['size']}: {row['seconds']:.1f} s, {row['again']:.1f} s with its table at hand; noise in 8-bit steps: "
            f"sky {row['sky']:.2f}, land {row['land']:.2f}, blotches {row['blotches']:.2f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
