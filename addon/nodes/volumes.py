# SPDX-License-Identifier: GPL-3.0-or-later
"""The Volume socket of a material or a world: what its shader nodes take away, scatter and add, as programs or constants.

Formulas are those of Cycles' volume closures. Every shader gives terms ``colour x factor`` for scattering, absorption and emission;
`compile_volume` sums them, what scatters by phase function: each keeps its own colour and its own places. What is the same everywhere stays constant; a term times one grid keeps the grid's name; only what is
computed from place to place becomes a program, which the kernels run at the voxels of a grid.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from typing import Any

from opal_kernels.descriptions import Phase, PhaseKind

from . import operations as ops
from .compiler import Compiler, NodeView
from .context import CompiledProgram, NodeContext, Problem
from .operations import Op
from .program import ONE, ZERO, Value, constant
from .tree import Frame

_TARGET = "CYCLES"
Rgb = tuple[float, float, float]


@dataclass
class Coefficient:
    """A sum of terms: `constant` times the grid `grid` ("": 1), or a program where that does not say it."""

    constant: Rgb = (0.0, 0.0, 0.0)
    grid: str = ""
    program: CompiledProgram | None = None

    @property
    def present(self) -> bool:
        return self.program is not None or any(self.constant)


@dataclass
class Blackbody:
    """Glow by temperature: Cycles' Principled Volume."""

    intensity: float
    tint: Rgb
    temperature: float
    grid: str


@dataclass
class Lobe:
    """What is scattered by one phase function."""

    phase: Phase
    coefficient: Coefficient


@dataclass
class CompiledVolume:
    """A volume: coefficients in linear Rec.709 and 1/m (emission: radiance per metre)."""

    scattering: list[Lobe] = field(default_factory=list)
    absorption: Coefficient = field(default_factory=Coefficient)
    emission: Coefficient = field(default_factory=Coefficient)
    blackbodies: list[Blackbody] = field(default_factory=list)
    grids: dict[str, int] = field(default_factory=dict)  # attributes that programs read, by name
    problems: list[Problem] = field(default_factory=list)

    @property
    def coefficients(self) -> list[Coefficient]:
        """All that is not nothing."""
        return [c for c in (*(lobe.coefficient for lobe in self.scattering), self.absorption, self.emission) if c.present]


@dataclass
class _Terms:
    """What the shader nodes of one volume have given so far."""

    grids: Collection[str] | None  # names that exist; None: the body has no grids
    scattering: list[tuple[Phase, list[tuple[Value, Value]]]] = field(default_factory=list)
    absorption: list[tuple[Value, Value]] = field(default_factory=list)
    emission: list[tuple[Value, Value]] = field(default_factory=list)
    blackbodies: list[Blackbody] = field(default_factory=list)


def has_volume(owner: Any) -> bool:
    """Whether a material's or a world's node tree has something linked to its Volume socket."""
    return _volume_socket(owner) is not None


def has_surface(owner: Any) -> bool:
    """Whether something is linked to its Surface socket."""
    output = owner.node_tree.get_output_node(_TARGET) if owner.node_tree is not None else None
    return output is not None and output.inputs["Surface"].is_linked


def _volume_socket(owner: Any) -> Any:
    if owner is None or owner.node_tree is None or not owner.use_nodes:
        return None
    output = owner.node_tree.get_output_node(_TARGET)
    if output is None or not output.inputs["Volume"].is_linked:
        return None
    return output.inputs["Volume"]


def compile_volume(owner: Any, context: NodeContext, grids: Collection[str] | None = None) -> CompiledVolume | None:
    """Reads the Volume socket of a material or a world.

    Parameters
    ----------
    owner : bpy.types.Material or bpy.types.World
    context : NodeContext
        Gives numbers to images and attributes.
    grids : collection of str, optional
        Names of the grids that the object has; None where it is an ordinary mesh.

    Returns
    -------
    CompiledVolume or None
        None where nothing is linked.
    """
    socket = _volume_socket(owner)
    if socket is None:
        return None
    compiler = Compiler(owner, context)
    terms = _Terms(grids)
    readers = {kind: _with(terms, reader) for kind, reader in _READERS.items()}
    compiler.shade(Frame(owner.node_tree), socket, readers, "it is left out of the volume")
    volume = CompiledVolume(blackbodies=terms.blackbodies, problems=compiler.problems)
    numbers: dict[int, str] = {}
    lobes = [Lobe(phase, _coefficient(compiler, of_phase, numbers)) for phase, of_phase in terms.scattering]
    volume.scattering = [lobe for lobe in lobes if lobe.coefficient.present]
    volume.absorption = _coefficient(compiler, terms.absorption, numbers)
    volume.emission = _coefficient(compiler, terms.emission, numbers)
    volume.grids = {name: number for number, name in numbers.items()}
    return volume


