# SPDX-License-Identifier: GPL-3.0-or-later
"""Media beside Cycles' volumes: absolute, without a factor, and different by nothing but noise.

Each scene is compared as `test_scenes` compares: the means within 1 % a channel, and what pixels differ by beyond both engines' own
noise within 2 % of the brightness. Cycles follows 32 volume bounces; from 5.0 on it is unbiased unless `volume_biased` is set,
before that it marches rays (4.5), in steps that are made small here. Which it was is written to `build/cycles.txt`.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

import test_scenes  # noqa: E402
from test_scenes import ball, camera, check, cube, diffuse, lamp, nodes_of, place, square, world  # noqa: E402


@pytest.fixture
def tiny(monkeypatch, small_and_unbiased):
    """Few pixels, well sampled: where the density varies Cycles takes long."""
    monkeypatch.setattr(test_scenes, "SIZE", (20, 15))
    monkeypatch.setattr(test_scenes, "SAMPLES", 256)


@pytest.fixture(autouse=True)
def small_and_unbiased(monkeypatch, opal):
    monkeypatch.setattr(test_scenes, "SIZE", (48, 36))
    monkeypatch.setattr(test_scenes, "SAMPLES", 64)
    monkeypatch.setattr(test_scenes, "BOUNCES", 128)  # Opal's media scatter as often as it takes: 3 % of albedo 0.9 lie beyond 32
    cycles = bpy.context.scene.cycles
    biased = getattr(cycles, "volume_biased", None)
    if biased is not None:
        cycles.volume_biased = False
    else:
        cycles.volume_step_rate, cycles.volume_max_steps = 0.1, 1024
    record = Path(__file__).resolve().parents[2] / "build" / "cycles.txt"
    record.parent.mkdir(exist_ok=True)
    flag = "absent" if biased is None else cycles.volume_biased
    record.write_text(f"Cycles of Blender {bpy.app.version_string} ({bpy.app.build_hash.decode()}), volume_biased: {flag}\n")


def filled(name, *shaders):
    """A material whose Volume socket has the sum of shaders: (node type, inputs by name, phase function)."""
    material = bpy.data.materials.new(name)
    tree = nodes_of(material)
    tree.nodes.clear()
    add_volume(tree, tree.nodes.new("ShaderNodeOutputMaterial"), *shaders)
    return material


def add_volume(tree, output, *shaders):
    total = None
    for kind, inputs in shaders:
        node = tree.nodes.new(f"ShaderNode{kind}")
        for key, value in inputs.items():
            if key == "phase":
                node.phase = value
            else:
                node.inputs[key.replace("_", " ")].default_value = value
        if total is None:
            total = node.outputs[0]
        else:
            both = tree.nodes.new("ShaderNodeAddShader")
            tree.links.new(total, both.inputs[0])
            tree.links.new(node.outputs[0], both.inputs[1])
            total = both.outputs[0]
    tree.links.new(total, output.inputs["Volume"])


def lit_box(material, view=(0, -5, 0.5), radius=0.3, angle=0.1):
    """A cube of the medium on a floor, under a lamp, a sun and a sky."""
    place("floor", square("floor", diffuse("floor", (0.5, 0.5, 0.5)), 4), (0, 0, -1.01))
    place("box", cube("box", material), (0, 0, 0), (0, 0, 0.4), (2, 2, 2))
    lamp("POINT", (1.6, -1.6, 2.5), energy=300, shadow_soft_size=radius)
    lamp("SUN", (0, 0, 5), (0.5, 0.3, 0), energy=2.0, angle=angle)
    world((0.2, 0.25, 0.3))
    camera(view, (1.5, 0, 0), lens=45)


BODIES = {
    "isotropic": [("VolumeScatter", {"Color": (0.8, 0.8, 0.8, 1), "Density": 0.8})],
    "forward": [("VolumeScatter", {"Color": (0.8, 0.8, 0.8, 1), "Density": 0.8, "Anisotropy": 0.8})],
    "backward": [("VolumeScatter", {"Color": (0.8, 0.8, 0.8, 1), "Density": 0.8, "Anisotropy": -0.4})],
    "coloured albedo": [
        ("VolumeScatter", {"Color": (0.9, 0.5, 0.3, 1), "Density": 0.8}),
        ("VolumeAbsorption", {"Color": (0.9, 0.5, 0.3, 1), "Density": 0.8}),
    ],
    "chromatic extinction": [("VolumeScatter", {"Color": (0.9, 0.6, 0.3, 1), "Density": 1.0})],
    "emission": [
        ("Emission", {"Color": (0.9, 0.5, 0.2, 1), "Strength": 0.3}),
        ("VolumeAbsorption", {"Color": (0.5, 0.5, 0.5, 1), "Density": 0.8}),
    ],
    "a thin and a dense one": [
        ("VolumePrincipled", {"Color": (0.9, 0.6, 0.3, 1), "Density": 0.1, "Anisotropy": -0.5}),
        ("VolumePrincipled", {"Color": (0.9, 0.6, 0.3, 1), "Density": 0.8, "Anisotropy": 0.85}),
    ],
    "principled": [("VolumePrincipled", {"Color": (0.8, 0.6, 0.4, 1), "Density": 1.0, "Blackbody_Intensity": 1.0, "Temperature": 1200.0})],
}


@pytest.mark.parametrize("body", BODIES)
def test_a_box_of_a_medium(opal, render, body):
    lit_box(filled("medium", *BODIES[body]))
    check(render)


PHASES = {
    "RAYLEIGH": {},
    "DRAINE": {"Anisotropy": 0.5, "Alpha": 2.0},
    "FOURNIER_FORAND": {"IOR": 1.2, "Backscatter": 0.1},
    "MIE": {"Diameter": 8.0},
}


@pytest.mark.parametrize("phase", PHASES)
def test_phase_functions_of_the_scatter_node(opal, render, phase):
    inputs = {"phase": phase, "Color": (0.8, 0.8, 0.8, 1), "Density": 0.8, **PHASES[phase]}
    # Small lamps through a narrow peak of scattering are noise: a soft one and a wide sun, and more samples, have a third of it.
    narrow = phase in {"FOURNIER_FORAND", "MIE"}
    lit_box(filled("medium", ("VolumeScatter", inputs)), **({"radius": 0.8, "angle": 0.6} if narrow else {}))
    check(render, samples=4 if narrow else 1)


def test_camera_inside(opal, render):
    lit_box(filled("medium", ("VolumeScatter", {"Color": (0.8, 0.7, 0.6, 1), "Density": 0.5})), (0, -0.6, 0.2))
    place("ball", ball("ball", diffuse("ball", (0.7, 0.3, 0.2))), (0, 0.5, 0), scale=(0.3, 0.3, 0.3))
    check(render)


def test_world_fog(opal, render, tiny):
    """Fog everywhere lets neither sky nor sun through; lamps light it."""
    world((0.2, 0.25, 0.3))
    tree = bpy.context.scene.world.node_tree
    output = next(n for n in tree.nodes if n.type == "OUTPUT_WORLD")
    add_volume(tree, output, ("VolumeScatter", {"Color": (0.9, 0.9, 0.9, 1), "Density": 0.12, "Anisotropy": 0.3}))
    place("floor", square("floor", diffuse("floor", (0.6, 0.6, 0.6)), 4))
    place("post", cube("post", diffuse("post", (0.7, 0.2, 0.1))), (0.6, 1, 0.7), scale=(0.4, 0.4, 1.4))
    lamp("POINT", (-1, -1, 2), energy=300, shadow_soft_size=0.4)
    camera((0, -6, 1.5), (1.4, 0, 0))
    check(render)


def openvdb_cloud(folder):
    """A smooth ball of density with a temperature and a colour, on a turned lattice; the path of its file."""
    bpy.utils.expose_bundled_modules()
    openvdb = pytest.importorskip("openvdb")
    n = 24
    index = np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), -1)
    radius = np.linalg.norm(index - (n - 1) / 2, axis=-1) / (n / 2)
    values = {
        "density": np.clip(1.1 - radius, 0, 1) * 3,
        "temperature": np.clip(1 - radius, 0, 1),
        "color": np.stack([index[..., 0] / n, 1 - index[..., 1] / n, np.full((n, n, n), 0.5)], -1),
    }
    grids = []
    for name, array in values.items():
        grid = openvdb.FloatGrid() if array.ndim == 3 else openvdb.Vec3SGrid()
        grid.copyFromArray(array.astype(np.float32))
        grid.name, grid.transform = name, openvdb.createLinearTransform(2 / n)
        grid.transform.postTranslate((-1, -1, -1))
        grids.append(grid)
    path = str(folder / "cloud.vdb")
    openvdb.write(path, grids=grids)
    return path


def lit_cloud(folder, material, scale, space="OBJECT"):
    """The cloud of `openvdb_cloud` as a volume object of some scale, lit and seen from as much further away."""
    volume = bpy.data.volumes.new("cloud")
    volume.filepath, volume.render.space = openvdb_cloud(folder), space
    volume.materials.append(material)
    place("cloud", volume, (0, 0, 0), (0.2, 0.3, 0.4), (scale, 0.8 * scale, 1.2 * scale))
    lamp("POINT", (1.6 * scale, -1.6 * scale, 2.5 * scale), energy=300 * scale**2, shadow_soft_size=0.3 * scale)
    lamp("SUN", (0, 0, 5), (0.5, 0.3, 0), energy=2.0, angle=0.1)
    world((0.2, 0.25, 0.3))
    camera((0, -5 * scale, 0), (math.pi / 2, 0, 0), lens=60)


def test_an_openvdb_file(opal, render, tmp_path, tiny):
    """Smoke and fire at three times the scale, as dense and as bright as at any: that is Blender's default of the render space."""
    inputs = {"Color": (0.7, 0.6, 0.5, 1), "Blackbody_Intensity": 0.5, "Temperature": 1500.0}
    lit_cloud(tmp_path, filled("cloud", ("VolumePrincipled", inputs)), 3.0)
    check(render)


