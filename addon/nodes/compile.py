# SPDX-License-Identifier: GPL-3.0-or-later
"""The three things that have node trees: materials, worlds and lamps."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

# The readers register themselves.
from . import converters, inputs, shaders, textures, vectors  # noqa: F401
from . import operations as ops
from .compiler import Compiler, NodeView
from .context import CompiledProgram, NodeContext, Problem
from .flags import flags_of
from .operations import Op
from .program import ONE, ZERO, ProgramBuilder, Value, constant
from .tree import Frame

_TARGET = "CYCLES"  # an output marked for Cycles is meant for us as well


def compile_material(material: Any, context: NodeContext) -> CompiledProgram:
    """A material's surface as a program.

    Parameters
    ----------
    material : bpy.types.Material
        Evaluated or original.
    context : NodeContext
        Gives numbers to images and attributes.

    Returns
    -------
    CompiledProgram
        Never fails: what cannot be read is among its problems and shades as its nearest sensible value.
    """
    compiler = Compiler(material, context)
    if material.node_tree is None or not material.use_nodes:
        _without_nodes(compiler.builder, material)
        return _finished(compiler)
    output = material.node_tree.get_output_node(_TARGET)
    if output is None:
        compiler.problem("", "The material has no output node; it is black.", lost=True)
        return _finished(compiler)
    frame = Frame(material.node_tree)
    compiler.default_normal = _displaced_normal(compiler, frame, output, material)
    _shade(compiler, frame, output)
    return _finished(compiler)


def compile_missing(context: NodeContext) -> CompiledProgram:
    """What a face without a material shows, as in Cycles: since Blender 5 a Principled surface as new, before a matte one."""
    compiler = Compiler(None, context)
    grey = constant(0.8, 0.8, 0.8)
    if bpy.app.version >= (5, 0):
        _principled(compiler.builder, grey, metallic=0.0, roughness=0.5)
    else:
        compiler.builder.emit(Op.DIFFUSE, 0, ONE, grey, ZERO, None)
    return _finished(compiler)


def compile_world(world: Any, context: NodeContext) -> CompiledProgram:
    """A world's background as a program: run with a direction as position, its emission is the radiance from there."""
    compiler = Compiler(world, context, is_world=True)
    if world.node_tree is None or not world.use_nodes:
        compiler.builder.emit(Op.EMISSION, 0, ONE, constant(*world.color), ONE)
        return _finished(compiler)
    output = world.node_tree.get_output_node(_TARGET)
    if output is None:
        compiler.problem("", "The world has no output node; it is black.", lost=True)
        return _finished(compiler)
    _shade(compiler, Frame(world.node_tree), output)
    return _finished(compiler)


def compile_light_nodes(light: Any, context: NodeContext) -> tuple[tuple[float, float, float], list[Problem]]:
    """What a lamp's node tree multiplies its power by.

    Parameters
    ----------
    light : bpy.types.Light
        With or without nodes.
    context : NodeContext
        As for materials.

    Returns
    -------
    tuple of 3 float
        Emission colour times strength, linear Rec.709; white where the tree is none, or not the same everywhere.
    list of Problem
        What could not be kept.
    """
    white = (1.0, 1.0, 1.0)
    compiler = Compiler(light, context)
    if light.node_tree is None or not light.use_nodes:
        return white, []
    output = light.node_tree.get_output_node(_TARGET)
    if output is None:
        compiler.problem("", "The lamp has no output node; it is dark.", lost=True)
        return (0.0, 0.0, 0.0), compiler.problems
    _shade(compiler, Frame(light.node_tree), output)
    total = np.zeros(3)
    for op, _mode, values in compiler.builder.lobes:
        if op is not Op.EMISSION:
            compiler.problem("", "Only Emission lights a lamp; other shaders are left out.", lost=True)
            continue
        parts = []
        for name, value in zip(("mix factor", "colour", "strength"), values[:3], strict=True):
            if value.constant is None:
                compiler.problem("", f"The lamp's {name} is textured or computed; 1 is taken for it.")
            parts.append(np.array(value.constant[:3] if value.constant else white))
        total += parts[0] * parts[1] * parts[2]
    return tuple(float(c) for c in total), compiler.problems


def _shade(compiler: Compiler, frame: Frame, output: Any) -> None:
    compiler.shade(frame, output.inputs["Surface"])


def _without_nodes(builder: ProgramBuilder, material: Any) -> None:
    """The viewport colour as Cycles shades it: diffuse; or metal, where the material says so."""
    color = constant(*material.diffuse_color[:3])
    if material.metallic == 0:
        builder.emit(Op.DIFFUSE, 0, ONE, color, ZERO, None)
        return
    _principled(builder, color, material.metallic, material.roughness)


def _principled(builder: ProgramBuilder, color: Value, metallic: float, roughness: float) -> None:
    """A Principled surface with everything else as in a new node."""
    packed = builder.pack(*(constant(x) for x in (metallic, roughness, 1.5, 1.0)))
    plain = builder.pack_color(ONE, ZERO)
    tint = builder.pack_color(ONE, constant(0.5))
    zeros = builder.pack(ZERO, ZERO, ZERO, ZERO)
    layers = builder.pack(ZERO, constant(0.03), constant(1.5), constant(0.5))
    film = builder.pack(ZERO, constant(1.33))
    builder.emit(Op.PRINCIPLED, 1, ONE, color, None, None, None, tint, plain, plain, plain, packed, zeros, layers, film)


def _displaced_normal(compiler: Compiler, frame: Frame, output: Any, material: Any) -> Value | None:
    """Displacement as bump: the normal that shaders take by default, or None."""
    socket = output.inputs["Displacement"]
    source = compiler.source(frame, socket)
    if source.node is None:
        return None
    if source.node.bl_idname != "ShaderNodeDisplacement":
        compiler.problem(output.name, f"Displacement by a {source.node.bl_label} node is not read; the surface stays smooth.", lost=True)
        return None
    if material.displacement_method == "DISPLACEMENT":
        compiler.problem(output.name, "The surface is not moved by displacement; it is shaded as bump.")
    view = NodeView(compiler, source.frame, source.node)
    if view.value("Midlevel").constant is None or view.value("Height").constant is not None:
        height = compiler.input_value(frame, socket)
    else:  # a constant level changes no slope
        height = compiler.builder.math("MULTIPLY", view.value("Height"), view.value("Scale"))
    if height.constant is not None:
        return None
    height = compiler.builder.emit(Op.GREY, ops.GREY["AVERAGE"], height)
    return compiler.builder.emit(Op.BUMP, 0, height, ONE, ONE, view.linked("Normal"), constant(0.1), 0)


def _finished(compiler: Compiler) -> CompiledProgram:
    flags = flags_of(compiler.builder)
    try:
        code, constants, n_registers = compiler.builder.finish()
    except OverflowError as error:
        compiler.problem("", f"The node tree is too large for one program: {error}. A grey surface is shown.", lost=True)
        builder = ProgramBuilder()
        builder.emit(Op.DIFFUSE, 0, ONE, constant(0.8, 0.8, 0.8), ZERO, None)
        flags = flags_of(builder)
        code, constants, n_registers = builder.finish()
    return CompiledProgram(code, constants, n_registers, *flags, compiler.problems)