def default_volume() -> CompiledVolume:
    """What a volume object without a material shows: a new Principled Volume node."""
    half = Coefficient((0.5, 0.5, 0.5), "density")
    return CompiledVolume(scattering=[Lobe(Phase(), half)], absorption=Coefficient(half.constant, "density"))


def _with(terms: _Terms, reader: Callable) -> Callable[[NodeView, Value], None]:
    return lambda n, weight: reader(terms, n, weight)


def _coefficient(compiler: Compiler, terms: list[tuple[Value, Value]], numbers: dict[int, str]) -> Coefficient:
    builder = compiler.builder
    total, grid, simple = [0.0, 0.0, 0.0], None, True
    for color, factor in terms:
        found = builder.scaled_attribute(factor)
        if color.constant is None or found is None:
            simple = False
            break
        scale, number = found
        name = compiler.context.attribute_name(number) if number is not None else ""
        if grid not in (None, name):
            simple = False
            break
        grid = name
        total = [t + scale * c for t, c in zip(total, color.constant[:3], strict=True)]
    if simple:
        return Coefficient(tuple(max(0.0, t) for t in total), grid or "")
    value = ZERO
    for color, factor in terms:
        value = builder.emit(Op.VECTOR_MATH, ops.VECTOR_MATH["ADD"], value, builder.scale(color, factor))
    code, constants, n_registers = builder.finish_value(value)
    for row in code[code[:, 0] == int(Op.ATTRIBUTE)]:
        numbers[int(row[3])] = compiler.context.attribute_name(int(row[3]))
    return Coefficient(program=CompiledProgram(code, constants, n_registers))


# ---- Readers ----


def _positive(n: NodeView, value: Value) -> Value:
    return constant(max(0.0, value.number)) if value.number is not None else n.builder.math("MAXIMUM", value, ZERO)


def _rest(n: NodeView, color: Value) -> Value:
    """max(1 - colour, 0)."""
    rest = n.emit(Op.VECTOR_MATH, ops.VECTOR_MATH["SUBTRACT"], ONE, color)
    if rest.constant is not None:
        return constant(*(max(0.0, c) for c in rest.constant[:3]))
    return n.emit(Op.VECTOR_MATH, ops.VECTOR_MATH["MAXIMUM"], rest, ZERO)


def _phase(n: NodeView, kind: str) -> Phase:
    """A node's phase function; its settings have to be the same everywhere."""

    def number(name: str, otherwise: float) -> float:
        value = n.value(name, constant(otherwise))
        if value.number is None:
            n.problem(f"{name} is the same everywhere in Opal; {otherwise:g} is taken for what is linked.")
            return otherwise
        return value.number

    if kind == "RAYLEIGH":
        return Phase(PhaseKind.RAYLEIGH)
    from opal_kernels.optics import phase_functions as phases

    g = min(0.999, max(-0.999, number("Anisotropy", 0.0)))
    if kind == "HENYEY_GREENSTEIN":
        return Phase(PhaseKind.HENYEY_GREENSTEIN if abs(g) > 1e-4 else PhaseKind.ISOTROPIC, g)
    angles = phases.table_angles()
    import numpy as np

    cosine = np.cos(angles)
    if kind == "DRAINE":
        values = phases.draine(cosine, g, max(0.0, number("Alpha", 0.5)))
    elif kind == "FOURNIER_FORAND":
        backscatter = min(0.499, max(1e-4, number("Backscatter", 0.1)))
        values = phases.fournier_forand(cosine, max(1.0001, number("IOR", 1.33)), backscatter)
    else:
        values = phases.fog(cosine, number("Diameter", 20.0))
    return Phase(PhaseKind.TABLE, wavelengths=[550.0], angles=angles, values=np.maximum(values, 0.0)[None])


def _add_scattering(terms: _Terms, phase: Phase, color: Value, factor: Value) -> None:
    """Adds a term to those of the same phase function."""
    for known, of_phase in terms.scattering:
        if _same_phase(known, phase):
            of_phase.append((color, factor))
            return
    terms.scattering.append((phase, [(color, factor)]))


