# SPDX-License-Identifier: GPL-3.0-or-later
"""The caustic scenes in LuxCore: path tracing with its hybrid light tracing, and bidirectional path tracing. SciPy has to be imported first."""

from __future__ import annotations

import math
import time

import numpy as np
import scipy  # noqa: F401  (after pyluxcore it would not load)
from caustic_scenes import FLOOR_REFLECTANCE, LAMP_RADIANCE, SIZE, CausticScene, Mesh

METHODS = ("hybrid", "bidirectional")


def snapshots(description: CausticScene, method: str, times: list[float], seed: int) -> list[tuple[float, np.ndarray]]:
    """(seconds, picture) when each of ``times`` has passed."""
    import pyluxcore

    pyluxcore.Init(lambda _: None)
    scene = pyluxcore.Scene()
    p = pyluxcore.Property

    def define(*pairs):
        properties = pyluxcore.Properties()
        for key, value in pairs:
            properties.Set(p(key, value))
        scene.Parse(properties)

    define(
        ("scene.camera.lookat.orig", list(description.eye)),
        ("scene.camera.lookat.target", list(description.target)),
        ("scene.camera.up", [0.0, 0.0, 1.0]),
        ("scene.camera.fieldofview", math.degrees(description.field_of_view)),
        ("scene.camera.autovolume.enable", False),
        ("scene.materials.white.type", "matte"),
        ("scene.materials.white.kd", [FLOOR_REFLECTANCE] * 3),
        ("scene.materials.black.type", "matte"),
        ("scene.materials.black.kd", [0.0] * 3),
        ("scene.materials.glass.type", "glass"),
        ("scene.materials.glass.kr", [1.0] * 3),
        ("scene.materials.glass.kt", [1.0] * 3),
        ("scene.materials.glass.interiorior", description.index_d),
        ("scene.materials.glass.cauchyb", description.cauchy_b),
        ("scene.materials.lamp.type", "matte"),
        ("scene.materials.lamp.kd", [0.0] * 3),
        ("scene.materials.lamp.emission", [LAMP_RADIANCE] * 3),
    )

    def add(name: str, mesh: Mesh, material: str):
        corners = [tuple(map(float, c)) for c in mesh.corners]
        scene.DefineMesh(f"{name}-mesh", corners, [tuple(map(int, t)) for t in mesh.triangles], None, None, None, None)
        define((f"scene.objects.{name}.shape", f"{name}-mesh"), (f"scene.objects.{name}.material", material))

    add("floor", description.floor, "white")
    add("glass", description.glass, "glass")
    add("lamp", description.lamp(), "lamp")
    if description.screen is not None:
        add("screen", description.screen, "black")
    config = pyluxcore.Properties()
    for key, value in (
        ("renderengine.type", "PATHCPU" if method == "hybrid" else "BIDIRCPU"),
        ("renderengine.seed", seed + 1),
        ("sampler.type", "METROPOLIS" if method == "metropolis" else "SOBOL"),
        ("path.hybridbackforward.enable", method == "hybrid"),
        ("path.hybridbackforward.partition", 0.8),
        ("path.hybridbackforward.glossinessthreshold", 0.05),
        ("path.pathdepth.total", 24),
        ("path.pathdepth.specular", 24),
        ("path.pathdepth.diffuse", 24),
        ("path.pathdepth.glossy", 24),
        ("path.clamping.variance.maxvalue", 0.0),
        ("light.maxdepth", 24),
        ("film.width", SIZE),
        ("film.height", SIZE),
        ("film.filter.type", "NONE"),
        ("film.imagepipelines.0.0.type", "NOP"),
        ("film.outputs.0.type", "RGB"),
        ("film.outputs.0.filename", "unused.exr"),
    ):
        config.Set(p(key, value))
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(config, scene))
    start, found = time.perf_counter(), []
    session.Start()
    while len(found) < len(times):
        time.sleep(max(0.05, times[len(found)] - (time.perf_counter() - start)))
        session.UpdateStats()
        now = time.perf_counter() - start
        buffer = np.zeros(SIZE * SIZE * 3, np.float32)
        session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, buffer, 0, True)
        found.append((now, buffer.reshape(SIZE, SIZE, 3)[::-1].astype(np.float64)))
    session.Stop()
    return found
