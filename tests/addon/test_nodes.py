# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees that artists make: groups, mutes, reroutes, rings, what is missing; and what the tracer is told of them."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))
from node_images import new_tree, node, out, run_program, set_inputs  # noqa: E402
from opal_source.addon.nodes import compile_light_nodes, compile_material, compile_world  # noqa: E402
from opal_source.addon.nodes.operations import Op  # noqa: E402

RED, GREEN = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0)


class Context:
    """No scene, no images."""

    depsgraph = None

    def __init__(self):
        self.names = {}

    def attribute_id(self, name):
        return self.names.setdefault(name, len(self.names))

    def image_index(self, image, image_user):
        return -1

    def image_tiles(self, image):
        return []


def material_of(build):
    """A material whose surface is the shader socket that `build(tree)` gives."""
    material = bpy.data.materials.new("tested")
    tree, output = new_tree(material)
    socket = build(tree)
    if socket is not None:
        tree.links.new(socket, output.inputs["Surface"])
    return material


def compiled_of(build):
    return compile_material(material_of(build), Context())


def emitted(compiled, point=(0.2, 0.3, 0.9)):
    """What a compiled program emits towards a point, as a tuple."""
    return tuple(run_program(None, compiled, np.float32([point]))[0].tolist())


def ops_of(compiled):
    return [Op(row[0]) for row in compiled.code]


def emission(tree, color=RED, strength=1.0):
    return out(node(tree, "Emission", {"Color": color, "Strength": strength}))


# ---- Shape of the program ----


def test_constants_are_worked_out_and_what_nobody_needs_is_left_out():
    def build(tree):
        node(tree, "TexNoise")
        factor = out(node(tree, "Math", {"Value": 0.25, "Value_001": 0.25}, operation="ADD"))
        mixed = node(tree, "MixShader", {"Fac": factor, "Shader": emission(tree), "Shader_001": emission(tree, GREEN)})
        return out(mixed)

    compiled = compiled_of(build)
    assert ops_of(compiled) == [Op.EMISSION, Op.EMISSION]
    assert emitted(compiled) == (0.5, 0.5, 0.0)


def test_a_shader_reached_by_many_ways_is_emitted_once():
    def build(tree):
        shader = emission(tree)
        for _ in range(40):
            shader = out(node(tree, "MixShader", {"Fac": 0.5, "Shader": shader, "Shader_001": shader}))
        return shader

    compiled = compiled_of(build)
    assert ops_of(compiled) == [Op.EMISSION]
    assert emitted(compiled) == pytest.approx((1.0, 0.0, 0.0))


def test_registers_are_used_again():
    def build(tree):
        value = out(node(tree, "TexCoord"), "Object")
        for _ in range(400):
            value = out(node(tree, "VectorMath", {"Vector": value, "Vector_001": (0.001, 0.0, 0.0)}, operation="ADD"))
        return emission(tree, value)

    compiled = compiled_of(build)
    assert not compiled.problems
    assert compiled.n_registers - len(compiled.constants) <= 2
    assert emitted(compiled, (0.1, 0.2, 0.3)) == pytest.approx((0.5, 0.2, 0.3), abs=1e-4)


# ---- Groups, mutes, reroutes, rings ----


def group_with(name, build):
    """A node group with one colour input and one shader output that `build(tree, input socket)` gives."""
    group = bpy.data.node_groups.new(name, "ShaderNodeTree")
    group.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Surface", in_out="OUTPUT", socket_type="NodeSocketShader")
    source, sink = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    group.links.new(build(group, source.outputs[0]), sink.inputs[0])
    return group


def use(tree, group, color=None):
    made = tree.nodes.new("ShaderNodeGroup")
    made.node_tree = group
    if isinstance(color, bpy.types.NodeSocket):
        tree.links.new(color, made.inputs[0])
    elif color is not None:
        made.inputs[0].default_value = color
    return made.outputs[0]


