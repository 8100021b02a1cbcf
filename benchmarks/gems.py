# SPDX-License-Identifier: GPL-3.0-or-later
"""What dispersion costs: the prism and the brilliant on a diffuse floor, with their dispersion and with the index of the D line alone.

    PYTHONPATH=kernels .venv/bin/python benchmarks/gems.py                     # or `make bench ARGS=gems`
    … benchmarks/gems.py --seconds 60 --reference-seconds 600 --repeats 3      # on a machine that does nothing else

For each scene: the time to a relative MSE of 0.01 in luminance, dispersion on and off, and the ratio; the relative MSE of chroma when that
of luminance has come to 0.01; and Cycles, which has no dispersion, at the scene without (where `bpy` is installed). References are
Opal's own, of another seed, cached in `benchmarks/.cache/`; Cycles is held against the one without dispersion.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import caustic_opal  # noqa: E402
from caustic_scenes import FLOOR_REFLECTANCE, LAMP_RADIANCE, SCENES, SIZE, CausticScene, looking  # noqa: E402
from caustics import sees_floor  # noqa: E402
from error import bright, time_to  # noqa: E402

CACHE = HERE / ".cache"
TARGET = 0.01
LUMINANCE = np.array([0.2126729, 0.7151522, 0.0721750])


def errors(image: np.ndarray, reference: np.ndarray, counted: np.ndarray) -> tuple[float, float]:
    """Relative MSE of luminance and of chroma, as `error.relative_mse` counts.

    Chroma is what is left of RGB without luminance; it is relative to the pixel's RGB, since the colours of a spectrum have many times
    more of it than of luminance.
    """
    y, y_reference = image @ LUMINANCE, reference @ LUMINANCE
    scale = y_reference**2 + 0.1 * y_reference[counted].mean() ** 2
    of_luminance = (y - y_reference) ** 2 / scale
    chroma = (image - y[..., None]) - (reference - y_reference[..., None])
    of_chroma = (chroma**2).mean(axis=-1) / ((reference**2).mean(axis=-1) + 0.1 * reference[counted].mean() ** 2)
    n = max(1, int(counted.sum() * 0.999))
    return tuple(float(np.sort(e[counted])[:n].mean()) for e in (of_luminance, of_chroma))


def reference_of(description: CausticScene, label: str, seconds: float) -> np.ndarray:
    """A long render of another seed, made once."""
    path = CACHE / f"gems-{description.name}-{label}-{seconds:g}.npy"
    if not path.exists():
        CACHE.mkdir(exist_ok=True)
        np.save(path, caustic_opal.snapshots(description, "photons", [seconds], 1000)[-1][1])
    return np.load(path).astype(float)


def opal(description: CausticScene, reference: np.ndarray, counted: np.ndarray, seconds: float, seed: int) -> dict:
    """Time to the target in luminance, and the chroma's error then."""
    times = [seconds * f for f in (0.125, 0.25, 0.5, 1.0)]
    found = caustic_opal.snapshots(description, "photons", times, seed)
    t = np.array([s for s, _ in found])
    luminance, chroma = np.array([errors(i.astype(float), reference, counted) for _, i in found]).T
    return {
        "seconds_to_0.01": time_to(TARGET, t, luminance),
        "luminance_error": float(luminance[-1]),
        "chroma_error": float(chroma[-1]),
        # Both fall together; at the last snapshot their ratio is known best.
        "chroma_over_luminance": float(chroma[-1] / luminance[-1]),
    }


