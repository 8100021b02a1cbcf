# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's own scenes by `opal.compare_cycles`: the figures that the guide shows.

Each example is built from nothing and rendered small by both engines, Cycles for as many seconds as Opal took, Opal's materials by their
twins. What differs is what Opal exists for (dispersion, caustics, bows); where a scene holds none of it the pictures agree. Media alone are
compared besides, region by region. Runs inside `tools/with_extension.py`.
"""

from __future__ import annotations

import importlib
import json
import math
import sys
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parent.parent
# Name of the example and what Cycles' twin of it lacks.
SCENES = {
    "glass_cube": "nothing but the cube's caustic, which it finds slowly",
    "cloud_milk_fire": "nothing",
    "two_spheres": "their caustics",
    "diamond": "fire and caustics",
    "prism": "the spectrum",
    "rainbow": "the bow",
}
VOLUMES = ("cloud_milk_fire",)
PERCENT, PASSES = 40, 4


def compare(name: str, mode: str = "SCENE") -> dict:
    """The comparison of one example."""
    example = importlib.import_module(name)
    scene = example.build()
    scene.render.engine = "OPAL"
    scene.render.resolution_percentage = PERCENT
    scene.opal.passes, scene.opal.time_limit = PASSES, 0.0
    if bpy.ops.opal.compare_cycles(mode=mode, equal="TIME") != {"FINISHED"}:
        raise RuntimeError(f"The comparison of {name} failed")
    return {"scene": name, **{k: v for k, v in json.loads(scene["opal_comparison"]).items() if k != "scene"}}


def measure(scenes: list[str] | None = None) -> list[dict]:
    """One record an example, and one for each that is compared by its media alone."""
    sys.path.insert(0, str(ROOT / "examples"))
    chosen = scenes or list(SCENES)
    return [compare(name) for name in chosen] + [compare(name, "VOLUMES") for name in VOLUMES if name in chosen]


def report(records: list[dict]) -> None:
    """A table in Markdown."""
    print("| scene | mean of Opal / Cycles (R G B) | PSNR | SSIM | FLIP | relative MSE | seconds | MB |")
    print("|---|---|---|---|---|---|---|---|")
    for r in records:
        ratio = " ".join("–" if v is None else f"{v:.3f}" for v in r["mean_ratio"])
        name = r["scene"] + (", media alone" if r["mode"] == "VOLUMES" else "")
        seconds = f"{r['seconds']['opal']:.0f} and {r['seconds']['cycles']:.0f}"
        flip = "–" if r["flip"] is None else f"{r['flip']:.3f}"
        memory = f"{r['memory']['opal'] / 2**20:.0f} and {r['memory']['cycles'] / 2**20:.0f}"
        figures = f"{r['psnr']:.1f} dB | {r['ssim']:.3f} | {flip} | {r['relative_mse']:.3g}"
        print(f"| {name} | {ratio} | {figures} | {seconds} | {memory} |")
        known = [region for region in r.get("regions", ()) if region["ratio"] is not None]
        if known:
            worst = max(known, key=lambda region: abs(math.log(max(region["ratio"], 1e-6))))
            print(f"  of {len(known)} regions the worst is {worst['ratio']:.4f} ± {worst['error']:.4f}")