def test_groups_within_groups_each_with_their_own_inputs():
    inner = group_with("inner", lambda t, tint: emission(t, tint))
    outer = group_with(
        "outer", lambda t, tint: out(node(t, "AddShader", {"Shader": use(t, inner, tint), "Shader_001": use(t, inner, GREEN)}))
    )
    compiled = compiled_of(lambda t: use(t, outer, (0.25, 0.0, 0.5, 1.0)))
    assert emitted(compiled) == (0.25, 1.0, 0.5)
    assert not compiled.problems


def test_a_group_that_contains_itself_is_reported_and_does_not_hang():
    group = group_with("snake", lambda t, tint: emission(t, tint))
    inside = group.nodes.new("ShaderNodeGroup")
    try:
        inside.node_tree = group
    except (RuntimeError, TypeError):
        pytest.skip("this Blender refuses")
    if inside.node_tree is None:
        compiled = compiled_of(lambda t: use(t, group, RED))
        assert emitted(compiled) == (1.0, 0.0, 0.0)


def test_a_group_without_tree_or_output_shows_nothing_and_does_not_fail():
    empty = bpy.data.node_groups.new("empty", "ShaderNodeTree")
    empty.interface.new_socket("Surface", in_out="OUTPUT", socket_type="NodeSocketShader")
    assert emitted(compiled_of(lambda t: use(t, empty))) == (0.0, 0.0, 0.0)
    assert ops_of(compiled_of(lambda t: t.nodes.new("ShaderNodeGroup") and emission(t))) == [Op.EMISSION]


def test_reroutes_are_followed():
    def build(tree):
        socket = emission(tree)
        for _ in range(5):
            reroute = tree.nodes.new("NodeReroute")
            tree.links.new(socket, reroute.inputs[0])
            socket = reroute.outputs[0]
        return socket

    assert emitted(compiled_of(build)) == (1.0, 0.0, 0.0)


def test_a_muted_node_hands_its_input_on():
    def build(tree):
        bright = node(tree, "BrightContrast", {"Color": (0.25, 0.5, 0.75, 1.0), "Bright": 0.1})
        gamma = node(tree, "Gamma", {"Color": out(bright), "Gamma": 3.0})
        gamma.mute = True
        return emission(tree, out(gamma))

    assert emitted(compiled_of(build)) == pytest.approx((0.35, 0.6, 0.85))


def test_a_muted_link_counts_as_none():
    def build(tree):
        made = node(tree, "Emission", {"Color": GREEN})
        link = tree.links.new(out(node(tree, "RGB")), made.inputs["Color"])
        link.is_muted = True
        return out(made)

    assert emitted(compiled_of(build)) == (0.0, 1.0, 0.0)


def test_links_in_a_ring_are_cut():
    def build(tree):
        first = node(tree, "Math", {"Value_001": 0.5}, operation="ADD")
        second = node(tree, "Math", {"Value": out(first), "Value_001": 0.25}, operation="ADD")
        tree.links.new(out(second), first.inputs[0])
        return emission(tree, out(second))

    assert all(np.isfinite(emitted(compiled_of(build))))


def test_shaders_in_a_ring_are_cut():
    def build(tree):
        first = node(tree, "AddShader", {"Shader": emission(tree)})
        second = node(tree, "AddShader", {"Shader": out(first)})
        tree.links.new(out(second), first.inputs[1])
        return out(second)

    assert emitted(compiled_of(build))[0] >= 1.0


# ---- What is missing ----


def test_a_material_without_output_is_black_and_says_so():
    material = bpy.data.materials.new("tested")
    new_tree(material)[0].nodes.clear()
    compiled = compile_material(material, Context())
    assert len(compiled.code) == 0
    assert "no output" in compiled.problems[0].message


def test_a_material_without_nodes_is_its_viewport_colour():
    material = bpy.data.materials.new("tested")
    if bpy.app.version >= (5, 0):
        pytest.skip("materials always have nodes since Blender 5")
    material.use_nodes = False
    material.diffuse_color = (0.1, 0.2, 0.3, 1.0)
    compiled = compile_material(material, Context())
    assert ops_of(compiled) == [Op.DIFFUSE]
    assert compiled.constants[compiled.code[0][4]][:3] == pytest.approx((0.1, 0.2, 0.3))
    material.metallic = 1.0
    assert ops_of(compile_material(material, Context())) == [Op.PRINCIPLED]