def cycles(description: CausticScene, reference: np.ndarray, counted: np.ndarray, seconds: float) -> dict | None:
    """The scene without dispersion in Cycles: time to the target by path tracing, caustics on; None without bpy."""
    try:
        import bpy
    except ImportError:
        return None
    from mathutils import Matrix

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"

    def add(name, data, matrix=None):
        obj = bpy.data.objects.new(name, data)
        if matrix is not None:
            obj.matrix_world = Matrix([*matrix.tolist(), [0, 0, 0, 1]])
        scene.collection.objects.link(obj)
        return obj

    def surface(name, kind, **inputs):
        material = bpy.data.materials.new(name)
        if material.node_tree is None:
            material.use_nodes = True
        nodes = material.node_tree.nodes
        nodes.clear()
        shader, output = nodes.new(kind), nodes.new("ShaderNodeOutputMaterial")
        for key, value in inputs.items():
            shader.inputs[key].default_value = value
        material.node_tree.links.new(shader.outputs[0], output.inputs["Surface"])
        return material

    r = FLOOR_REFLECTANCE
    parts = (
        ("Floor", description.floor, surface("White", "ShaderNodeBsdfDiffuse", Color=(r, r, r, 1))),
        ("Glass", description.glass, surface("Glass", "ShaderNodeBsdfGlass", IOR=description.index_d, Roughness=0.0, Color=(1, 1, 1, 1))),
        ("Screen", description.screen, surface("Black", "ShaderNodeBsdfDiffuse", Color=(0, 0, 0, 1))),
    )
    for name, body, material in parts:
        if body is not None:
            mesh = bpy.data.meshes.new(name)
            mesh.from_pydata(body.corners.tolist(), [], body.triangles.tolist())
            mesh.materials.append(material)
            add(name, mesh)
    lamp = bpy.data.lights.new("Lamp", "AREA")
    lamp.size = description.lamp_side
    lamp.energy = LAMP_RADIANCE * np.pi * description.lamp_side**2
    add("Lamp", lamp, looking(description.lamp_centre, description.lamp_target))
    camera = bpy.data.cameras.new("Camera")
    camera.angle = description.field_of_view
    camera.clip_start, camera.clip_end = 1e-3, 100.0
    scene.camera = add("Camera", camera, looking(description.eye, description.target))
    settings = scene.cycles
    settings.use_adaptive_sampling = settings.use_denoising = False
    settings.sample_clamp_indirect = settings.blur_glossy = 0.0
    settings.caustics_refractive = settings.caustics_reflective = True
    settings.max_bounces = settings.transmission_bounces = settings.glossy_bounces = 64
    settings.pixel_filter_type = "BOX"
    settings.filter_width = 1.0
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    CACHE.mkdir(exist_ok=True)
    scene.render.filepath = str(CACHE / "cycles.exr")
    samples, t, e = 64, [], []
    while not t or (t[-1] < 0.5 * seconds and len(t) < 10):
        settings.samples, settings.seed = samples, len(t) + 1
        start = time.perf_counter()
        bpy.ops.render.render(write_still=True)
        t.append(time.perf_counter() - start)
        image = bpy.data.images.load(scene.render.filepath, check_existing=False)
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        picture = pixels.reshape(SIZE, SIZE, -1)[::-1, :, :3].astype(float)
        e.append(errors(picture, reference, counted)[0])
        samples *= 4
    return {"seconds_to_0.01": time_to(TARGET, np.array(t), np.array(e)), "luminance_error": e[-1], "ran_seconds": t[-1]}


def measure(scenes: list[str], seconds: float, repeats: int, reference_seconds: float, with_cycles: bool = True) -> list[dict]:
    """One record a scene; dispersion on and off are run by turns, medians taken."""
    records = []
    for name in scenes:
        on = SCENES[name]()
        off = replace(on, cauchy_b=0.0)
        floor = sees_floor(on)
        references = {label: reference_of(d, label, reference_seconds) for label, d in (("on", on), ("off", off))}
        counted = {k: floor & bright(np.where(floor[..., None], r, 0)) if name == "prism" else floor for k, r in references.items()}
        runs = {"on": [], "off": []}
        for repeat in range(repeats):
            for label, description in (("on", on), ("off", off)):
                runs[label].append(opal(description, references[label], counted[label], seconds, repeat + 1))
        median = {k: {key: float(np.median([r[key] for r in rows])) for key in rows[0]} for k, rows in runs.items()}
        records.append(
            {
                "scene": name,
                "on": median["on"],
                "off": median["off"],
                "cost_of_dispersion": median["on"]["seconds_to_0.01"] / median["off"]["seconds_to_0.01"],
                "cycles": cycles(off, references["off"], counted["off"], seconds) if with_cycles else None,
            }
        )
    return records


def report(records: list[dict]) -> None:
    for r in records:
        print(f"\n{r['scene']}: time to relative MSE {TARGET} of luminance")
        for label in ("on", "off"):
            o = r[label]
            print(f"  Opal, dispersion {label:4s} {o['seconds_to_0.01']:8.1f} s   (reached {o['luminance_error']:.2g})")
        if r["cycles"]:
            c = r["cycles"]
            print(
                f"  Cycles, without       {c['seconds_to_0.01']:8.1f} s   (reached {c['luminance_error']:.2g} in {c['ran_seconds']:.0f} s)"
            )
            print(f"  Cycles takes {c['seconds_to_0.01'] / r['off']['seconds_to_0.01']:.1f} times as long as Opal without dispersion")
        print(f"  dispersion on costs {r['cost_of_dispersion']:.2f} times dispersion off (target 1.6 at most)")
        print(f"  chroma's relative MSE is {r['on']['chroma_over_luminance']:.2f} times luminance's (target 2 at most)")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", default=["prism", "brilliant"], choices=sorted(SCENES))
    parser.add_argument("--seconds", type=float, default=30.0, help="of each run")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--reference-seconds", type=float, default=300.0)
    parser.add_argument("--no-cycles", action="store_true")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    records = measure(options.scenes, options.seconds, options.repeats, options.reference_seconds, not options.no_cycles)
    report(records)
    if options.json:
        options.json.parent.mkdir(parents=True, exist_ok=True)
        options.json.write_text(json.dumps(records, indent=1))


if __name__ == "__main__":
    main()
