# SPDX-License-Identifier: GPL-3.0-or-later
"""The caustic scenes in Mitsuba 3: its dielectric has one index, so each wavelength is a monochrome render, and they are added up."""

from __future__ import annotations

import math
import os
import time

import mitsuba as mi
import numpy as np
from caustic_scenes import FLOOR_REFLECTANCE, LAMP_RADIANCE, SIZE, CausticScene

METHODS = ("ptracer", "path")
BANDS = np.arange(400.0, 700.0, 25.0) + 12.5
XYZ_TO_RGB = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]])
SAMPLES = {"ptracer": 8, "path": 16}
"""Samples a pixel in one go, a wavelength."""


def weights() -> np.ndarray:
    """(bands, 3): what a band of D65 adds to linear Rec.709; each channel sums to 1, so that white stays white."""
    from opal_kernels import data

    observer, d65 = data.array("cie1931_observer"), data.array("d65")
    at = [np.arange(-12, 13) + int(b) - 360 for b in BANDS]
    rgb = np.array([XYZ_TO_RGB @ (observer[:, i] * d65[i]).sum(axis=1) for i in at])
    return rgb / rgb.sum(axis=0)


def snapshots(description: CausticScene, method: str, times: list[float], seed: int) -> list[tuple[float, np.ndarray]]:
    """(seconds, picture) when each of ``times`` has passed; the clock starts after the first wavelength, which compiles."""
    try:
        mi.set_variant("llvm_ad_mono")
        mi.Float(1) + 1
    except Exception as error:  # Mitsuba names what is missing
        raise SystemExit(f"Mitsuba's LLVM variant does not start ({error}): set DRJIT_LIBLLVM_PATH to libLLVM 16 or newer.") from None

    def mesh(m, **rest):
        shape = mi.Mesh("mesh", len(m.corners), len(m.triangles))
        parameters = mi.traverse(shape)
        parameters["vertex_positions"] = np.asarray(m.corners, np.float32).ravel()
        parameters["faces"] = np.asarray(m.triangles, np.uint32).ravel()
        parameters.update()
        path = f"/tmp/opal-benchmark-{os.getpid()}-{id(m)}.ply"
        shape.write_ply(path)
        return {"type": "ply", "filename": path, "face_normals": True, **rest}

    def diffuse(value):
        return {"type": "diffuse", "reflectance": {"type": "spectrum", "value": value}}

    scene = {
        "type": "scene",
        "integrator": {"type": method, "max_depth": 24, "rr_depth": 16},
        "sensor": {
            "type": "perspective",
            "fov": math.degrees(description.field_of_view),
            "to_world": mi.ScalarTransform4f().look_at(list(description.eye), list(description.target), [0, 0, 1]),
            "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "pixel_format": "luminance"},
            "sampler": {"type": "independent"},
        },
        "floor": mesh(description.floor, bsdf=diffuse(FLOOR_REFLECTANCE)),
        "glass": mesh(description.glass, bsdf={"type": "dielectric", "int_ior": description.index_d, "ext_ior": 1.0, "id": "dielectric"}),
        "lamp": mesh(
            description.lamp(), bsdf=diffuse(0.0), emitter={"type": "area", "radiance": {"type": "spectrum", "value": LAMP_RADIANCE}}
        ),
    }
    if description.screen is not None:
        scene["screen"] = mesh(description.screen, bsdf=diffuse(0.0))
    loaded = mi.load_dict(scene)
    parameters = mi.traverse(loaded)
    key = next(k for k in parameters.keys() if k.endswith("eta"))  # noqa: SIM118
    samples, share = SAMPLES[method], weights()

    def sweep(number):
        picture = np.zeros((SIZE, SIZE, 3))
        for band, (nm, weight) in enumerate(zip(BANDS, share, strict=True)):
            parameters[key] = float(description.index(nm))
            parameters.update()
            image = np.array(mi.render(loaded, spp=samples, seed=(seed * 4096 + number) * len(BANDS) + band), dtype=np.float64)
            picture += image.reshape(SIZE, SIZE, -1)[..., :1] * weight
        return picture

    sweep(0)
    start, total, found = time.perf_counter(), np.zeros((SIZE, SIZE, 3)), []
    for number in range(1, 1_000_000):
        total += sweep(number)
        if (now := time.perf_counter() - start) >= times[len(found)]:
            found.append((now, total / number))
            if len(found) == len(times):
                break
    return found