def test_what_is_not_read_is_named_and_something_sensible_shown():
    def build(tree):
        made = node(tree, "BsdfToon", {"Color": RED})
        made.name = "My toon"
        return out(made)

    compiled = compiled_of(build)
    assert ops_of(compiled) == [Op.DIFFUSE]
    assert [(p.owner.split(".")[0], p.node) for p in compiled.problems] == [("tested", "My toon")]


def test_an_unknown_value_node_is_named_and_the_socket_keeps_its_own_value():
    def build(tree):
        made = node(tree, "Emission", {"Strength": 0.5})
        tree.links.new(out(node(tree, "AmbientOcclusion"), "AO"), made.inputs["Strength"])
        return out(made)

    compiled = compiled_of(build)
    assert "Ambient Occlusion" in compiled.problems[0].message
    assert emitted(compiled) == (0.5, 0.5, 0.5)


def test_every_shader_node_compiles_and_its_program_is_accepted():
    refused = []
    for name in dir(bpy.types):
        if not name.startswith("ShaderNode") or name in ("ShaderNodeTree", "ShaderNodeGroup", "ShaderNodeCustomGroup"):
            continue
        material = bpy.data.materials.new("tested")
        tree, output = new_tree(material)
        try:
            made = tree.nodes.new(name)
        except RuntimeError:
            continue
        for socket in made.outputs:
            if not socket.enabled or socket.type == "CUSTOM":
                continue
            if socket.type == "SHADER":
                tree.links.new(socket, output.inputs["Surface"])
            else:
                shader = node(tree, "Emission")
                tree.links.new(socket, shader.inputs["Color"])
                tree.links.new(out(shader), output.inputs["Surface"])
            compiled = compile_material(material, Context())
            try:
                emitted(compiled)
            except ValueError as error:
                refused.append((name, socket.name, str(error)))
    assert not refused, refused


def test_a_tree_too_large_for_the_registers_is_reported_and_shows_grey(monkeypatch):
    monkeypatch.setattr("opal_source.addon.nodes.operations.MAX_REGISTERS", 16)

    def build(tree):
        terms = [out(node(tree, "TexNoise", {"Scale": float(i + 1)}), "Fac") for i in range(20)]
        shaders = [emission(tree, t) for t in terms]
        total = terms[-1]
        for term in terms[-2::-1]:
            total = out(node(tree, "Math", {"Value": term, "Value_001": total}, operation="POWER"))
        last = emission(tree, total)
        for each in shaders:
            last = out(node(tree, "AddShader", {"Shader": last, "Shader_001": each}))
        return last

    compiled = compiled_of(build)
    assert "too large" in compiled.problems[0].message
    assert ops_of(compiled) == [Op.DIFFUSE]


# ---- What the tracer is told ----


def flags(build):
    compiled = compiled_of(build)
    return compiled.emissive, compiled.caster, compiled.transparent_shadow


def shader(kind, inputs=None, **settings):
    return lambda tree: out(node(tree, kind, inputs, **settings))


