# SPDX-License-Identifier: GPL-3.0-or-later
"""Media: the fog box of the report of 2013 with its own parameters, the three volume estimates at equal error, the search structure's
share of the photons' time, and the fog box beside Cycles.

The estimates are measured on three scenes: a beam (a lamp's light through a ball of glass in fog), the fog box, and a cloud of noise lit
through a window pane. Their reference is the mean of long runs of all three, so that it favours none; a run's error is what it has after
each pass. What is compared is the time to the error that the worst of the three has at the end.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from error import relative_mse, time_to

ROOT = Path(__file__).resolve().parent.parent
REPORT_SECONDS = 64 * 60 + 36
REPORT_SIZE = 512
SIZE = 64
ERROR = 0.01


def _tests() -> object:
    """The scenes of the tests, which build them from the kernels alone."""
    sys.path.insert(0, str(ROOT / "tests" / "kernels"))
    import test_media_estimates

    return test_media_estimates


def beam(scene) -> None:
    """A lamp of 5 cm, a ball of glass of 30 cm, fog."""
    from opal_kernels.descriptions import Light
    from transport_scenes import IDENTITY, looking_down, orthographic, placed, sphere

    t = _tests()
    t.fill(scene, (-2, -2, -2), (2, 2, 2), scene.add_medium(0.3, 0.95))
    corners, faces, normals = sphere(0.3, 64, 128)
    scene.add_instances(scene.add_mesh(corners, faces, corner_normals=normals), IDENTITY, [scene.add_gem(1.5)])
    scene.add_light(Light(power=60.0, radius=0.05, transform=placed(-1.5)[:3]))
    scene.set_camera(**orthographic(1.2, looking_down(5.0)))
    scene.commit()


def fog(scene) -> None:
    """The fog box."""
    _tests().report_box(scene)


def cloud(scene) -> None:
    """A cloud under a pane of glass through which its light comes."""
    from opal_kernels.descriptions import Density, Light, Phase, PhaseKind
    from transport_scenes import IDENTITY, box, placed

    t = _tests()
    forward = Phase(PhaseKind.HENYEY_GREENSTEIN, 0.5)
    medium = scene.add_medium(4.0, 0.9, forward, density=Density.NOISE, noise_scale=0.5, noise_detail=2.0, noise_contrast=3.0)
    t.fill(scene, (-0.9, -0.9, -0.9), (0.9, 0.9, 0.9), medium)
    scene.add_instances(scene.add_mesh(*box((-1.5, -1.5, 1.0), (1.5, 1.5, 1.1))), IDENTITY, [scene.add_gem(1.5)])
    scene.add_light(Light(power=60.0, radius=0.05, transform=placed(0.3, 0.2, 2.5)[:3]))
    towards_back = np.array([[1, 0, 0, 0], [0, 0, -1, -5.0], [0, 1, 0, 0.0]])
    scene.set_camera(**t.orthographic(1.0, towards_back))
    scene.commit()


SCENES: dict[str, tuple[Callable, str, int]] = {
    "beam": (beam, "CAUSTICS", 20_000),
    "fog": (fog, "INDIRECT", 10_000),
    "cloud": (cloud, "CAUSTICS", 20_000),
}


def report_box() -> dict:
    """Seconds of one pass with the report's parameters."""
    from opal_kernels.descriptions import Carry, VolumeEstimate
    from opal_kernels.render import Render
    from opal_kernels.scene import Scene

    with Scene() as scene:
        fog(scene)
        settings = {"photons_carry": Carry.INDIRECT, "volume_estimate": VolumeEstimate.POINTS, "gather": 100, "march_steps": 5}
        started = time.perf_counter()
        with Render(
            scene, width=REPORT_SIZE, height=REPORT_SIZE, samples_per_pass=1, photons_per_pass=10_000, march_tolerance=0.0, **settings
        ) as render:
            render.run(1)
        seconds = time.perf_counter() - started
    return {"what": "report", "seconds": seconds, "factor": REPORT_SECONDS / seconds}


def _run(build: Callable, carry: str, photons: int, estimate, seconds: float, seed: int) -> tuple[list[float], list[np.ndarray], dict]:
    """Seconds after each pass of a run, the pictures then, and the render's statistics."""
    from opal_kernels.descriptions import Carry
    from opal_kernels.render import Render
    from opal_kernels.scene import Scene

    times, pictures = [], []
    with Scene() as scene:
        build(scene)
        settings = {"samples_per_pass": 1, "photons_per_pass": photons, "photons_carry": Carry[carry], "volume_estimate": estimate}
        with Render(scene, width=SIZE, height=SIZE, max_depth=32, seed=seed, **settings) as render:
            started = time.perf_counter()
            for number in range(4096):
                render.run_pass(number)
                times.append(time.perf_counter() - started)
                pictures.append(render.film()[..., :3].astype(np.float64))
                if times[-1] > seconds:
                    break
            return times, pictures, render.statistics