def test_what_nodes_read_of_grids(opal, render, tmp_path, tiny):
    """A Color Attribute, the density squared by an Attribute node, a glow by Volume Info's temperature, all in one volume, as dense and
    as bright in each metre at any scale."""
    square_of = ("VolumeScatter", {"Color": (0.3, 0.5, 0.8, 1)})
    coloured = ("VolumePrincipled", {"Color": (1, 1, 1, 1), "Color_Attribute": "color", "Density": 0.5})
    material = filled("cloud", coloured, square_of, ("Emission", {"Color": (1, 0.5, 0.2, 1)}))
    tree = material.node_tree
    attribute, power, info = (tree.nodes.new(f"ShaderNode{n}") for n in ("Attribute", "Math", "VolumeInfo"))
    attribute.attribute_name, power.operation, power.inputs[1].default_value = "density", "POWER", 2.0
    by_type = {n.type: n for n in tree.nodes}
    tree.links.new(attribute.outputs["Fac"], power.inputs[0])
    tree.links.new(power.outputs[0], by_type["VOLUME_SCATTER"].inputs["Density"])
    tree.links.new(info.outputs["Temperature"], by_type["EMISSION"].inputs["Strength"])
    lit_cloud(tmp_path, material, 0.6, "WORLD")
    check(render)