@pytest.mark.parametrize(
    ("build", "expected"),
    [
        (shader("BsdfDiffuse"), (False, False, False)),
        (shader("BsdfPrincipled"), (False, False, False)),
        (shader("BsdfGlass", {"Roughness": 0.0}), (False, True, False)),
        (shader("BsdfRefraction", {"Roughness": 0.1}), (False, True, False)),
        (shader("BsdfAnisotropic", {"Roughness": 0.1}), (False, True, False)),
        (shader("BsdfAnisotropic", {"Roughness": 0.8}), (False, False, False)),
        (shader("BsdfPrincipled", {"Metallic": 1.0, "Roughness": 0.1}), (False, True, False)),
        (shader("BsdfPrincipled", {"Metallic": 1.0, "Roughness": 0.7}), (False, False, False)),
        (shader("BsdfPrincipled", {"Transmission Weight": 1.0, "Roughness": 0.0}), (False, True, False)),
        (shader("BsdfPrincipled", {"Coat Weight": 1.0}), (False, True, False)),
        (shader("BsdfPrincipled", {"Alpha": 0.5}), (False, False, True)),
        (shader("BsdfPrincipled", {"Emission Strength": 2.0}), (True, False, False)),
        (shader("BsdfPrincipled", {"Emission Strength": 2.0, "Emission Color": (0, 0, 0, 1)}), (False, False, False)),
        (shader("BsdfTransparent"), (False, False, True)),
        (shader("BsdfTransparent", {"Color": (0, 0, 0, 1)}), (False, False, False)),
        (shader("Emission"), (True, False, False)),
        (shader("Emission", {"Strength": 0.0}), (False, False, False)),
    ],
)
def test_flags_say_what_a_surface_may_do(build, expected):
    assert flags(build) == expected


def test_a_textured_property_counts_as_if_it_did_everything():
    def build(tree):
        noise = out(node(tree, "TexNoise"))
        return out(node(tree, "BsdfPrincipled", {"Metallic": noise, "Roughness": noise, "Alpha": noise, "Emission Strength": noise}))

    assert flags(build) == (True, True, True)


def test_glass_that_no_light_reaches_makes_no_caustics():
    def build(tree):
        return out(node(tree, "MixShader", {"Fac": 0.0, "Shader": shader("BsdfDiffuse")(tree), "Shader_001": shader("BsdfGlass")(tree)}))

    assert flags(build) == (False, False, False)


# ---- Lamps and worlds ----


def lamp_of(build):
    lamp = bpy.data.lights.new("lamp", "POINT")
    tree, output = new_tree(lamp, "ShaderNodeOutputLight")
    tree.links.new(build(tree), output.inputs["Surface"])
    return compile_light_nodes(lamp, Context())


def test_a_lamp_without_nodes_is_white():
    factor, problems = compile_light_nodes(bpy.data.lights.new("lamp", "POINT"), Context())
    assert factor == (1.0, 1.0, 1.0)
    assert not problems


def test_a_lamps_emission_multiplies_its_power():
    factor, problems = lamp_of(lambda t: emission(t, (0.5, 1.0, 0.25, 1.0), 2.0))
    assert factor == pytest.approx((1.0, 2.0, 0.5))
    assert not problems


def test_a_textured_lamp_is_reported():
    factor, problems = lamp_of(lambda t: emission(t, out(node(t, "TexNoise"), "Color"), 2.0))
    assert factor == pytest.approx((2.0, 2.0, 2.0))
    assert "textured" in problems[0].message


def test_a_blackbody_lamp_has_the_colour_of_the_temperature():
    factor, _ = lamp_of(lambda t: emission(t, out(node(t, "Blackbody", {"Temperature": 2800.0}))))
    assert np.array(factor) / factor[1] == pytest.approx((2.2926, 1.0, 0.2669), rel=0.01)


def test_a_world_without_nodes_is_its_colour():
    world = bpy.data.worlds.new("tested")
    world.color = (0.2, 0.3, 0.4)
    if bpy.app.version < (5, 0):
        world.use_nodes = False
        assert emitted(compile_world(world, Context())) == pytest.approx((0.2, 0.3, 0.4))


def test_displacement_shades_as_bump():
    material = bpy.data.materials.new("tested")
    tree, output = new_tree(material)
    tree.links.new(out(node(tree, "BsdfDiffuse")), output.inputs["Surface"])
    displacement = node(tree, "Displacement", {"Height": out(node(tree, "TexNoise"))})
    tree.links.new(out(displacement), output.inputs["Displacement"])
    compiled = compile_material(material, Context())
    assert Op.BUMP in ops_of(compiled)
    set_inputs(displacement, {"Scale": 0.0})