def _same_phase(a: Phase, b: Phase) -> bool:
    if a.kind != b.kind:
        return False
    if a.kind == PhaseKind.TABLE:
        return bool((a.values == b.values).all())  # tables of `_phase`: all at the same angles
    return a.kind != PhaseKind.HENYEY_GREENSTEIN or a.anisotropy == b.anisotropy


def _scatter(terms: _Terms, n: NodeView, weight: Value) -> None:
    color, factor = n.value("Color"), n.builder.math("MULTIPLY", weight, _positive(n, n.value("Density")))
    _add_scattering(terms, _phase(n, getattr(n.node, "phase", "HENYEY_GREENSTEIN")), color, factor)


def _absorb(terms: _Terms, n: NodeView, weight: Value) -> None:
    factor = n.builder.math("MULTIPLY", weight, _positive(n, n.value("Density")))
    terms.absorption.append((_rest(n, n.value("Color")), factor))


def _coefficients(terms: _Terms, n: NodeView, weight: Value) -> None:
    _add_scattering(terms, _phase(n, n.node.phase), n.value("Scatter Coefficients"), weight)
    terms.absorption.append((n.value("Absorption Coefficients"), weight))
    terms.emission.append((n.value("Emission Coefficients"), weight))


def _emit(terms: _Terms, n: NodeView, weight: Value) -> None:
    terms.emission.append((n.value("Color"), n.builder.math("MULTIPLY", weight, n.value("Strength"))))


def _text(n: NodeView, name: str) -> str:
    socket = n.node.inputs.get(name)
    return getattr(socket, "default_value", "") if socket is not None else ""


def _principled(terms: _Terms, n: NodeView, weight: Value) -> None:
    math = n.builder.math

    def grid(name: str, mode: str) -> Value | None:
        """An attribute, where the body has grids; a grid that is missing is named and is 0."""
        if not name or terms.grids is None:
            return None
        if name not in terms.grids:
            return None
        return n.emit(Op.ATTRIBUTE, ops.ATTRIBUTE[mode], n.context.attribute_id(name), None)

    density = _positive(n, n.value("Density"))
    name = _text(n, "Density Attribute")
    if (values := grid(name, "FACTOR")) is not None:
        density = math("MULTIPLY", density, values)
    elif name and terms.grids is not None:
        n.problem(f"There is no grid named “{name}”; where it should say the density there is nothing.", lost=True)
        density = ZERO
    color = n.value("Color")
    name = _text(n, "Color Attribute")
    if (values := grid(name, "COLOR")) is not None:
        color = n.builder.scale(color, values)
    elif name and terms.grids is not None:
        n.problem(f"There is no grid named “{name}”; the colour is taken alone.")
    factor = math("MULTIPLY", weight, density)
    _add_scattering(terms, _phase(n, "HENYEY_GREENSTEIN"), color, factor)
    dark = n.value("Absorption Color")
    if dark.constant is not None:
        root = constant(*(max(0.0, c) ** 0.5 for c in dark.constant[:3]))
    else:
        lanes = (n.emit(Op.MATH, ops.MATH["SQRT"], n.builder.component(dark, i)) for i in range(3))
        root = n.emit(Op.COMBINE, ops.COLOR["RGB"], *lanes)
    absorbed = n.emit(Op.VECTOR_MATH, ops.VECTOR_MATH["MULTIPLY"], _rest(n, color), _rest(n, root))
    terms.absorption.append((absorbed, factor))
    strength = _positive(n, n.value("Emission Strength"))
    if strength.number != 0:
        terms.emission.append((n.value("Emission Color"), math("MULTIPLY", weight, strength)))
    _principled_blackbody(terms, n, weight)


def _principled_blackbody(terms: _Terms, n: NodeView, weight: Value) -> None:
    settings = [n.value("Blackbody Intensity"), n.value("Temperature"), n.value("Blackbody Tint"), weight]
    if settings[0].number == 0:
        return
    if any(value.constant is None for value in settings):
        n.problem("Blackbody settings are the same everywhere but for the temperature's grid; what is linked is left out.", lost=True)
        return
    intensity, temperature, tint, whole = settings
    name = _text(n, "Temperature Attribute")
    known = terms.grids is not None and name in terms.grids
    tint = tuple(whole.number * c for c in tint.constant[:3])
    terms.blackbodies.append(Blackbody(intensity.number, tint, temperature.number, name if known else ""))


_READERS = {
    "ShaderNodeVolumeScatter": _scatter,
    "ShaderNodeVolumeAbsorption": _absorb,
    "ShaderNodeVolumePrincipled": _principled,
    "ShaderNodeVolumeCoefficients": _coefficients,
    "ShaderNodeEmission": _emit,
}
