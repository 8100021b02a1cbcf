# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays a second of the tracer's intersection layer beside bare Embree calls on the same rays, photons a second, and building a scene.

Bare Embree is `bare_embree.cpp`, compiled on the fly with the compiler that builds the kernels; both use one thread, so that the ratio is not
one of schedulers. Runs are interleaved, medians taken.
"""

from __future__ import annotations

import subprocess
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np
from opal_kernels import libraries, programs
from opal_kernels.descriptions import Light, LightType
from opal_kernels.render import Render
from opal_kernels.scene import Scene

ROOT = Path(__file__).resolve().parent.parent
RAYS = 1_000_000


def terrain(triangles: int) -> tuple[np.ndarray, np.ndarray]:
    """A bumpy square of about this many triangles; (n, 3) corners and (m, 3) triangles."""
    n = max(2, int((triangles / 2) ** 0.5) + 1)
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    z = 0.1 * np.sin(9 * x) * np.cos(7 * y) + 0.02 * np.sin(41 * x + 3 * y)
    i = np.arange((n - 1) * n).reshape(n - 1, n)[:, :-1].ravel()
    faces = np.concatenate([np.stack([i, i + 1, i + n + 1], 1), np.stack([i, i + n + 1, i + n], 1)])
    return np.stack([x, y, z], -1).reshape(-1, 3).astype(np.float32), faces.astype(np.int32)


def incoherent_rays() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(3)
    origins = rng.uniform((-1, -1, 0.2), (1, 1, 1), (RAYS, 3)).astype(np.float32)
    directions = rng.normal(size=(RAYS, 3)).astype(np.float32)
    return origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)


def _bare(folder: Path, corners, faces, origins, directions):
    """Compiles the bare program and returns a function that gives its rays a second."""
    for name, array in (("corners", corners), ("faces", faces), ("origins", origins), ("directions", directions)):
        np.ascontiguousarray(array).tofile(folder / name)
    program = folder / "bare_embree"
    if not program.exists():
        sources = [str(Path(__file__).with_name("bare_embree.cpp")), str(ROOT / "kernels/src/scene/embree_api.cpp")]
        includes = [f"-I{ROOT / 'kernels/src'}", f"-I{ROOT / 'kernels/include'}"]
        subprocess.run(["c++", "-std=c++20", "-O3", "-march=x86-64-v3", *includes, *sources, "-ldl", "-o", str(program)], check=True)

    def rate() -> float:
        return float(subprocess.run([str(program), libraries.embree(), str(folder)], capture_output=True, text=True, check=True).stdout)

    return rate


def measure(repeats: int = 3) -> list[dict]:
    """Records of rays (both rates and their ratio), photons and building."""
    records = []
    origins, directions = incoherent_rays()
    with tempfile.TemporaryDirectory() as folder:
        for triangles in (50, 20_000, 1_000_000):
            corners, faces = terrain(triangles)
            bare = _bare(Path(folder), corners, faces, origins, directions)
            with Scene(threads=1) as scene:
                scene.add_instances(scene.add_mesh(corners, faces), [np.eye(4)])
                started = time.perf_counter()
                scene.commit()
                built = time.perf_counter() - started
                ours, theirs = [], []
                for _ in range(repeats):
                    started = time.perf_counter()
                    scene.intersect(origins, directions)
                    ours.append(RAYS / (time.perf_counter() - started))
                    theirs.append(bare())
            records.append(
                {
                    "what": f"rays on {len(faces)} triangles",
                    "opal": median(ours),
                    "embree": median(theirs),
                    "ratio": median(ours) / median(theirs),
                    "build_seconds": built,
                }
            )
    records.append(_photons())
    return records


def _photons() -> dict:
    from caustic_scenes import looking, prism

    description, identity = prism(), [np.eye(4)]
    with Scene() as scene:
        white, glass = scene.add_material(programs.diffuse((0.8,) * 3)), scene.add_gem(1.7)
        scene.add_instances(scene.add_mesh(description.floor.corners, description.floor.triangles), identity, [white])
        scene.add_instances(scene.add_mesh(description.glass.corners, description.glass.triangles), identity, [glass])
        transform = looking(description.lamp_centre, description.lamp_target)
        scene.add_light(Light(type=LightType.RECTANGLE, power=10.0, size_u=0.04, size_v=0.04, transform=transform))
        scene.set_camera(transform=looking(description.eye, description.target))
        scene.commit()
        with Render(scene, width=32, height=32, photons_per_pass=1_000_000) as render:
            render.run(3)
            statistics = render.statistics
    seconds = statistics["photon_seconds"]
    return {
        "what": "photons through a prism",
        "emitted_per_second": statistics["photons_emitted"] / seconds,
        "stored_per_second": statistics["photons_stored"] / seconds,
    }


def report(records: list[dict]) -> None:
    print("\nspeed")
    for r in records:
        if "ratio" in r:
            print(
                f"  {r['what']:28s} Opal {r['opal'] / 1e6:6.2f} M/s, bare Embree {r['embree'] / 1e6:6.2f} M/s, ratio {r['ratio']:.2f} "
                f"(target 0.6); built in {r['build_seconds']:.2f} s"
            )
        else:
            print(
                f"  {r['what']:28s} {r['emitted_per_second'] / 1e6:6.2f} M emitted, {r['stored_per_second'] / 1e6:6.2f} M stored a second"
            )
