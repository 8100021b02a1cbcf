# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered view and F12 as a person waits for them, on `examples/diamond.py` at 960 x 540, and what a million triangles take.

    first image       from the edit that changes everything (the whole scene read, committed) to the first coarse picture
    turning           from another view of the same scene to its first picture
    an edit           the scene's update for a colour, a lamp, a move
    refinements       passes of the view's own pixels a second
    F12               from the operator's call to the first pixels that Blender is given
    memory            growth of the process by rendering 1,000,000 triangles in a process of its own, in each engine

`measure` runs inside `tools/with_extension.py`; medians over repeats. The view is driven without a window, through the same scene, thread
and camera: what Blender adds is a redraw.
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parent.parent
SIZE = (960, 540)
MEMORY = """
import json, sys
import bpy
def peak(): return next(int(l.split()[1]) for l in open("/proc/self/status") if l.startswith("VmHWM")) * 1024
def resident(): return next(int(l.split()[1]) for l in open("/proc/self/status") if l.startswith("VmRSS")) * 1024
engine = sys.argv[-1]
bpy.ops.mesh.primitive_grid_add(x_subdivisions=707, y_subdivisions=708, size=20)
triangles = 2 * 707 * 708
scene = bpy.context.scene
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
camera.location = (0, 0, 5)
scene.collection.objects.link(camera)
scene.camera = camera
scene.render.engine = engine
scene.render.resolution_x = scene.render.resolution_y = 64
if engine == "CYCLES":
    scene.cycles.samples, scene.cycles.device = 4, "CPU"
else:
    scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = 1, 4, 0
bpy.context.evaluated_depsgraph_get()
before = resident()
bpy.ops.render.render()
print("MEMORY", json.dumps({"triangles": triangles, "bytes": peak() - before}), flush=True)
"""


def _addon(name: str):
    package = next(key for key in sys.modules if key.endswith("opal.addon"))
    return importlib.import_module(f"{package}.{name}")


def _seconds(work) -> float:
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def measure(repeats: int = 5) -> list[dict]:
    """Records with seconds (or rates, or bytes) and the target where there is one. Needs bpy and the extension."""
    import bpy

    sys.path.append(str(ROOT / "examples"))
    import diamond

    scene = diamond.build()
    scene.render.engine = "OPAL"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    depsgraph = bpy.context.evaluated_depsgraph_get()
    settings, worker = _addon("settings"), _addon("viewport_worker")
    camera = _addon("translate.camera").camera_from_object(scene.camera.evaluated_get(depsgraph), scene, *SIZE)
    wanted = settings.render_settings(scene, settings.Frame(*SIZE, (0, 0, *SIZE)), preview=True)

    pace = worker.Pace()
    first, turning = [], []
    for _ in range(repeats + 1):  # the first also loads modules and tables, as the first view of a session does
        sync = _addon("viewport_sync").SceneSync()
        begun = time.perf_counter()
        sync.update(depsgraph)
        first.append(_first_picture(worker, sync, camera, wanted, pace) - begun)
        begun = time.perf_counter()
        turned = replace(camera, window=[1.01 * x for x in camera.window])
        turning.append(_first_picture(worker, sync, turned, wanted, pace) - begun)
        sync.close()
    sync = _addon("viewport_sync").SceneSync()
    sync.update(depsgraph)
    rate = _passes_per_second(worker, sync, camera, wanted, pace)
    sync.close()
    records = [
        {"what": "first image, first view of a session", "seconds": first[0], "target": 0.3},
        {"what": "first image", "seconds": median(first[1:]), "target": 0.3},
        {"what": "first image of another view (turning)", "seconds": median(turning)},
        {"what": "refinements", "per_second": rate},
        *_edits(scene, repeats),
        {"what": "F12 to first pixels", "seconds": _first_pixels(scene)},
    ]
    return records


def memory() -> list[dict]:
    """Records with bytes, each engine in a process of its own; called outside of Blender."""
    return [{"what": f"1,000,000 triangles in {engine.title()}", "bytes": _memory(engine)} for engine in ("OPAL", "CYCLES")]


def _first_picture(worker, sync, camera, wanted, pace) -> float:
    """The time when a view's first picture is there."""
    came = []
    running = worker.Worker(sync.scene, camera, wanted, 1, pace, lambda: came.append(time.perf_counter()))
    while not came:
        running.wait(0.002)
    running.stop()
    return came[0]


def _passes_per_second(worker, sync, camera, wanted, pace, seconds: float = 8.0) -> float:
    came = []
    running = worker.Worker(sync.scene, camera, wanted, 10_000, pace, lambda: came.append((running.done, time.perf_counter())))
    time.sleep(0.05)
    running.wait(seconds)
    running.stop()
    own = [(done, when) for done, when in came if done]
    if len(own) < 2:
        return len(own) / seconds
    return (own[-1][0] - own[0][0]) / (own[-1][1] - own[0][1])


def _edits(scene, repeats: int) -> list[dict]:
    """Seconds of the scene's update for edits of each kind."""
    import bpy

    sync = _addon("viewport_sync").SceneSync()
    sync.update(bpy.context.evaluated_depsgraph_get())
    took = []

    def updated(_scene, depsgraph):
        took.append(_seconds(lambda: sync.update(depsgraph)))

    table = bpy.data.materials["Table"].node_tree.nodes["Principled BSDF"].inputs["Base Color"]
    lamp, stone = bpy.data.objects["Lamp"], bpy.data.objects["Diamond"]
    edits = {
        "a colour": lambda share: setattr(table, "default_value", (share, share, share, 1)),
        "a lamp's power": lambda share: setattr(lamp.data, "energy", 20 + share),
        "a move": lambda share: setattr(stone.location, "x", 1e-4 * share),
    }
    records = []
    bpy.app.handlers.depsgraph_update_post.append(updated)
    try:
        for name, edit in edits.items():
            took.clear()
            for number in range(repeats):
                edit((number + 1) / (repeats + 1))
                bpy.context.view_layer.update()
            records.append({"what": f"update for {name}", "seconds": median(took)})
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(updated)
        sync.close()
    return records


def _first_pixels(scene) -> float:
    """From the operator to the first picture that Blender is given."""
    import bpy

    final = _addon("final_render")
    shown, put, passes = [], final._put, scene.opal.passes

    def noted(*arguments):
        put(*arguments)
        shown.append(time.perf_counter())

    final._put = noted
    scene.opal.passes = 1
    try:
        begun = time.perf_counter()
        bpy.ops.render.render()
        return shown[0] - begun
    finally:
        final._put = put
        scene.opal.passes = passes


def _memory(engine: str) -> int:
    script = ROOT / "build" / "bench-memory.py"
    script.write_text(MEMORY)
    command = [sys.executable, str(ROOT / "tools" / "with_extension.py"), str(script), engine]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return json.loads(next(line for line in out.splitlines() if line.startswith("MEMORY")).split(" ", 1)[1])["bytes"]


def report(records: list[dict]) -> None:
    print("\nviewport (examples/diamond.py at 960 x 540; a grid for the memory)")
    for r in records:
        if "bytes" in r:
            value = f"{r['bytes'] / 1e6:8.1f} MB"
        elif "per_second" in r:
            value = f"{r['per_second']:8.2f} passes/s"
        else:
            value = f"{1e3 * r['seconds']:8.1f} ms" + (f" (target {1e3 * r['target']:.0f} ms)" if "target" in r else "")
        print(f"  {r['what']:40s} {value}")
