# SPDX-License-Identifier: GPL-3.0-or-later
"""Dispersed caustics: time to relative MSE 0.01 beside LuxCore and Mitsuba, runs interleaved, medians taken.

What counts are pixels that see the floor at first hand: glints of the lamp in the stone itself are found by some of the methods
only. For the prism it is the caustic's pixels alone, so that black floor does not decide. References are cached in `.cache/`.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
from caustic_scenes import SCENES, SIZE, axes
from error import bright, relative_mse, time_to

HERE = Path(__file__).resolve().parent
CACHE = HERE / ".cache"
TARGET = 0.01
METHODS = (("opal", "photons"), ("luxcore", "hybrid"), ("luxcore", "bidirectional"), ("mitsuba", "ptracer"), ("mitsuba", "path"))


def run(renderer: str, method: str, scene: str, seed: int, times: list[float], output: Path) -> tuple[np.ndarray, np.ndarray]:
    """Seconds (n,) and pictures (n, height, width, 3) of one run in a process of its own."""
    output.parent.mkdir(exist_ok=True)
    command = [sys.executable, str(HERE / "caustic_run.py"), renderer, method, scene, str(seed), str(output), *map(str, times)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{renderer} {method} on {scene} failed ({done.returncode}): {done.stderr.strip().splitlines()[-1:]}")
    with np.load(output) as file:
        return file["seconds"], file["images"].astype(np.float64)


def sees_floor(description) -> np.ndarray:
    """Pixels (height, width), rows from the top down, none of whose corners sees anything but the floor."""
    from opal_kernels.scene import Scene

    right, up, back = axes(description.eye, description.target)
    half = np.tan(0.5 * description.field_of_view)
    grid = np.linspace(-half, half, SIZE + 1)
    x, y = np.meshgrid(grid, grid[::-1])
    rays = x[..., None] * right + y[..., None] * up - back
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    with Scene() as scene:
        scene.add_instances(scene.add_mesh(description.glass.corners, description.glass.triangles), [np.eye(4)])
        scene.commit()
        hit = scene.intersect(np.broadcast_to(description.eye, (rays.size // 3, 3)), rays.reshape(-1, 3))["distance"]
    free = ~np.isfinite(hit).reshape(SIZE + 1, SIZE + 1)
    return free[:-1, :-1] & free[1:, :-1] & free[:-1, 1:] & free[1:, 1:]


def measure(scenes: list[str], seconds: float, repeats: int, reference_seconds: float) -> list[dict]:
    """One record a scene and method: median time to the target, error reached, mean of the reference over what counts."""
    records = []
    for scene in scenes:
        floor = sees_floor(SCENES[scene]())
        references, counted, curves = {}, {}, {m: [] for m in METHODS}
        for renderer, method in METHODS:
            path = CACHE / f"{scene}-{renderer}-{method}-{reference_seconds:g}.npz"
            if path.exists():
                with np.load(path) as file:
                    picture = file["images"][-1].astype(np.float64)
            else:
                picture = run(renderer, method, scene, 1000, [reference_seconds], path)[1][-1]
            references[renderer, method] = picture
            counted[renderer, method] = floor & bright(np.where(floor[..., None], picture, 0)) if scene == "prism" else floor
        times = [seconds * f for f in (0.25, 0.5, 1.0)]
        for repeat in range(repeats):
            for key in METHODS:
                t, images = run(*key, scene, repeat + 1, times, CACHE / "run.npz")
                errors = [relative_mse(i, references[key], counted[key]) for i in images]
                curves[key].append((time_to(TARGET, t, np.array(errors)), t[-1], errors[-1]))
        # Means over the same pixels for everybody: those that the prism's own caustic lights in Opal's reference.
        common = counted[METHODS[0]]
        for key in METHODS:
            needed, reached = np.array([c[0] for c in curves[key]]), np.array([c[2] for c in curves[key]])
            records.append(
                {
                    "scene": scene,
                    "renderer": " ".join(key),
                    "seconds_to_0.01": float(np.median(needed)),
                    "fastest": float(needed.min()),
                    "slowest": float(needed.max()),
                    "ran_seconds": float(np.median([c[1] for c in curves[key]])),
                    "error_reached": float(np.median(reached)),
                    "mean_rgb": [float(v) for v in references[key][common].mean(axis=0)],
                }
            )
    return records


def report(records: list[dict]) -> None:
    for scene in dict.fromkeys(r["scene"] for r in records):
        here = [r for r in records if r["scene"] == scene]
        ours, best = here[0], min(here[1:], key=lambda r: r["seconds_to_0.01"])
        print(f"\n{scene}: time to relative MSE {TARGET}")
        for r in here:
            mean = ", ".join(f"{v:.4g}" for v in r["mean_rgb"])
            print(
                f"  {r['renderer']:22s} {r['seconds_to_0.01']:9.1f} s  ({r['fastest']:.1f} to {r['slowest']:.1f}; reached "
                f"{r['error_reached']:.2g} in {r['ran_seconds']:.0f} s)   mean {mean}"
            )
        ratio = best["seconds_to_0.01"] / ours["seconds_to_0.01"]
        print(f"  Opal is {ratio:.2f} times as fast as the best of them, {best['renderer']}" + (" (a tie)" if 0.5 < ratio < 2 else ""))
