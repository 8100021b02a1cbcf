# SPDX-License-Identifier: GPL-3.0-or-later
"""Every example builds its scene from nothing, and what lies on its table lies on it. Rendering them is `make render`'s business."""

import importlib.util
import math
import sys
from pathlib import Path

import bpy
import pytest

EXAMPLES = Path(__file__).resolve().parent.parent.parent / "examples"
NAMES = sorted(path.stem for path in EXAMPLES.glob("*.py") if not path.stem.startswith("_"))


@pytest.fixture(scope="module", autouse=True)
def examples_on_the_path():
    sys.path.insert(0, str(EXAMPLES))
    yield
    sys.path.remove(str(EXAMPLES))


def example(name):
    """The module of an example, by its file: a checkout may be called as an example is."""
    spec = importlib.util.spec_from_file_location(f"example_{name}", EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", NAMES)
def test_an_example_builds_a_scene_that_can_be_rendered(name):
    scene = example(name).build()
    assert scene.camera is not None
    assert scene.world is not None
    assert all(obj.data.materials and obj.data.materials[0] for obj in scene.objects if obj.type == "MESH")
    assert 0.0 < scene.opal.time_limit <= 180.0, "an example is drawn in under three minutes"


@pytest.mark.parametrize("name", [name for name in NAMES if not name.startswith("rainbow")])  # Rain falls through the ground it wets.
def test_nothing_sinks_into_the_table(name):
    scene = example(name).build()
    bpy.context.view_layer.update()
    for obj in scene.objects:
        if obj.type == "MESH" and (name != "opal" or obj.data.materials[0].opal.kind == "GEM"):  # opal's table stands in a landscape
            lowest = min((obj.matrix_world @ vertex.co).z for vertex in obj.data.vertices)
            assert lowest >= -1e-7, f"{obj.name} reaches {1e3 * lowest:.4f} mm"


def test_a_stone_lies_flat_on_its_facet_and_leans_where_it_is_told():
    scene = importlib.import_module("_scene")
    from opal_kernels.cuts import round_brilliant

    scene.empty()
    cut = round_brilliant()
    stone = scene.stone("Stone", cut, 0.0065, scene.matte("Grey", (0.5, 0.5, 0.5)))
    index = cut.names.index("main")
    scene.rest_on_facet(stone, index, (0.001, 0.002), facing=math.radians(30.0), gap=0.0)
    heights = [(stone.matrix_world @ stone.data.vertices[corner].co).z for corner in stone.data.polygons[index].vertices]
    assert heights == pytest.approx([0.0] * len(heights), abs=1e-8)
    axis = stone.matrix_world.to_3x3() @ stone.data.polygons[cut.names.index("table")].normal
    assert math.atan2(axis.y, axis.x) == pytest.approx(math.radians(30.0), abs=1e-5)
    # A main slopes 40.75°, so the table of a stone that lies on one leans by as much.
    assert axis.z == pytest.approx(math.cos(math.radians(40.75)), abs=1e-5)


def test_the_walls_of_the_fog_box_bleed_into_the_fog(tmp_path):
    """Of the light from the medium alone the left third is redder, the right third greener; the parts add up to the whole."""
    box = example("fog_box")
    scenes = importlib.import_module("_scene")
    scene = box.build()
    scenes.use_engine(scene, "OPAL")
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    scene.opal.passes, scene.opal.samples_per_pass, scene.opal.photons_per_pass = 3, 8, 2000
    bpy.ops.render.render()
    parts = box.parts(scenes.passes_of_render(scene, tmp_path / "fog.exr"))
    assert parts["things"] + parts["medium"] == pytest.approx(parts["both"])
    left, right = (parts["medium"][:, columns].mean(axis=(0, 1)) for columns in (slice(8, 24), slice(40, 56)))
    assert left.min() > 0.0 and right.min() > 0.0
    redness = [float(side[0] / side[1]) for side in (left, right)]
    assert redness[0] > 1.1 and redness[1] < 0.95, redness