def test_phase_functions_that_change_from_place_to_place(opal, render, tiny):
    """Forward on one side, backward on the other, of different colours: each scatters where it is and in its own colour.

    In one place Cycles mixes lobes by their mean over colours (`volume_shader_phase_pick` says so); Opal by each colour's own.
    """
    material = bpy.data.materials.new("sides")
    tree = nodes_of(material)
    tree.nodes.clear()
    mix, place_of, part, over, output = (
        tree.nodes.new(f"ShaderNode{n}") for n in ("MixShader", "TexCoord", "SeparateXYZ", "Math", "OutputMaterial")
    )
    over.operation, over.inputs[1].default_value = "GREATER_THAN", 0.0
    for socket, colour, g in ((1, (0.9, 0.5, 0.3, 1), 0.85), (2, (0.4, 0.8, 0.9, 1), -0.6)):
        scatter = tree.nodes.new("ShaderNodeVolumeScatter")
        scatter.inputs["Color"].default_value, scatter.inputs["Anisotropy"].default_value = colour, g
        tree.links.new(scatter.outputs[0], mix.inputs[socket])
    for source, target in (
        (place_of.outputs["Object"], part.inputs[0]),
        (part.outputs[0], over.inputs[0]),
        (over.outputs[0], mix.inputs[0]),
    ):
        tree.links.new(source, target)
    tree.links.new(mix.outputs[0], output.inputs["Volume"])
    lit_box(material)
    check(render, samples=3)


def test_density_by_a_noise_texture(opal, render, tiny):
    """Evaluated by the kernels at voxels of the mesh's box: the texture's finest lumps are larger than those.

    Means within half a per cent; 24, 96 or 192 voxels change the light that comes through by less than 5e-4.
    """
    material = filled("noise", ("VolumeScatter", {"Color": (0.8, 0.7, 0.6, 1)}))
    tree = material.node_tree
    noise, times, place_of = (tree.nodes.new(f"ShaderNode{n}") for n in ("TexNoise", "Math", "TexCoord"))
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 1.5, 1.0
    times.operation = "MULTIPLY"
    times.inputs[1].default_value = 3.0
    scatter = next(n for n in tree.nodes if n.type == "VOLUME_SCATTER")
    tree.links.new(place_of.outputs["Object"], noise.inputs["Vector"])
    tree.links.new(noise.outputs[0], times.inputs[0])
    tree.links.new(times.outputs[0], scatter.inputs["Density"])
    lit_box(material)
    check(render, mean_tolerance=0.005, samples=3)