def estimates(name: str, seconds: float) -> list[dict]:
    """Time of each estimate to the error of the worst."""
    from opal_kernels.descriptions import VolumeEstimate

    build, carry, photons = SCENES[name]
    reference = np.mean([_run(build, carry, photons, e, 3 * seconds, 1000 + e)[1][-1] for e in VolumeEstimate], axis=0)
    runs = {e: _run(build, carry, photons, e, seconds, 1)[:2] for e in VolumeEstimate}
    errors = {e: np.array([relative_mse(p, reference) for p in pictures]) for e, (_, pictures) in runs.items()}
    target = max(e[-1] for e in errors.values())
    return [
        {
            "what": "estimate",
            "scene": name,
            "estimate": e.name,
            "seconds": time_to(target, np.array(runs[e][0]), errors[e]),
            "error": float(target),
            "last_error": float(errors[e][-1]),
        }
        for e in VolumeEstimate
    ]


def search(stored: int = 10_000_000) -> list[dict]:
    """What building the search structure of so many photons (or beams) takes of the time that tracing them took, in the fog box."""
    from opal_kernels.descriptions import Carry, VolumeEstimate
    from opal_kernels.render import Render
    from opal_kernels.scene import Scene

    def traced(estimate: VolumeEstimate, photons: int) -> dict:
        with Scene() as scene:
            fog(scene)
            with Render(scene, width=8, height=8, samples_per_pass=1, photons_per_pass=photons, photons_carry=Carry.INDIRECT,
                        volume_estimate=estimate) as render:  # fmt: skip
                return render.run(1).statistics

    records, trial = [], 100_000
    for estimate in VolumeEstimate:
        photons = round(stored * trial / traced(estimate, trial)["volume_photons_stored"])
        s = traced(estimate, photons)
        seconds = s["search_seconds"]
        records.append({"what": "search", "estimate": estimate.name, "stored": s["volume_photons_stored"], "seconds": seconds,
                        "ratio": seconds / (s["photon_seconds"] - seconds)})  # fmt: skip
    return records


def beside_cycles(repeats: int, reference_samples: int) -> list[dict]:
    """Inside Blender: seconds to a relative MSE of 0.01 of the fog box without its glass, both engines, 160 x 90 pixels."""
    import against_cycles
    import bpy

    sys.path.insert(0, str(ROOT / "examples"))
    import fog_box

    scene = fog_box.build()
    bpy.data.objects.remove(bpy.data.objects["Glass ball"])
    for name in ("photons_carry", "volume_photons_per_pass", "volume_radius", "samples_per_pass", "use_adaptive_sampling"):
        scene.opal.property_unset(name)  # paths alone are compared, with the defaults, not the example's photons
    against_cycles.settle()
    scene.opal.time_limit = 0.0
    scene.render.resolution_x, scene.render.resolution_y = 160, 90
    samples, found = {"CYCLES": 64, "OPAL": 32}, {}
    for engine, n in samples.items():
        reference = against_cycles.picture(engine, reference_samples, 1000)[1]
        overhead = against_cycles.picture(engine, 1, 1)[0]
        needed = []
        for repeat in range(repeats):
            seconds, image = against_cycles.picture(engine, n, repeat + 1)
            error = relative_mse(image, reference) / (1 + n / reference_samples)
            needed.append(overhead + max(seconds - overhead, 1e-3) * error / ERROR)
        found[engine] = {"seconds": float(np.median(needed)), "mean": [float(v) for v in reference.mean(axis=(0, 1))]}
    ratio = found["OPAL"]["seconds"] / found["CYCLES"]["seconds"]
    return [
        {
            "what": "cycles",
            "seconds": {e: f["seconds"] for e, f in found.items()},
            "means": {e: f["mean"] for e, f in found.items()},
            "ratio": ratio,
        }
    ]


def measure(seconds: float) -> list[dict]:
    """What needs no Blender."""
    return [report_box(), *(record for name in SCENES for record in estimates(name, seconds)), *search()]


def report(records: list[dict]) -> None:
    """Prints the figures, and which estimate was quickest: the least product of times."""
    products: dict[str, float] = {}
    for r in records:
        if r["what"] == "report":
            print(f"the report's box, {REPORT_SIZE} x {REPORT_SIZE}: {r['seconds']:.2f} s, {r['factor']:.0f} times as fast as 64 min 36 s")
        elif r["what"] == "estimate":
            products[r["estimate"]] = products.get(r["estimate"], 1.0) * r["seconds"]
            print(
                f"{r['scene']:6s} {r['estimate']:14s} {r['seconds']:7.2f} s to relative MSE {r['error']:.4f} (at the end {r['last_error']:.4f})"
            )
        elif r["what"] == "search":
            print(
                f"search {r['estimate']:14s} {r['stored']} stored, built in {r['seconds']:.2f} s, {r['ratio']:.2f} of the time that tracing took"
            )
        else:
            cycles, opal = r["seconds"]["CYCLES"], r["seconds"]["OPAL"]
            print(f"fog box to relative MSE {ERROR}: Cycles {cycles:.2f} s, Opal {opal:.2f} s, ratio {r['ratio']:.2f}; means {r['means']}")
    if products:
        print(f"least time to equal error: {min(products, key=products.get)}")
